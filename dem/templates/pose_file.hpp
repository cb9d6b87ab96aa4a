#pragma once
// Poses in a file: what one run made, another can begin with.
//
// Comma-separated, one header line, a row for each place of the lattice (those outside a disc's mask too) in any order:
//   id,x,y,z,qw,qx,qy,qz      id = row * n_columns + column; place about the piece's `centre`, m; unit quaternion
#include <filesystem>
#include <vector>

#include "dem/templates/lattice.hpp"

namespace snag {

/// Throws Error(io) naming file and line.
std::vector<ParticlePose> read_pose_file(const std::filesystem::path& file, const Rag& rag);

/// The poses of a piece that has some, digit by digit: reading gives the same bits. Throws Error(io).
void write_pose_file(const std::filesystem::path& file, const RagPiece& piece);

}  // namespace snag
