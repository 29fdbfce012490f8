#include <algorithm>
#include <array>
#include <cstdlib>

#include "radiosity/processes/mpi_port.h"

namespace lightwell {
namespace {

// Values of the first of these variables that is set; -1: none is.
template <std::size_t N>
int number_in(const std::array<const char*, N>& names) {
  for (const char* name : names) {
    if (const char* value = std::getenv(name)) return std::atoi(value);
  }
  return -1;
}

// Open MPI; PMIx, by which Slurm starts both; MPICH and its kin.
constexpr std::array rank_variables = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
constexpr std::array size_variables = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};

}  // namespace

bool is_started_by_mpi() {
  return number_in(rank_variables) >= 0;
}

bool is_first_by_launcher() {
  return number_in(rank_variables) <= 0;
}

int size_by_launcher() {
  return is_started_by_mpi() ? std::max(0, number_in(size_variables)) : 1;
}

}  // namespace lightwell
