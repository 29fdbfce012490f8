#pragma once

#include <memory>

#include "radiosity/processes/message_port.h"

namespace lightwell {

/// True if an MPI launcher (mpirun, srun) started this process: by the variables that Open MPI,
/// MPICH and Slurm set.
bool is_started_by_mpi();

/// True for the process of several that a launcher numbered 0, and for one that none started.
bool is_first_by_launcher();

/// Number of processes that the launcher started; 1 without a launcher, 0 if it does not say.
int size_by_launcher();

/// Joins the processes that mpirun started. Null if none did, or if there is only one. Throws
/// InputError in a build without MPI, std::runtime_error if MPI cannot be used from several
/// threads.
std::unique_ptr<MessagePort> join_processes();

}  // namespace lightwell
