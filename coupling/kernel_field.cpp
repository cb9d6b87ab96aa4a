#include "coupling/kernel_field.hpp"

#include "base/flat.hpp"
#include "coupling/samples.hpp"

namespace snag {

using namespace sampled;

void KernelField::sample(std::span<const Tile> tiles, const SampleSet& needed) {
  particles_ = ParticleList(tiles);
  places_.resize(particles_.size());
  for (std::size_t b = 0; b < places_.size(); ++b) places_[b] = tiles[particles_.tile(b)].vector(Tile::x, particles_.place(b));
  kernel_.locate(places_);
  const std::vector<int> cells = kernel_.cells();
  prediction_.predict(cells);

  std::vector<CellField> fields;
  std::vector<int> field_of_component;
  const auto add = [&](const void* values, int components, int first) {
    fields.push_back({static_cast<const double*>(values), components});
    for (int j = 0; j < components; ++j) field_of_component.push_back(first + j);
  };
  add(prediction_.velocity().data(), 3, velocity);
  add(flow_.velocity_gradient.data(), 9, gradient);
  add(prediction_.change().data(), 3, change);
  add(flow_.mesh.cell_centre.data(), 3, sampled::mean_place);
  const CellSource source{flow_, kernel_, cells, rags_, prediction_, two_way_, particles_, tiles};
  made_.resize(sample_rows().size());
  ClothEdges::Fields of_edges{.edge_distance = edge_distance};
  int acceleration = -1;
  auto made = made_.begin();
  for_each_row([&](const SampleRow& row, int first) {
    std::vector<double>& of_cells = *made++;
    if (needed.*row.needed) add(row.of_cells(source, of_cells), row.components(), first);
    if (row.needed == &SampleSet::coverage) of_edges.coverage = first;
    if (row.needed == &SampleSet::disturbance) of_edges.width = first;
    if (row.needed == &SampleSet::material_acceleration && needed.material_acceleration) acceleration = first;
  });
  if (!two_way_) fields.push_back({prediction_.resolved().data(), 1});  // behind the others: no sample
  const std::vector<double> values = kernel_.average(fields);

  arrays_.reset(tiles, n_arrays());
  const std::size_t n_samples = field_of_component.size(), components = n_samples + (two_way_ ? 0 : 1);
  for (std::size_t b = 0; b < particles_.size(); ++b)
    for (std::size_t j = 0; j < n_samples; ++j)
      arrays_.field(particles_.tile(b), field_of_component[j])[particles_.place(b)] = values[b * components + j];
  const double over_dt = 1 / prediction_.dt();
  const std::vector<double> answers = two_way_ ? prediction_.response(kernel_) : std::vector<double>();
  for (std::size_t b = 0; b < particles_.size(); ++b) {
    const int t = particles_.tile(b), k = particles_.place(b);
    for (int i = 0; i < 3; ++i) {
      arrays_.field(t, change + i)[k] *= over_dt;
      arrays_.field(t, start + i)[k] = places_[b][i];
    }
    if (two_way_)
      arrays_.field(t, sampled::response)[k] = answers[b];
    else if (kernel_.is_inside(b))
      move_to_place(b, 1 - values[(b + 1) * components - 1], acceleration);
  }
  if (needed.coverage) edges_.find_distances(flow_.mesh.comm, tiles, arrays_, of_edges);
}

/// `share` 1 - s_b; `acceleration`: first of its arrays, -1 where it was not sampled.
void KernelField::move_to_place(std::size_t b, double share, int acceleration) {
  const int t = particles_.tile(b), k = particles_.place(b);
  const auto vector = [&](int f) { return Vec3{arrays_.field(t, f)[k], arrays_.field(t, f + 1)[k], arrays_.field(t, f + 2)[k]}; };
  const Mat3 G{vector(gradient), vector(gradient + 3), vector(gradient + 6)};
  const Vec3 more = G * (share * (places_[b] - mean_place(b)));
  for (int i = 0; i < 3; ++i) arrays_.field(t, velocity + i)[k] += more[i];
  if (acceleration < 0) return;
  const Vec3 carried = G * more;
  for (int i = 0; i < 3; ++i) arrays_.field(t, acceleration + i)[k] += carried[i];
}

std::vector<Vec3> KernelField::missed_rates(std::span<const Vec3> given) const {
  std::vector<double> response(particles_.size());
  for (std::size_t b = 0; b < response.size(); ++b) response[b] = this->response(b);
  return prediction_.missed_rates(kernel_, response, given);
}

Vec3 KernelField::mean_place(std::size_t b) const {
  const int t = particles_.tile(b), k = particles_.place(b);
  return {arrays_.field(t, sampled::mean_place)[k], arrays_.field(t, sampled::mean_place + 1)[k],
          arrays_.field(t, sampled::mean_place + 2)[k]};
}

FluidSamples KernelField::at(std::size_t index, const Tile&, double, double) {
  const auto vector = [&](int f) { return VectorArray{arrays_.field(index, f), arrays_.field(index, f + 1), arrays_.field(index, f + 2)}; };
  FluidSamples fluid{.density = flow_.density,
                     .dynamic_viscosity = flow_.dynamic_viscosity,
                     .velocity = vector(velocity),
                     .velocity_rate = vector(change),
                     .start = vector(start),
                     .response = two_way_ ? arrays_.field(index, sampled::response) : nullptr,
                     .response_left = two_way_ ? prediction_.response_left() : 0,
                     .velocity_gradient = {vector(gradient), vector(gradient + 3), vector(gradient + 6)},
                     .edge_distance = arrays_.field(index, edge_distance)};
  for_each_row([&](const SampleRow& row, int first) {
    const double* const arrays[] = {arrays_.field(index, first), row.components() > 1 ? arrays_.field(index, first + 1) : nullptr,
                                    row.components() > 1 ? arrays_.field(index, first + 2) : nullptr};
    row.point(fluid, arrays);
  });
  return fluid;
}

}  // namespace snag
