#include "coupling/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <type_traits>

#include "base/error.hpp"
#include "coupling/cells_around.hpp"
#include "coupling/vector_math.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

constexpr double none = -infinity;      // exponent where no cell is in the support
constexpr int most_components = 9;      // of a field: a tensor
constexpr double balance = 0.75;        // exponent of d_c
constexpr double reach_of_walls = 2.5;  // in widths: farther away the share is above 0.99
constexpr double least_share = 0.125;   // in a corner of three walls

/// int g dV over the ball of this radius, m3.
double integral(const KernelShape& shape, double width, double radius) {
  constexpr int n = 1000;
  const double dr = radius / n;
  std::vector<double> g(n);
  for (int i = 0; i < n; ++i) g[i] = std::pow((i + 0.5) * dr, 2);
  shape.log_weights(g, width);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += 4 * std::numbers::pi * std::pow((i + 0.5) * dr, 2) * dr * std::exp(g[i]);
  return sum;
}

}  // namespace

/// What a rank answers about a particle: four doubles.
struct Kernel::Answer {
  double exponent = none;   // largest ln g of its cells: the shift of `sum`
  double sum = 0;           // sum V_c d_c exp(ln g_c - exponent), m3
  double holder_id = -1;    // cell_id of its cell that holds the particle (exact below 2^53), or -1
  double holder_cell = -1;  // local number of that cell

  static Answer read(const double* from) { return {from[0], from[1], from[2], from[3]}; }
  void write(double* to) const { to[0] = exponent, to[1] = sum, to[2] = holder_id, to[3] = holder_cell; }
};

Kernel::Kernel(const KernelShape& shape, double width, const Mesh& mesh)
    : shape_(shape),
      width_(width),
      support_(shape.support_radius(width)),
      mesh_(mesh),
      locator_(mesh),
      around_(mesh.comm),
      nearest_(mesh.comm) {
  mesh_moved();
  weigh_cells();
}

/// Weights of cells near boundaries, from the shares of the kernels of the cells themselves. Cells of a turning zone keep them.
void Kernel::weigh_cells() {
  cell_weight_.assign(mesh_.cell_volume.begin(), mesh_.cell_volume.begin() + mesh_.n_cells);
  if (!has_width()) return;
  support_ = std::min(support_, reach_of_walls * width_);
  const auto sort_out = [](std::vector<int>& cells) {
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  };
  std::vector<int> at_boundary(mesh_.owner.begin() + mesh_.n_interior, mesh_.owner.begin() + mesh_.n_faces), near;
  sort_out(at_boundary);
  locate_in_parts(at_boundary, [&](std::size_t, std::size_t) {
    near.insert(near.end(), around_.cell.begin(), around_.cell.end());
    sort_out(near);
  });
  std::vector<double> weight = cell_weight_;
  const double whole = integral(shape_, width_, support_);
  locate_in_parts(near, [&](std::size_t first, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      weight[near[first + i]] *= std::pow(std::clamp(sum_of_weights_[i] / whole, least_share, 1.0), -balance);
  });
  cell_weight_ = std::move(weight);
  support_ = shape_.support_radius(width_);
  holder_cell_.clear(), holder_rank_.clear();
}

/// Locates the centres of these cells, some at a time: weights of all together would take too much memory. `use(first, n)` is called after
/// each part with the cells [first, first + n). Collective.
void Kernel::locate_in_parts(const std::vector<int>& cells, const std::function<void(std::size_t, std::size_t)>& use) {
  constexpr std::size_t part = 4096;
  const auto parts = static_cast<std::size_t>(maximum(mesh_.comm, std::ceil(static_cast<double>(cells.size()) / part)));
  std::vector<Vec3> centres;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t first = std::min(i * part, cells.size()), end = std::min(first + part, cells.size());
    centres.clear();
    for (std::size_t j = first; j < end; ++j) centres.push_back(mesh_.cell_centre[cells[j]]);
    locate(centres);
    use(first, end - first);
  }
}

