#include "coupling/distance_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/cell_weights.hpp"
#include "coupling/cells_around.hpp"
#include "coupling/vector_math.hpp"

namespace snag {

namespace {

constexpr double none = -infinity;      // exponent where no cell is in the support
constexpr double reach_of_walls = 3.5;  // in widths: farther away the share of the kernel in the mesh is above 0.999

/// int g dV over the ball of this radius, m3.
double integral(const DistanceKernel& kernel, double width, double radius) {
  constexpr int n = 1000;
  const double dr = radius / n;
  std::vector<double> g(n);
  for (int i = 0; i < n; ++i) g[i] = std::pow((i + 0.5) * dr, 2);
  kernel.log_weights(g, width);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += 4 * std::numbers::pi * std::pow((i + 0.5) * dr, 2) * dr * std::exp(g[i]);
  return sum;
}

/// What a rank answers about a particle: two doubles.
struct Answer {
  double exponent = none;  // largest ln g of its cells: the shift of `sum`
  double sum = 0;          // sum V_c d_c exp(ln g_c - exponent), m3

  static Answer read(std::span<const double> answers, std::size_t n) { return {answers[2 * n], answers[2 * n + 1]}; }
  void write(std::vector<double>& answers, std::size_t n) const { answers[2 * n] = exponent, answers[2 * n + 1] = sum; }
};

class DistanceWeights final : public CellWeights {
 public:
  DistanceWeights(const DistanceKernel& kernel, double width, const Mesh& mesh, const CellLocator& locator)
      : kernel_(kernel),
        width_(width),
        mesh_(mesh),
        locator_(locator),
        cell_weight_(mesh.cell_volume.begin(), mesh.cell_volume.begin() + mesh.n_cells) {
    set_support(kernel.support_radius(width));
  }

  double reach() const override { return support_; }

  bool start_balancing() override {
    set_support(std::min(support_, reach_of_walls * width_));
    return true;
  }
  void set_cell_factors(const std::vector<double>& factors) override {
    for (int c = 0; c < mesh_.n_cells; ++c) cell_weight_[c] = mesh_.cell_volume[c] * factors[c];
  }
  void end_balancing() override { set_support(kernel_.support_radius(width_)); }

  void locate(const Announcement& announced) override {
    std::vector<double> answers, factors;
    announced.router.back(search(announced), 2, answers);
    announced.router.forward(settle(announced, answers), 1, factors);
    for (std::size_t i = 0; i < factors.size(); ++i)
      if (factors[i] != 1)  // other ranks have cells too
        for (int s = rows_.start[i]; s < rows_.start[i + 1]; ++s) rows_.weight[s] *= factors[i];
  }

 private:
  void set_support(double radius) {
    support_ = radius;
    whole_ = integral(kernel_, width_, radius);
  }

  /// Cells of this rank around the announced particles: weights as if there were no others, with the shift by the nearest of them and the
  /// sums.
  std::vector<double> search(const Announcement& announced) {
    CellsAround cells_around(mesh_, locator_, cell_weight_, support_);
    std::vector<double> answers(2 * announced.places.size()), cell_weight;
    rows_.clear();
    for (std::size_t i = 0; i < announced.places.size(); ++i) {
      Answer answer;
      const std::size_t first = rows_.place.size();
      cells_around.append(announced.places, i, rows_, cell_weight);
      set_weights(std::span(rows_.weight).subspan(first), cell_weight.data(), answer);
      if (answer.exponent == none) {  // no cell here: the holder, should no rank's cell lie in the support
        const int holder = announced.holder[i];
        rows_.place.resize(first), rows_.weight.resize(first);
        if (holder >= 0) rows_.place.push_back(rows_.place_of(holder)), rows_.weight.push_back(1);
      }
      rows_.close_row();
      answer.write(answers, i);
    }
    return answers;
  }

  /// Squared distances become V_c d_c g_c exp(-exponent) over the sum of these.
  void set_weights(std::span<double> weights, const double* cell_weight, Answer& answer) const {
    kernel_.log_weights(weights, width_);
    double* w = weights.data();
    const std::size_t n = weights.size();
    double largest = none;
#pragma omp simd reduction(max : largest)
    for (std::size_t s = 0; s < n; ++s) largest = std::max(largest, w[s]);
    answer.exponent = largest;
    if (largest == none) return;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t s = 0; s < n; ++s) {
      w[s] = cell_weight[s] * exp(w[s] - largest);
      sum += w[s];
    }
    answer.sum = sum;
    const double factor = 1 / sum;
#pragma omp simd
    for (std::size_t s = 0; s < n; ++s) w[s] *= factor;
  }

  /// From the answers of all ranks about one particle: the share of each of them in the weights.
  std::vector<double> settle(const Announcement& announced, std::span<const double> answers) {
    const auto& router = announced.router;
    const std::size_t n_particles = announced.holder_rank.size(), n_entries = router.n_entries();
    std::vector<double> exponent(n_particles, none), total(n_particles, 0.0), factors(n_entries, 0.0);
    for (std::size_t e = 0; e < n_entries; ++e) {
      const int b = router.particle(static_cast<int>(e));
      exponent[b] = std::max(exponent[b], Answer::read(answers, e).exponent);
    }
    for (std::size_t e = 0; e < n_entries; ++e) {
      const Answer answer = Answer::read(answers, e);
      if (answer.exponent == none) continue;
      const int b = router.particle(static_cast<int>(e));
      factors[e] = answer.sum * std::exp(answer.exponent - exponent[b]);
      total[b] += factors[e];
    }
    inside_.resize(n_particles);
    unresolved_.clear();
    for (std::size_t b = 0; b < n_particles; ++b) {
      inside_[b] = total[b] * std::exp(exponent[b]) / whole_;
      if (total[b] == 0 && announced.holder_rank[b] < 0) unresolved_.push_back(static_cast<int>(b));
    }
    for (std::size_t e = 0; e < n_entries; ++e) {
      const int b = router.particle(static_cast<int>(e));
      if (total[b] > 0)
        factors[e] /= total[b];
      else if (announced.holder_rank[b] == router.rank(static_cast<int>(e)))
        factors[e] = 1;
    }
    return factors;
  }

  const DistanceKernel& kernel_;
  double width_;
  double support_ = 0;  // radius of search, m
  double whole_ = 0;    // int g dV over it, m3
  const Mesh& mesh_;
  const CellLocator& locator_;
  std::vector<double> cell_weight_;  // V_c d_c of the owned cells, m3
};

}  // namespace

double DistanceKernel::cells_reached(double width, double side) const {
  return 4.0 / 3.0 * std::numbers::pi * std::pow(support_radius(width) / side, 3);
}

std::unique_ptr<CellWeights> DistanceKernel::weights(double width, const Mesh& mesh, const CellLocator& locator) const {
  return std::make_unique<DistanceWeights>(*this, width, mesh, locator);
}

}  // namespace snag
