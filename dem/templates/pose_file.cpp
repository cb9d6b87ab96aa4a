#include "dem/templates/pose_file.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/words.hpp"

namespace snag {

std::vector<ParticlePose> read_pose_file(const std::filesystem::path& file, const Rag& rag) {
  std::ifstream in(file);
  const auto fail = [&](int line, const std::string& what) {
    throw Error(ExitCode::io, file.string() + ":" + std::to_string(line) + ": " + what);
  };
  if (!in) fail(0, "pose file cannot be opened; give a path relative to the case file");
  const std::size_t n = static_cast<std::size_t>(rag.n_columns) * rag.n_rows;
  std::vector<ParticlePose> poses(n);
  std::vector<bool> given(n, false);
  std::string line;
  std::getline(in, line);
  std::size_t count = 0;
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.empty()) continue;
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream fields(line);
    std::int64_t id = -1;
    Vec3 x;
    Quaternion q;
    if (!(fields >> id >> x.x >> x.y >> x.z >> q.w >> q.x >> q.y >> q.z)) fail(number, "eight numbers id,x,y,z,qw,qx,qy,qz are needed");
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, length = std::sqrt(square);
    if (id < 0 || static_cast<std::size_t>(id) >= n || given[id])
      fail(number, "id " + std::to_string(id) + " is out of 0 .. " + std::to_string(n - 1) + " or given twice");
    if (!(std::abs(length - 1) < 1e-3)) fail(number, "quaternion of length " + number_text(length) + ", a unit quaternion is needed");
    // What was written at full length keeps its bits.
    const double scale = std::abs(square - 1) < 1e-14 ? 1 : 1 / length;
    poses[id] = {x, {scale * q.w, scale * q.x, scale * q.y, scale * q.z}};
    given[id] = true, ++count;
  }
  if (count != n) fail(0, std::to_string(count) + " particles given, the lattice has " + std::to_string(n) + " places");
  return poses;
}

void write_pose_file(const std::filesystem::path& file, const RagPiece& piece) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "id,x,y,z,qw,qx,qy,qz\n";
  for (std::size_t id = 0; id < piece.poses.size(); ++id) {
    const auto& [x, q] = piece.poses[id];
    text << id << ',' << x.x << ',' << x.y << ',' << x.z << ',' << q.w << ',' << q.x << ',' << q.y << ',' << q.z << '\n';
  }
  write_atomically(file, text.str());
}

}  // namespace snag
