#pragma once
// The mesh generator is a program of its own (only it is linked to the gmsh library).
#include <mpi.h>

#include <string>
#include <vector>

#include "base/error.hpp"

namespace snag {

/// Run snag-mesh with these arguments on rank 0; its exit code on every rank. Collective; throws Error(io) if it cannot be started.
ExitCode generate_mesh(MPI_Comm comm, std::vector<std::string> arguments);

/// Tables of all geometries, as the manual prints them. On one rank; throws Error(io) if snag-mesh cannot be started.
std::string geometry_tables();

}  // namespace snag
