#include "coupling/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <type_traits>
#include <utility>

#include "base/flat.hpp"
#include "base/log.hpp"
#include "coupling/cells_around.hpp"
#include "parallel/rows.hpp"
#include "parallel/session.hpp"
#include "parallel/sum.hpp"

namespace snag {

namespace {

// Of the rounds that find d_c. Each leaves at most a third of what is missing, whatever its wavelength.
constexpr double relaxation = 2.0 / 3.0, least_share = 0.125;  // share of a kernel in the mesh in a corner of three walls
constexpr double even = 0.01;                                  // what an even layer gives is so near 1
constexpr int max_rounds = 8;
constexpr double many_pairs = 5e8;  // of cells at boundaries and cells in their kernels

void sort_out(std::vector<int>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

}  // namespace

Kernel::Kernel(const KernelShape& shape, double width, const Mesh& mesh, KnownFactors* known)
    : shape_(shape),
      width_(width),
      mesh_(mesh),
      locator_(mesh),
      weights_(shape.weights(width, mesh, locator_)),
      around_(mesh.comm),
      to_nearest_(mesh.comm) {
  mesh_moved();
  KnownFactors own;
  weigh_cells(known ? *known : own);
}

/// Gives the cells their factors. Those of a turning zone keep them.
void Kernel::weigh_cells(KnownFactors& known) {
  if (!weights_->start_balancing()) return;
  const std::vector<double>* factors = known.find(shape_, width_);
  weights_->set_cell_factors(factors ? *factors : known.keep(shape_, width_, find_factors()));
  weights_->end_balancing();
  holder_cell_.clear(), holder_rank_.clear();
}

/// Where a kernel reaches far beyond small cells, a case would seem to hang before it says a word.
void Kernel::warn_of_many_pairs(std::int64_t n_at_boundary) const {
  const double n_cells = static_cast<double>(mesh_.n_cells_global);
  const double volume = sum(mesh_.comm, std::accumulate(mesh_.cell_volume.begin(), mesh_.cell_volume.begin() + mesh_.n_cells, 0.0));
  const double side = std::cbrt(volume / n_cells), reached = std::min(shape_.cells_reached(width_, side), n_cells);
  if (static_cast<double>(sum(mesh_.comm, n_at_boundary)) * reached < many_pairs) return;
  std::ostringstream message;
  message.precision(3);
  message << "[coupling] kernel_width is " << 1e3 * width_ << " mm and reaches some " << std::llround(reached) << " cells (mean "
          << 1e3 * side
          << " mm): its weights at the walls, which are found now, can take minutes; narrow the kernel, or take coarser cells";
  log::warning(message.str());
}

/// Factors of cells near boundaries: rounds of (eq. 2) with the kernels of the cells themselves.
std::vector<double> Kernel::find_factors() {
  std::vector<int> at_boundary(mesh_.owner.begin() + mesh_.n_interior, mesh_.owner.begin() + mesh_.n_faces), near;
  sort_out(at_boundary);
  warn_of_many_pairs(static_cast<std::int64_t>(at_boundary.size()));
  locate_in_parts(at_boundary, [&](std::size_t, std::size_t) {
    const WeightRows& rows = weights_->rows();
    for (const int place : rows.place) near.push_back(rows.cells()[place]);
    sort_out(near);
  });
  std::vector<double> factor(mesh_.n_cells, 1.0), next = factor, open(near.size(), 1.0);
  double missing = infinity;
  for (int round = 0; round < max_rounds && missing > even; ++round) {
    missing = 0;
    locate_in_parts(near, [&](std::size_t first, std::size_t n) {
      for (std::size_t i = first; i < first + n; ++i) {
        const double share = weights_->inside()[i - first];
        if (round == 0) open[i] = std::max(share, 1.0);
        const double had = factor[near[i]], gives = had * std::max(share / open[i], least_share);
        missing = std::max(missing, std::abs(gives - 1));
        next[near[i]] = had * std::pow(gives, -relaxation);
      }
    });
    missing = maximum(mesh_.comm, missing);
    weights_->set_cell_factors(factor = next);
  }
  return factor;
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
  const CellBox box = locator_.bounds();
  static_assert(sizeof box == 6 * sizeof(double));
  boxes_.resize(size_of(mesh_.comm));
  MPI_Allgather(&box, 6, MPI_DOUBLE, boxes_.data(), 6, MPI_DOUBLE, mesh_.comm);
  weights_->mesh_moved(boxes_);
}

void Kernel::locate(std::span<const Vec3> points) {
  n_particles_ = static_cast<int>(points.size());
  if (holder_cell_.size() != points.size()) {
    holder_cell_.assign(points.size(), -1);
    holder_rank_.assign(points.size(), -1);
  }
  plan_by_boxes(points);
  find_holders(points);
  weights_->locate({around_, holder_rank_, holder_id_, announced_places_, announced_holder_, announced_number_});
  drop_empty_rows();
  is_inside_.clear();
  for (const int rank : holder_rank_) is_inside_.push_back(rank >= 0);
  n_outside_ = sum(mesh_.comm, static_cast<std::int64_t>(std::count(is_inside_.begin(), is_inside_.end(), 0)));
  n_points_outside_ = n_outside_ + sum(mesh_.comm, weights_->n_points_outside());
  const std::vector<int>& unresolved = weights_->unresolved();
  some_in_nearest_cell_ = sum(mesh_.comm, static_cast<std::int64_t>(unresolved.size())) > 0;
  if (some_in_nearest_cell_) take_nearest_cells(points, unresolved);
}

/// A particle is announced to the ranks whose cells' bounding box, enlarged by the reach, holds it.
void Kernel::plan_by_boxes(std::span<const Vec3> points) {
  std::vector<std::vector<int>> particles_for(boxes_.size());
  const std::vector<int> order = order_in_space(points, weights_->reach());
  for (std::size_t r = 0; r < boxes_.size(); ++r)
    for (const int b : order)
      if (boxes_[r].is_near(points[b], weights_->reach())) particles_for[r].push_back(b);
  around_.plan(particles_for);
}

/// The cell that holds each particle: of the ranks that answer, the one with the lowest cell_id (exact below 2^53).
void Kernel::find_holders(std::span<const Vec3> points) {
  constexpr int n_sent = 5;  // place, hint, number
  std::vector<double> sent(n_sent * around_.n_entries()), received, answers;
  const double n_ranks = static_cast<double>(boxes_.size()), me = rank_of(mesh_.comm);
  for (int e = 0; e < around_.n_entries(); ++e) {
    const int b = around_.particle(e);
    const double hint = holder_rank_[b] == around_.rank(e) ? holder_cell_[b] : -1;
    std::copy_n(std::array{points[b].x, points[b].y, points[b].z, hint, b * n_ranks + me}.data(), n_sent, &sent[n_sent * e]);
  }
  around_.forward(sent, n_sent, received);
  const std::size_t n = around_.n_received();
  announced_places_.resize(n), announced_holder_.resize(n), announced_number_.resize(n);
  std::vector<double> found(2 * n);  // cell_id and local number, or -1
  for (std::size_t i = 0; i < n; ++i) {
    const double* from = &received[n_sent * i];
    announced_places_[i] = {from[0], from[1], from[2]};
    announced_number_[i] = static_cast<std::int64_t>(from[4]);
    const int cell = announced_holder_[i] = locator_.find(announced_places_[i], static_cast<int>(from[3]));
    found[2 * i] = cell >= 0 ? static_cast<double>(mesh_.cell_id[cell]) : -1;
    found[2 * i + 1] = cell;
  }
  around_.back(found, 2, answers);
  holder_rank_.assign(points.size(), -1), holder_cell_.assign(points.size(), -1), holder_id_.assign(points.size(), -1);
  for (int e = 0; e < around_.n_entries(); ++e) {
    const int b = around_.particle(e);
    const auto id = static_cast<std::int64_t>(answers[2 * static_cast<std::size_t>(e)]);
    if (id < 0 || (holder_id_[b] >= 0 && id >= holder_id_[b])) continue;
    holder_id_[b] = id;
    holder_rank_[b] = around_.rank(e);
    holder_cell_[b] = static_cast<int>(answers[2 * static_cast<std::size_t>(e) + 1]);
  }
}

/// A rank to which a particle was announced and that has no cell for it hears no more of it.
void Kernel::drop_empty_rows() {
  const WeightRows& rows = weights_->rows();
  std::vector<double> counts(rows.row.size()), answers;
  std::vector<char> keeps_entry(static_cast<std::size_t>(around_.n_entries())), keeps_row(rows.row.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = keeps_row[i] = rows.is_empty(rows.row[i]) ? 0 : 1;
  around_.back(counts, 1, answers);
  for (std::size_t e = 0; e < keeps_entry.size(); ++e) keeps_entry[e] = answers[e] > 0 ? 1 : 0;
  around_.keep(keeps_entry, keeps_row);
  weights_->keep(keeps_row);
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
  nearest_.clear();
  for (int i = 0; i < n; ++i) {
    int winner = 0;
    const auto offer = [&](int r) {
      const double* o = &all_offers[2 * (static_cast<std::size_t>(r) * n + i)];
      return std::pair(o[0], o[1]);
    };
    for (int r = 1; r < ranks; ++r)
      if (offer(r) < offer(winner)) winner = r;
    if (winner == me) {
      nearest_.place.push_back(nearest_.place_of(cell[i])), nearest_.weight.push_back(1);
      nearest_.close_row();
    }
    if (i < start[me] || i >= start[me] + mine) continue;
    const int b = unresolved[i - start[me]];
    particles_for[winner].push_back(b);
    holder_rank_[b] = winner;
  }
  to_nearest_.plan(particles_for);
}

namespace {

template <class Field>
int total_components(std::span<const Field> fields) {
  int components = 0;
  for (const Field& field : fields) components += field.components;
  return components;
}

/// Components with zeros behind the last: columns that loops take in whole vectors.
int padded(int components) { return components == 1 ? 1 : components <= 4 ? 4 : (components + 7) / 8 * 8; }

/// Calls act(first column, number of columns as a constant) until all columns are done.
template <class Act>
void for_columns(int stride, const Act& act) {
  if (stride == 1) return act(0, std::integral_constant<int, 1>());
  if (stride == 4) return act(0, std::integral_constant<int, 4>());
  int first = 0;
  for (; first + 32 <= stride; first += 32) act(first, std::integral_constant<int, 32>());
  for (; first + 24 <= stride; first += 24) act(first, std::integral_constant<int, 24>());
  for (; first + 16 <= stride; first += 16) act(first, std::integral_constant<int, 16>());
  for (; first < stride; first += 8) act(first, std::integral_constant<int, 8>());
}

/// The fields at the cells of the rows, [n_cells in use][padded components].
void pack(const WeightRows& rows, std::span<const CellField> fields, int stride, std::vector<double>& values) {
  values.assign(rows.cells().size() * stride, 0.0);
  int first = 0;
  for (const auto& [of_cells, components] : fields) {
    double* to = values.data() + first;
    for (const int c : rows.cells()) {
      const double* from = of_cells + static_cast<std::size_t>(c) * components;
      for (int j = 0; j < components; ++j) to[j] = from[j];
      to += stride;
    }
    first += components;
  }
}

/// sum_s weight_s value_s of the entries of a row, m columns from the first one. Two sums, as the next addition to one of them has to wait
/// for the last.
template <int m>
std::array<double, m> row_average(const WeightRows& rows, int row, const double* values, int stride) {
  std::array<double, m> sum{}, other{};
  const auto add = [&](std::array<double, m>& to, int s) {
    const double* value = values + static_cast<std::size_t>(rows.place[s]) * stride;
    const double weight = rows.weight[s];
    for (int j = 0; j < m; ++j) to[j] += weight * value[j];
  };
  int s = rows.start[row];
  for (; s + 2 <= rows.start[row + 1]; s += 2) add(sum, s), add(other, s + 1);
  if (s < rows.start[row + 1]) add(sum, s);
  for (int j = 0; j < m; ++j) sum[j] += other[j];
  return sum;
}

/// Adds the averages of the rows to the values of the particles, [n_particles][components]: each row is averaged once.
void add_averages(const ParticleRouter& router, const WeightRows& rows, std::span<const CellField> fields, KernelScratch& scratch,
                  std::vector<double>& values) {
  const int components = total_components(fields), stride = padded(components);
  const auto width = static_cast<std::size_t>(components);
  std::vector<double>&of_cells = scratch.of_cells, &of_row = scratch.of_row, &answers = scratch.answers, &entries = scratch.entries;
  pack(rows, fields, stride, of_cells);
  of_row.resize(static_cast<std::size_t>(stride) * rows.n_rows());
  answers.resize(width * rows.row.size());
  for (int r = 0; r < rows.n_rows(); ++r)
    for_columns(stride, [&](int first, auto m) {
      const std::array<double, m> average = row_average<m>(rows, r, of_cells.data() + first, stride);
      std::copy_n(average.data(), static_cast<int>(m), of_row.data() + static_cast<std::size_t>(r) * stride + first);
    });
  for (std::size_t i = 0; i < rows.row.size(); ++i)
    std::copy_n(of_row.data() + static_cast<std::size_t>(rows.row[i]) * stride, width, answers.data() + i * width);
  router.back(answers, components, entries);
  for (int e = 0; e < router.n_entries(); ++e) {
    double* value = values.data() + static_cast<std::size_t>(router.particle(e)) * width;
    for (std::size_t j = 0; j < width; ++j) value[j] += entries[static_cast<std::size_t>(e) * width + j];
  }
}

/// Adds the amounts of the particles, per volume, to the cells of the rows: those of particles with one row together.
void add_amounts(const ParticleRouter& router, const WeightRows& rows, std::span<const double> amounts, std::span<const CellSums> fields,
                 const std::vector<double>& cell_volume, KernelScratch& scratch) {
  const int components = total_components(fields), stride = padded(components);
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> received;
  router.forward_particles(amounts, components, received);
  std::vector<double>&of_cells = scratch.of_cells, &of_row = scratch.of_row;
  of_row.assign(static_cast<std::size_t>(stride) * rows.n_rows(), 0.0), of_cells.assign(rows.cells().size() * stride, 0.0);
  for (std::size_t i = 0; i < rows.row.size(); ++i)
    for (std::size_t j = 0; j < width; ++j) of_row[static_cast<std::size_t>(rows.row[i]) * stride + j] += received[i * width + j];
  for (int r = 0; r < rows.n_rows(); ++r)
    for_columns(stride, [&](int first, auto m) {
      std::array<double, m> amount;
      std::copy_n(of_row.data() + static_cast<std::size_t>(r) * stride + first, static_cast<int>(m), amount.data());
      for (int s = rows.start[r]; s < rows.start[r + 1]; ++s) {
        const double weight = rows.weight[s];
        double* to = of_cells.data() + static_cast<std::size_t>(rows.place[s]) * stride + first;
        for (int j = 0; j < m; ++j) to[j] += weight * amount[j];
      }
    });
  int first = 0;
  for (const auto& [values, n] : fields) {
    const double* from = of_cells.data() + first;
    for (const int c : rows.cells()) {
      double* to = values + static_cast<std::size_t>(c) * n;
      for (int j = 0; j < n; ++j) to[j] += from[j] / cell_volume[c];
      from += stride;
    }
    first += n;
  }
}

}  // namespace

std::vector<double> Kernel::average(std::span<const CellField> fields) const {
  std::vector<double> values(static_cast<std::size_t>(n_particles_) * total_components(fields), 0.0);
  add_averages(around_, weights_->rows(), fields, scratch_, values);
  if (some_in_nearest_cell_) add_averages(to_nearest_, nearest_, fields, scratch_, values);
  return values;
}

std::vector<Vec3> Kernel::average(std::span<const Vec3> field) const {
  const CellField one{flat(field).data(), 3};
  const std::vector<double> values = average(std::span(&one, 1));
  std::vector<Vec3> vectors(n_particles_);
  for (int b = 0; b < n_particles_; ++b) vectors[b] = {values[3 * b], values[3 * b + 1], values[3 * b + 2]};
  return vectors;
}

void Kernel::spread(std::span<const double> amounts, std::span<const CellSums> fields) const {
  add_amounts(around_, weights_->rows(), amounts, fields, mesh_.cell_volume, scratch_);
  if (some_in_nearest_cell_) add_amounts(to_nearest_, nearest_, amounts, fields, mesh_.cell_volume, scratch_);
}

void Kernel::spread(std::span<const double> amounts, int components, std::span<double> field) const {
  const CellSums one{field.data(), components};
  spread(amounts, std::span(&one, 1));
}

std::vector<int> Kernel::cells() const {
  std::vector<int> all = weights_->rows().cells();
  if (!some_in_nearest_cell_) return all;
  all.insert(all.end(), nearest_.cells().begin(), nearest_.cells().end());
  sort_out(all);
  return all;
}

std::array<double, 2> Kernel::width_over_cell_size() const {
  double least = infinity, largest = 0;
  for (const int cell : announced_holder_) {
    if (cell < 0) continue;
    const double ratio = width_ / std::cbrt(mesh_.cell_volume[cell]);
    least = std::min(least, ratio), largest = std::max(largest, ratio);
  }
  least = minimum(mesh_.comm, least), largest = maximum(mesh_.comm, largest);
  return {largest > 0 ? least : 0, largest};
}

}  // namespace snag
