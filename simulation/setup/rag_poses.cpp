#include "simulation/setup/rag_poses.hpp"

#include <array>
#include <cmath>
#include <sstream>

#include "base/log.hpp"
#include "base/words.hpp"
#include "dem/poses/crumpled.hpp"
#include "dem/templates/pose_file.hpp"
#include "observe/silhouette.hpp"
#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

std::filesystem::path pose_file(const std::filesystem::path& folder, std::size_t number) {
  return folder / ("pose_" + std::to_string(number) + ".csv");
}

std::string name_in_checkpoint(std::size_t number) { return "poses/" + std::to_string(number); }

/// [particle][7]: position, quaternion.
std::vector<double> as_numbers(const std::vector<ParticlePose>& poses) {
  std::vector<double> numbers;
  for (const auto& [x, q] : poses) numbers.insert(numbers.end(), {x.x, x.y, x.z, q.w, q.x, q.y, q.z});
  return numbers;
}

std::vector<ParticlePose> as_poses(const std::vector<double>& n) {
  std::vector<ParticlePose> poses;
  for (std::size_t i = 0; i + 6 < n.size(); i += 7) poses.push_back({{n[i], n[i + 1], n[i + 2]}, {n[i + 3], n[i + 4], n[i + 5], n[i + 6]}});
  return poses;
}

/// The pose of a run that is resumed. Its rag may be that of another case: cases are compared when all tables have been read, and poses are
/// made before.
std::vector<ParticlePose> stored_poses(const Rag& rag, CheckpointReader& checkpoint, std::size_t number) {
  std::vector<ParticlePose> poses = as_poses(checkpoint.shared(name_in_checkpoint(number)));
  const std::size_t expected = static_cast<std::size_t>(rag.n_columns) * static_cast<std::size_t>(rag.n_rows);
  if (poses.size() != expected)
    throw Error(ExitCode::usage, "the checkpoint was written by another case (its pose of " + rag.name + " has " +
                                     std::to_string(poses.size()) + " particles, this one " + std::to_string(expected) +
                                     "); resume with the same case and --set values; only [time] end may be another");
  return poses;
}

/// Direction along which the rag is to travel: of the pipe, or along the folds.
Vec3 direction_of_travel(const RagPiece& piece) {
  if (piece.plan.crumpled()) return unit(piece.plan.confine_axis);
  return rotate(piece.orientation, piece.plan.folds_lengthwise > 0 ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
}

Silhouette seen_along(const RagPiece& piece, const Vec3& up, const Vec3& right) {
  const Rag& rag = piece.rag;
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (int row = 0; row < rag.n_rows; ++row)
    for (int column = 0; column < rag.n_columns; ++column) {
      points.push_back(piece.pose(column, row).position);
      if (!rag.has_bond(column, row, 0) || !rag.has_bond(column, row, 1) || !rag.has_bond(column, row + 1, 0) ||
          !rag.has_bond(column + 1, row, 1))
        continue;
      const int a = row * rag.n_columns + column, b = a + rag.n_columns;
      triangles.push_back({a, a + 1, b + 1}), triangles.push_back({a, b + 1, b});
    }
  return silhouette(points, std::vector<double>(points.size(), rag.radius), triangles, {right, up}, 0.5 * rag.radius);
}

/// What is published of the one cloth that a pose can be held against, 300 mm x 220 mm; nothing for another.
std::string published(const Rag& rag) {
  const double length = 2 * rag.radius * rag.n_columns, width = 2 * rag.radius * rag.n_rows;
  if (std::abs(length - 0.300) > 0.005 || std::abs(width - 0.220) > 0.005) return "";
  return " (Jensen 2018: 6.9 in the simulation of a pipe of 100 mm; 3.1 and 130 cm2 measured in one of 200 mm)";
}

/// The views of two cameras at right angles.
std::string seen_from_the_side(const RagPiece& piece) {
  const Vec3 up = direction_of_travel(piece);
  const Vec3 right = unit(cross(std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, up));
  const Silhouette one = seen_along(piece, up, right), other = seen_along(piece, up, cross(up, right));
  constexpr double per_cm2 = 1e4;
  std::ostringstream text;
  text.precision(3);
  text << "pose of " << piece.rag.name << ": " << piece.plan.kind.word() << ", from two sides an area of " << per_cm2 * one.area << " and "
       << per_cm2 * other.area << " cm2, elongation ratio " << one.elongation_ratio << " and " << other.elongation_ratio
       << published(piece.rag);
  return text.str();
}

/// The first piece whose crumpled pose is that of piece n: of the same table (where), with the same seed.
std::size_t first_alike(const std::vector<RagPiece>& pieces, std::size_t n) {
  const PosePlan& plan = pieces[n].plan;
  if (!plan.crumpled() || !pieces[n].poses.empty()) return n;
  for (std::size_t m = 0; m < n; ++m)
    if (pieces[m].plan.where == plan.where && pieces[m].plan.seed == plan.seed) return m;
  return n;
}

}  // namespace

RagPoses::RagPoses(MPI_Comm comm, std::vector<RagPiece>& pieces, const ContactSettings& contacts, CheckpointReader* stored, MadePoses* made,
                   const std::string& text) {
  // The ranks that build a run must agree on what was made before: those that build runs for themselves have made others.
  const auto key = [&](std::size_t n) { return joined({number_text(size_of(comm)), number_text(n), text}); };
  const auto is_stored = [&](std::size_t n) { return stored && stored->has(name_in_checkpoint(n)); };
  std::vector<std::string> reused;
  std::vector<std::size_t> model(pieces.size());  // the first piece of the same pose
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    model[n] = first_alike(pieces, n);
    if (!pieces[n].plan.crumpled() || model[n] != n) continue;
    if (is_stored(n))
      pieces[n].poses = stored_poses(pieces[n].rag, *stored, n);
    else if (made && made->contains(key(n)))
      pieces[n].poses = made->at(key(n)), reused.push_back("pose of " + pieces[n].rag.name + ": as made for an earlier run");
    else
      log::info("making the pose of " + pieces[n].rag.name + ": " + pieces[n].plan.kind.word());
  }
  std::vector<RagPiece> models;
  for (std::size_t n = 0; n < pieces.size(); ++n)
    if (model[n] == n) models.push_back(pieces[n]);
  lines_ = make_poses(comm, models, contacts);
  lines_.insert(lines_.end(), reused.begin(), reused.end());
  auto next = models.begin();
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    if (model[n] == n) {
      pieces[n] = std::move(*next++);
      if (made && pieces[n].plan.crumpled() && !is_stored(n)) made->emplace(key(n), pieces[n].poses);
    } else {
      pieces[n].poses = pieces[model[n]].poses;
    }
  }
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    if (pieces[n].plan.kind == PosePlan::Kind::flat || model[n] != n) continue;
    lines_.push_back(seen_from_the_side(pieces[n]));
    pieces_.push_back(pieces[n]), numbers_.push_back(n);
  }
}

void RagPoses::write(const std::filesystem::path& folder) const {
  for (std::size_t n = 0; n < pieces_.size(); ++n) write_pose_file(pose_file(folder, numbers_[n]), pieces_[n]);
}

void RagPoses::save(CheckpointWriter& writer) const {
  for (std::size_t n = 0; n < pieces_.size(); ++n)
    if (pieces_[n].plan.crumpled()) writer.shared(name_in_checkpoint(numbers_[n]), as_numbers(pieces_[n].poses));
}

}  // namespace snag
