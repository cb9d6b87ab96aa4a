#include "coupling/diffusion_weights.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "parallel/sum.hpp"

namespace snag {

namespace {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double tolerance = 1e-10;

/// Largest distance of a node from the centre of its cell, m. Collective.
double largest_radius(const Mesh& mesh) {
  double largest = 0;
  for (int c = 0; c < mesh.n_cells; ++c)
    for (int n = mesh.cell_node_start[c]; n < mesh.cell_node_start[c + 1]; ++n)
      largest = std::max(largest, norm_squared(mesh.node[mesh.cell_node[n]] - mesh.cell_centre[c]));
  return std::sqrt(maximum(mesh.comm, largest));
}

}  // namespace

/// Cells of the graph about the one that comes first.
struct DiffusionWeights::Patch {
  std::vector<int> cell;                        // of the graph
  std::vector<Eigen::Triplet<double>> entries;  // of V + a K, m3, above the diagonal and on it; those of one place are summed
};

DiffusionWeights::DiffusionWeights(const Mesh& mesh, double area, int n_steps, double cut)
    : mesh_(mesh), area_(area), n_steps_(n_steps), cut_(cut), reach_(cut + largest_radius(mesh)) {}

void DiffusionWeights::mesh_moved(const RankBoxes& boxes) {
  boxes_ = boxes;
  graph_is_old_ = true;
  std::erase_if(kept_, [](const auto& entry) { return entry.second.at_interface; });
}

void DiffusionWeights::locate(const Announcement& announced) {
  const auto& router = announced.router;
  std::vector<double> sent(static_cast<std::size_t>(router.n_entries())), received;
  for (std::size_t e = 0; e < sent.size(); ++e) sent[e] = static_cast<double>(announced.holder_id[router.particle(static_cast<int>(e))]);
  router.forward(sent, 1, received);

  make_missing_rows(received);

  inside_.assign(announced.holder_rank.size(), 1.0);
  unresolved_.clear();
  for (std::size_t b = 0; b < announced.holder_rank.size(); ++b)
    if (announced.holder_rank[b] < 0) inside_[b] = 0, unresolved_.push_back(static_cast<int>(b));

  rows_.clear();
  std::unordered_map<std::int64_t, int> row_of;
  ++n_uses_;
  for (const double id : received) {
    const auto holder_id = static_cast<std::int64_t>(id);
    const auto [known, is_new] = row_of.emplace(holder_id, rows_.n_rows());
    if (!is_new) {
      rows_.row.push_back(known->second);
      continue;
    }
    Row& row = kept_.at(holder_id);
    row.last_use = n_uses_;
    for (const int cell : row.cell) rows_.place.push_back(rows_.place_of(cell));
    rows_.weight.insert(rows_.weight.end(), row.weight.begin(), row.weight.end());
    rows_.close_row();
  }
  if (kept_.size() > 4 * row_of.size()) std::erase_if(kept_, [this](const auto& entry) { return entry.second.last_use < n_uses_; });
}

/// On the graph as it stands, which is made when a rank needs it.
void DiffusionWeights::make_missing_rows(std::span<const double> holder_ids) {
  std::vector<std::int64_t> missing;
  for (const double id : holder_ids)
    if (const auto holder_id = static_cast<std::int64_t>(id); !kept_.contains(holder_id)) missing.push_back(holder_id);
  if (graph_is_old_ && maximum(mesh_.comm, static_cast<double>(missing.size())) > 0) {
    graph_.update(mesh_, boxes_, 2 * reach_);
    place_in_patch_.assign(graph_.id.size(), -1);
    graph_is_old_ = false;
  }
  for (const std::int64_t holder_id : missing)
    if (!kept_.contains(holder_id)) kept_.emplace(holder_id, made_row(holder_id));
}

/// Cells of this rank in the row of a cell; none for a cell that is not near, or -1.
DiffusionWeights::Row DiffusionWeights::made_row(std::int64_t holder_id) {
  Row row;
  const int holder = graph_.find(holder_id);
  if (holder < 0) return row;
  Patch patch;
  find_patch(holder, patch);
  const Eigen::VectorXd amount = diffused(patch);
  for (std::size_t i = 0; i < patch.cell.size(); ++i) {
    const int cell = patch.cell[i];
    row.at_interface = row.at_interface || graph_.at_interface[cell] != 0;
    if (graph_.own[cell] >= 0) row.cell.push_back(graph_.own[cell]), row.weight.push_back(amount[static_cast<Eigen::Index>(i)]);
  }
  return row;
}

/// Cells within the cut that faces join to the holder, from near to far, and the faces between them.
void DiffusionWeights::find_patch(int holder, Patch& patch) {
  const double cut_squared = cut_ * cut_;
  patch.cell.assign(1, holder);
  place_in_patch_[holder] = 0;
  for (std::size_t i = 0; i < patch.cell.size(); ++i) {
    const int from = patch.cell[i];
    for (int l = graph_.start[from]; l < graph_.start[from + 1]; ++l) {
      const int to = graph_.beyond[l];
      int& place = place_in_patch_[to];
      if (place < 0 && norm_squared(graph_.centre[to] - graph_.centre[holder]) < cut_squared) {
        place = static_cast<int>(patch.cell.size());
        patch.cell.push_back(to);
      }
      if (place < 0 || place <= static_cast<int>(i)) continue;  // beyond the cut, or a face that is known from the other side
      const int near = static_cast<int>(i);
      const double k = area_ * graph_.conductance[l];
      patch.entries.emplace_back(near, place, -k), patch.entries.emplace_back(near, near, k), patch.entries.emplace_back(place, place, k);
    }
  }
  for (std::size_t i = 0; i < patch.cell.size(); ++i) {
    const int cell = patch.cell[i], at = static_cast<int>(i);
    patch.entries.emplace_back(at, at, graph_.volume[cell]);
    place_in_patch_[cell] = -1;
  }
}

/// Share of one at the first cell that is in each cell after m steps, 1.
Eigen::VectorXd DiffusionWeights::diffused(const Patch& patch) const {
  const auto n = static_cast<Eigen::Index>(patch.cell.size());
  Eigen::VectorXd volume(n), amount = Eigen::VectorXd::Unit(n, 0), concentration = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) volume[i] = graph_.volume[patch.cell[static_cast<std::size_t>(i)]];
  SymmetricMatrix upper(n, n), matrix(n, n);
  upper.setFromTriplets(patch.entries.begin(), patch.entries.end());
  matrix = upper.selfadjointView<Eigen::Upper>();
  Eigen::ConjugateGradient<SymmetricMatrix, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(tolerance);
  for (int step = 0; step < n_steps_; ++step) {
    concentration = solver.solveWithGuess(amount, concentration);
    amount = volume.cwiseProduct(concentration);
    amount /= amount.sum();
  }
  return amount;
}

}  // namespace snag