void Kernel::mesh_moved() {
  const auto [lower, upper] = locator_.bounds();
  const std::array<double, 6> box{lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
  boxes_.resize(size_of(mesh_.comm));
  MPI_Allgather(box.data(), 6, MPI_DOUBLE, boxes_.data(), 6, MPI_DOUBLE, mesh_.comm);
}

void Kernel::locate(std::span<const Vec3> points) {
  n_particles_ = static_cast<int>(points.size());
  if (holder_cell_.size() != points.size()) {
    holder_cell_.assign(points.size(), -1);
    holder_rank_.assign(points.size(), -1);
  }
  plan_by_boxes(points);
  std::vector<double> answers, received;
  around_.router.back(search_cells(points), 4, answers);
  std::vector<int> unresolved;
  std::vector<double> factors = weight_factors(answers, unresolved);
  drop_empty_rows(answers, factors);
  around_.router.forward(factors, 1, received);
  finish_weights(received);
  some_in_nearest_cell_ = sum(mesh_.comm, static_cast<std::int64_t>(unresolved.size())) > 0;
  if (some_in_nearest_cell_) take_nearest_cells(points, unresolved);
}

/// A particle is told to the ranks whose cells' bounding box, enlarged by the support, holds it.
void Kernel::plan_by_boxes(std::span<const Vec3> points) {
  std::vector<std::vector<int>> particles_for(boxes_.size());
  const std::vector<int> order = order_in_space(points, support_);
  for (std::size_t r = 0; r < boxes_.size(); ++r) {
    const auto& box = boxes_[r];
    if (box[0] > box[3]) continue;  // a rank without cells
    // A point on the box's face must not be lost by round-off.
    const double margin = support_ + 1e-9 * (std::abs(box[3] - box[0]) + std::abs(box[4] - box[1]) + std::abs(box[5] - box[2]));
    for (const int b : order) {
      const Vec3& x = points[b];
      const bool inside = x.x >= box[0] - margin && x.x <= box[3] + margin && x.y >= box[1] - margin && x.y <= box[4] + margin &&
                          x.z >= box[2] - margin && x.z <= box[5] + margin;
      if (inside) particles_for[r].push_back(b);
    }
  }
  around_.router.plan(particles_for);
}

/// Cells of this rank around the particles it was told of: weights shifted by the nearest of them, and their sums.
std::vector<double> Kernel::search_cells(std::span<const Vec3> points) {
  const auto& router = around_.router;
  std::vector<double> sent(4 * router.n_entries()), received;
  for (int e = 0; e < router.n_entries(); ++e) {
    const int b = router.particle(e);
    const double hint = holder_rank_[b] == router.rank(e) ? holder_cell_[b] : -1;
    std::copy_n(std::array{points[b].x, points[b].y, points[b].z, hint}.data(), 4, &sent[4 * e]);
  }
  router.forward(sent, 4, received);

  const std::size_t n = router.n_received();
  std::vector<Vec3> heard(n);
  for (std::size_t i = 0; i < n; ++i) heard[i] = {received[4 * i], received[4 * i + 1], received[4 * i + 2]};
  CellsAround cells_around(mesh_, locator_, cell_weight_, support_);
  std::vector<double> answers(4 * n), cell_weight;
  received_holder_.resize(n);
  auto& [unused, start, cell, weight] = around_;
  start.assign(1, 0);
  cell.clear(), weight.clear();
  for (std::size_t i = 0; i < n; ++i) {
    Answer answer;
    const int holder = received_holder_[i] = locator_.find(heard[i], static_cast<int>(received[4 * i + 3]));
    if (holder >= 0) answer.holder_id = static_cast<double>(mesh_.cell_id[holder]), answer.holder_cell = holder;
    const std::size_t first = cell.size();
    if (support_ > 0) {
      cells_around.append(heard, i, cell, weight, cell_weight);
      set_weights(std::span(weight).subspan(first), cell_weight.data(), answer.exponent, answer.sum);
    }
    if (answer.exponent == none) {  // no cell here: the holder, should no rank's cell lie in the support
      const std::size_t end = holder >= 0 ? first + 1 : first;
      cell.resize(end, holder), weight.resize(end);
      if (holder >= 0) cell[first] = holder, weight[first] = 1;
    }
    start.push_back(static_cast<int>(cell.size()));
    answer.write(&answers[4 * i]);
  }
  return answers;
}

/// Squared distances become V_c d_c g_c exp(-exponent); exponent: the largest ln g_c, or none; and their sum.
void Kernel::set_weights(std::span<double> weights, const double* cell_weight, double& exponent, double& sum_of_weights) const {
  shape_.log_weights(weights, width_);
  double* w = weights.data();
  const std::size_t n = weights.size();
  double largest = none;
#pragma omp simd reduction(max : largest)
  for (std::size_t s = 0; s < n; ++s) largest = std::max(largest, w[s]);
  exponent = largest;
  if (exponent == none) return;
#pragma omp simd
  for (std::size_t s = 0; s < n; ++s) w[s] = cell_weight[s] * exp(w[s] - largest);
  sum_of_weights = std::accumulate(weights.begin(), weights.end(), 0.0);
}

/// From the answers of all ranks about one particle: the factor that normalises the weights on each of them.
std::vector<double> Kernel::weight_factors(std::span<const double> answers, std::vector<int>& unresolved) {
  const auto& router = around_.router;
  std::vector<double> exponent(n_particles_, none), total(n_particles_, 0.0);
  std::vector<double> holder_id(n_particles_, infinity);
  holder_rank_.assign(n_particles_, -1);
  holder_cell_.assign(n_particles_, -1);
  for (int e = 0; e < router.n_entries(); ++e) {
    const int b = router.particle(e);
    const Answer answer = Answer::read(&answers[4 * static_cast<std::size_t>(e)]);
    exponent[b] = std::max(exponent[b], answer.exponent);
    if (answer.holder_id < 0 || answer.holder_id >= holder_id[b]) continue;
    holder_id[b] = answer.holder_id;
    holder_rank_[b] = router.rank(e);
    holder_cell_[b] = static_cast<int>(answer.holder_cell);
  }
  std::vector<double> factors(router.n_entries(), 0.0);
  for (int e = 0; e < router.n_entries(); ++e) {
    const Answer answer = Answer::read(&answers[4 * static_cast<std::size_t>(e)]);
    if (answer.exponent == none) continue;
    const int b = router.particle(e);
    factors[e] = std::exp(answer.exponent - exponent[b]);
    total[b] += answer.sum * factors[e];
  }
  sum_of_weights_.resize(n_particles_);
  for (int b = 0; b < n_particles_; ++b) sum_of_weights_[b] = total[b] * std::exp(exponent[b]);
  for (int e = 0; e < router.n_entries(); ++e) {
    const int b = router.particle(e);
    if (total[b] > 0)
      factors[e] /= total[b];
    else if (holder_rank_[b] == router.rank(e))
      factors[e] = 1;
  }
  std::int64_t outside = 0;
  for (int b = 0; b < n_particles_; ++b) {
    if (holder_rank_[b] >= 0) continue;
    ++outside;
    if (total[b] == 0) unresolved.push_back(b);
  }
  n_outside_ = sum(mesh_.comm, outside);
  return factors;
}

/// A rank that was told of a particle and has no cell for it hears no more of it; both know so from the answer.
void Kernel::drop_empty_rows(std::span<const double> answers, std::vector<double>& factors) {
  auto& [router, start, cell, weight] = around_;
  std::vector<char> keeps_entry(factors.size()), keeps_row(start.size() - 1);
  std::size_t n_entries = 0, n_rows = 0;
  for (std::size_t e = 0; e < factors.size(); ++e) {
    const Answer answer = Answer::read(&answers[4 * e]);
    keeps_entry[e] = answer.exponent != none || answer.holder_id >= 0 ? 1 : 0;
    if (keeps_entry[e]) factors[n_entries++] = factors[e];
  }
  for (std::size_t i = 0; i + 1 < start.size(); ++i) {
    keeps_row[i] = start[i] < start[i + 1] ? 1 : 0;
    if (keeps_row[i]) start[++n_rows] = start[i + 1];
  }
  router.keep(keeps_entry, keeps_row);
  factors.resize(n_entries), start.resize(n_rows + 1);
}

/// Multiply the weights of each received particle by its factor.
void Kernel::finish_weights(std::span<const double> factors) {
  for (std::size_t i = 0; i < factors.size(); ++i)
    for (int s = around_.start[i]; s < around_.start[i + 1]; ++s) around_.weight[s] *= factors[i];
}

/// Particles that no cell holds and no kernel reaches: every rank names its nearest cell, the nearest of all (lowest cell_id if equal)
/// takes it.
void Kernel::take_nearest_cells(std::span<const Vec3> points, const std::vector<int>& unresolved) {
  const MPI_Comm comm = mesh_.comm;
  const int ranks = size_of(comm), me = rank_of(comm), mine = static_cast<int>(unresolved.size());
  std::vector<Vec3> own(unresolved.size());
  for (int i = 0; i < mine; ++i) own[i] = points[unresolved[i]];
  const std::vector<int> start = row_starts(comm, own.size());
  const std::vector<Vec3> all = gathered(comm, std::span<const Vec3>(own), start);
  const int n = start.back();

  std::vector<int> cell(n);
  std::vector<double> offers(2 * n), all_offers(2 * static_cast<std::size_t>(n) * ranks);  // squared distance, cell_id
  for (int i = 0; i < n; ++i) {
    cell[i] = locator_.nearest(all[i]);
    offers[2 * i] = cell[i] < 0 ? infinity : norm_squared(mesh_.cell_centre[cell[i]] - all[i]);
    offers[2 * i + 1] = cell[i] < 0 ? infinity : static_cast<double>(mesh_.cell_id[cell[i]]);
  }
  MPI_Allgather(offers.data(), 2 * n, MPI_DOUBLE, all_offers.data(), 2 * n, MPI_DOUBLE, comm);

  std::vector<std::vector<int>> particles_for(ranks);
  nearest_.start.assign(1, 0);
  nearest_.cell.clear();
  for (int i = 0; i < n; ++i) {
    int winner = 0;
    const auto offer = [&](int r) {
      const double* o = &all_offers[2 * (static_cast<std::size_t>(r) * n + i)];
      return std::pair(o[0], o[1]);
    };
    for (int r = 1; r < ranks; ++r)
      if (offer(r) < offer(winner)) winner = r;
    if (winner == me) {
      nearest_.cell.push_back(cell[i]);
      nearest_.start.push_back(static_cast<int>(nearest_.cell.size()));
    }
    if (i < start[me] || i >= start[me] + mine) continue;
    const int b = unresolved[i - start[me]];
    particles_for[winner].push_back(b);
    holder_rank_[b] = winner;
  }
  nearest_.weight.assign(nearest_.cell.size(), 1.0);
  nearest_.router.plan(particles_for);
}

std::vector<double> Kernel::average(std::span<const CellField> fields) const {
  int components = 0;
  for (const auto& field : fields) components += field.components;
  std::vector<double> values(static_cast<std::size_t>(n_particles_) * components, 0.0);
  average(around_, fields, components, values);
  if (some_in_nearest_cell_) average(nearest_, fields, components, values);
  return values;
}

std::vector<Vec3> Kernel::average(std::span<const Vec3> field) const {
  const CellField one{field.empty() ? nullptr : &field[0].x, 3};
  const std::vector<double> values = average(std::span(&one, 1));
  std::vector<Vec3> vectors(n_particles_);
  for (int b = 0; b < n_particles_; ++b) vectors[b] = {values[3 * b], values[3 * b + 1], values[3 * b + 2]};
  return vectors;
}

namespace {

/// Calls act with the number of components, as a constant where loops over cells should unroll.
template <class Act>
void with_components(int components, const Act& act) {
  switch (components) {
    case 1:
      return act(std::integral_constant<int, 1>());
    case 3:
      return act(std::integral_constant<int, 3>());
    case 4:
      return act(std::integral_constant<int, 4>());
    case 9:
      return act(std::integral_constant<int, 9>());
    default:
      if (components > most_components)
        throw Error(ExitCode::invariant, "kernel: a field of " + std::to_string(components) + " components, at most " +
                                             std::to_string(most_components) + " are provided for; please report this");
      return act(components);
  }
}

}  // namespace

void Kernel::average(const Stencils& stencils, std::span<const CellField> fields, int components, std::vector<double>& values) const {
  const int n = stencils.router.n_received();
  std::vector<double> answers(static_cast<std::size_t>(n) * components, 0.0), entries;
  // Particle by particle, so that its row of cells and weights stays in the cache for all fields.
  for (int i = 0; i < n; ++i) {
    double* to = answers.data() + static_cast<std::size_t>(i) * components;
    for (const auto& [cell_values, n_components] : fields) {
      with_components(n_components, [&, from = cell_values](auto m) {
        std::array<double, most_components> sum{};
        for (int s = stencils.start[i]; s < stencils.start[i + 1]; ++s) {
          const double* value = from + static_cast<std::size_t>(stencils.cell[s]) * m;
          const double weight = stencils.weight[s];
          for (int j = 0; j < m; ++j) sum[j] += weight * value[j];
        }
        std::copy_n(sum.data(), static_cast<int>(m), to);
      });
      to += n_components;
    }
  }
  stencils.router.back(answers, components, entries);
  for (int e = 0; e < stencils.router.n_entries(); ++e) {
    double* value = values.data() + static_cast<std::size_t>(stencils.router.particle(e)) * components;
    for (int j = 0; j < components; ++j) value[j] += entries[static_cast<std::size_t>(e) * components + j];
  }
}

void Kernel::spread(std::span<const double> amounts, int components, std::span<double> field) const {
  spread(around_, amounts, components, field);
  if (some_in_nearest_cell_) spread(nearest_, amounts, components, field);
}

void Kernel::spread(const Stencils& stencils, std::span<const double> amounts, int components, std::span<double> field) const {
  std::vector<double> received;
  stencils.router.forward_particles(amounts, components, received);
  with_components(components, [&](auto m) {
    for (int i = 0; i < stencils.router.n_received(); ++i) {
      std::array<double, most_components> amount{};
      std::copy_n(received.data() + static_cast<std::size_t>(i) * m, static_cast<int>(m), amount.data());
      for (int s = stencils.start[i]; s < stencils.start[i + 1]; ++s) {
        const int c = stencils.cell[s];
        const double share = stencils.weight[s] / mesh_.cell_volume[c];
        double* to = field.data() + static_cast<std::size_t>(c) * m;
        for (int j = 0; j < m; ++j) to[j] += share * amount[j];
      }
    }
  });
}

std::array<double, 2> Kernel::width_over_cell_size() const {
  double least = infinity, largest = 0;
  for (const int cell : received_holder_) {
    if (cell < 0) continue;
    const double ratio = width_ / std::cbrt(mesh_.cell_volume[cell]);
    least = std::min(least, ratio), largest = std::max(largest, ratio);
  }
  least = minimum(mesh_.comm, least), largest = maximum(mesh_.comm, largest);
  return {largest > 0 ? least : 0, largest};
}

}  // namespace snag
