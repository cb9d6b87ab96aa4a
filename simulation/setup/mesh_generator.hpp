#pragma once
// The mesh generator is a program of its own (only it is linked to the gmsh library).
#include <mpi.h>

#include <string>
#include <vector>

#include "base/error.hpp"

namespace snag {

/// Run snag-mesh with these arguments on rank 0; its exit code on every rank. Collective; throws Error(io) if it cannot be started.
ExitCode generate_mesh(MPI_Comm comm, std::vector<std::string> arguments);

}  // namespace snag
