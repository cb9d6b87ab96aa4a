#include "coupling/point_kernel.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "coupling/cell_weights.hpp"

namespace snag {

namespace {

class PointWeights final : public CellWeights {
 public:
  PointWeights(std::vector<Vec3> points, const Mesh& mesh, const CellLocator& locator)
      : points_(std::move(points)), mesh_(mesh), locator_(locator), cell_factor_(mesh.n_cells, 1.0) {
    for (const Vec3& r : points_) reach_ = std::max(reach_, norm(r));
  }

  double reach() const override { return reach_; }
  bool start_balancing() override { return points_.size() > 1; }
  void set_cell_factors(const std::vector<double>& factors) override { cell_factor_ = factors; }
  std::int64_t n_points_outside() const override { return n_points_outside_; }

  void locate(const Announcement& announced) override {
    const int n = static_cast<int>(points_.size());
    std::vector<double> answers, shares;
    announced.router.back(search(announced), 2 * n, answers);
    announced.router.forward(settle(announced, answers), n, shares);
    fill_rows(shares);
  }

 private:
  /// Of each announced particle and point: cell_id and factor of the owned cell that holds it; -1, 0: none does.
  std::vector<double> search(const Announcement& announced) {
    const std::size_t n = points_.size();
    found_.resize(n * announced.places.size());
    if (hints_.size() > 2 * announced.places.size()) hints_.clear();  // particles that have left
    std::vector<double> answers(2 * found_.size());
    for (std::size_t i = 0; i < announced.places.size(); ++i) {
      found_[i * n] = announced.holder[i];  // the first point is the particle's centre
      if (n > 1) find_further_points(announced.places[i], hints_[announced.number[i]], &found_[i * n]);
    }
    for (std::size_t place = 0; place < found_.size(); ++place) {
      const int cell = found_[place];
      answers[2 * place] = cell >= 0 ? static_cast<double>(mesh_.cell_id[cell]) : -1;
      answers[2 * place + 1] = cell >= 0 ? cell_factor_[cell] : 0;
    }
    return answers;
  }

  void find_further_points(const Vec3& centre, std::vector<int>& hints, int* found) {
    hints.resize(points_.size(), found[0]);
    for (std::size_t k = 1; k < points_.size(); ++k) {
      found[k] = locator_.find(centre + points_[k], hints[k]);
      if (found[k] >= 0) hints[k] = found[k];
    }
  }

  /// Share of each entry and point in the weight of its particle, 1.
  std::vector<double> settle(const Announcement& announced, std::span<const double> answers) {
    const auto& router = announced.router;
    const std::size_t n = points_.size(), n_particles = announced.holder_rank.size(), n_entries = router.n_entries();
    constexpr std::size_t nowhere = -1;
    std::vector<std::size_t> entry_of(n_particles * n, nowhere);  // the one that counts
    for (std::size_t e = 0; e < n_entries; ++e)
      for (std::size_t k = 0; k < n; ++k) {
        std::size_t& best = entry_of[router.particle(static_cast<int>(e)) * n + k];
        const double id = answers[2 * (e * n + k)];
        if (id >= 0 && (best == nowhere || id < answers[2 * (best * n + k)])) best = e;
      }
    std::vector<double> shares(n_entries * n, 0.0);
    inside_.resize(n_particles);
    unresolved_.clear();
    n_points_outside_ = 0;
    for (std::size_t b = 0; b < n_particles; ++b) {
      const std::size_t* entry = &entry_of[b * n];
      double total = 0;
      int held = 0;
      for (std::size_t k = 0; k < n; ++k)
        if (entry[k] != nowhere) total += answers[2 * (entry[k] * n + k) + 1], ++held;
      for (std::size_t k = 0; k < n; ++k)
        if (entry[k] != nowhere) shares[entry[k] * n + k] = answers[2 * (entry[k] * n + k) + 1] / total;
      inside_[b] = total / static_cast<double>(n);
      if (held == 0) unresolved_.push_back(static_cast<int>(b));
      n_points_outside_ += static_cast<std::int64_t>(n) - held - (announced.holder_rank[b] < 0 ? 1 : 0);
    }
    return shares;
  }

  /// Points of a particle in one cell become one entry of its row.
  void fill_rows(std::span<const double> shares) {
    const std::size_t n = points_.size();
    rows_.clear();
    std::vector<std::pair<int, double>> row;
    for (std::size_t first = 0; first < found_.size(); first += n) {
      row.clear();
      for (std::size_t place = first; place < first + n; ++place)
        if (shares[place] > 0) row.emplace_back(found_[place], shares[place]);
      std::sort(row.begin(), row.end());
      for (std::size_t k = 0; k < row.size(); ++k) {
        const auto& [cell, share] = row[k];
        if (k == 0 || row[k - 1].first != cell) rows_.place.push_back(rows_.place_of(cell)), rows_.weight.push_back(0);
        rows_.weight.back() += share;
      }
      rows_.close_row();
    }
  }

  std::vector<Vec3> points_;  // r_k, m
  double reach_ = 0;
  const Mesh& mesh_;
  const CellLocator& locator_;
  std::vector<double> cell_factor_;                           // d_c of the owned cells
  std::vector<int> found_;                                    // owned cell of each announced particle and point, or -1
  std::unordered_map<std::int64_t, std::vector<int>> hints_;  // by number of the particle: the cells that held its points
  std::int64_t n_points_outside_ = 0;
};

}  // namespace

std::unique_ptr<CellWeights> PointKernel::weights(double width, const Mesh& mesh, const CellLocator& locator) const {
  return std::make_unique<PointWeights>(points(width), mesh, locator);
}

}  // namespace snag
