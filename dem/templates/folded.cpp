#include "dem/templates/folded.hpp"

#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace snag {

namespace {

/// A particle of the folded chain: place along the layers and across them, m; angle theta, rad.
struct ChainPlace {
  double along = 0, above = 0, angle = 0;
};

std::vector<ChainPlace> folded_chain(int n, int n_folds, double radius) {
  const int straight = n - 1 - n_folds * bonds_of_bend;  // bonds of all layers
  std::vector<double> theta;
  for (int layer = 0; layer <= n_folds; ++layer) {
    const auto end_of = [&](std::int64_t layers) { return static_cast<int>(straight * layers / (n_folds + 1)); };
    const int bonds = end_of(layer + 1) - end_of(layer);
    const bool back = layer % 2 == 1;
    theta.insert(theta.end(), bonds + 1, back ? std::numbers::pi : 0);
    for (int k = 1; k < bonds_of_bend && layer < n_folds; ++k) {
      const double turned = std::numbers::pi * k / bonds_of_bend;
      theta.push_back(back ? std::numbers::pi - turned : turned);
    }
  }
  std::vector<ChainPlace> chain(n);
  for (int i = 0; i < n; ++i) {
    chain[i].angle = theta[i];
    if (i == 0) continue;
    const double direction = 0.5 * (theta[i - 1] + theta[i]);
    chain[i].along = chain[i - 1].along + 2 * radius * std::cos(direction);
    chain[i].above = chain[i - 1].above + 2 * radius * std::sin(direction);
  }
  return chain;
}

void check_folds(const RagPiece& piece) {
  const PosePlan& plan = piece.plan;
  const auto refuse = [&](const std::string& what) { throw Error(ExitCode::usage, plan.where + ": pose = \"folded\": " + what); };
  if ((plan.folds_lengthwise > 0) == (plan.folds_crosswise > 0))
    refuse("folds_lengthwise = " + std::to_string(plan.folds_lengthwise) +
           " and folds_crosswise = " + std::to_string(plan.folds_crosswise) +
           ", one of them must be positive and the other 0 (cloth folded both ways is stretched); give one");
  const bool lengthwise = plan.folds_lengthwise > 0;
  const int n = lengthwise ? piece.rag.n_columns : piece.rag.n_rows;
  const int folds = lengthwise ? plan.folds_lengthwise : plan.folds_crosswise, most = (n - 2) / (bonds_of_bend + 1);
  if (folds > most)
    refuse(std::string(lengthwise ? "folds_lengthwise" : "folds_crosswise") + " = " + std::to_string(folds) + ", a row of " +
           std::to_string(n) + " particles has room for " + std::to_string(most) + " at most; give fewer folds or a smaller radius");
}

}  // namespace

std::vector<ParticlePose> folded_poses(const RagPiece& piece) {
  check_folds(piece);
  const Rag& rag = piece.rag;
  const bool lengthwise = piece.plan.folds_lengthwise > 0;
  const auto chain = lengthwise ? folded_chain(rag.n_columns, piece.plan.folds_lengthwise, rag.radius)
                                : folded_chain(rag.n_rows, piece.plan.folds_crosswise, rag.radius);
  std::vector<ParticlePose> poses;
  Vec3 mean;
  for (int row = 0; row < rag.n_rows; ++row)
    for (int column = 0; column < rag.n_columns; ++column) {
      const ChainPlace& at = chain[lengthwise ? column : row];
      const double c = std::cos(at.angle / 2), s = std::sin(at.angle / 2);
      // Layers rise along the normal of the sheet: a turn about -y takes x towards z, one about x takes y towards z.
      const Vec3 place = lengthwise ? Vec3{at.along, 2 * rag.radius * row, at.above} : Vec3{2 * rag.radius * column, at.along, at.above};
      const Quaternion turn = lengthwise ? Quaternion{c, 0, -s, 0} : Quaternion{c, s, 0, 0};
      poses.push_back({place, product(piece.orientation, turn)});
      if (piece.exists(column, row)) mean += place;
    }
  mean = mean / static_cast<double>(count_particles(piece));
  for (ParticlePose& pose : poses) pose.position = rotate(piece.orientation, pose.position - mean);
  return poses;
}

}  // namespace snag
