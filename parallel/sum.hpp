#pragma once
// Collective sums over all ranks that do not depend on how the terms are spread over them (but for the last bits): double-double numbers.
#include <mpi.h>

#include <cstdint>
#include <span>

#include "base/vec3.hpp"

namespace snag {

/// Sum of all terms of all ranks, with some 30 digits inside.
double sum(MPI_Comm comm, std::span<const double> terms);
Vec3 sum(MPI_Comm comm, std::span<const Vec3> terms);
double sum(MPI_Comm comm, double term);
std::int64_t sum(MPI_Comm comm, std::int64_t term);
double maximum(MPI_Comm comm, double value);
double minimum(MPI_Comm comm, double value);

}  // namespace snag
