#include "radiosity/processes/mpi_port.h"
#include "scene/errors.h"

namespace lightwell {

std::unique_ptr<MessagePort> join_processes() {
  if (size_by_launcher() <= 1) return nullptr;
  throw InputError(
      "mpirun started several processes, but this lightwell was built without MPI and would do all "
      "work in each; build it with -DLIGHTWELL_MPI=ON (docs/cluster.md), or start one process");
}

}  // namespace lightwell
