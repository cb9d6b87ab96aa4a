#pragma once
// The water of the flow solver at the particles: kernel averages, frozen over the sub-steps of one fluid step but for what the prediction
// says (coupling/water_prediction.hpp). What is averaged beside velocity and gradient is in the table of samples.cpp.
//
// A kernel that is narrower than the cells reads single cells, whose centres x_c may lie half a cell from the particle at x_b. One-way, the
// velocity is that at the particle:
//
//   u_b = sum_c w_bc u_c + (1 - s_b) G_b (x_b - sum_c w_bc x_c),      s_b, G_b: averages of s_c (coupling/water_prediction.hpp) and G
//
// exact for linear velocities where s_b = 0, and Du/Dt has G_b times the same change: what it has from u.grad u. A particle that no cell
// holds has the velocity of its cells. Two-way the average must be the transpose of the spreading.
#include "coupling/cloth_edges.hpp"
#include "coupling/fluid_field.hpp"
#include "coupling/kernel.hpp"
#include "coupling/particle_list.hpp"
#include "coupling/water_prediction.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

class KernelField final : public FluidField {
 public:
  /// `rags`: those that Tile::rag counts; `prediction` of the flow, which answers to them if two_way.
  KernelField(const Flow& flow, Kernel& kernel, const std::vector<Rag>& rags, WaterPrediction& prediction, bool two_way)
      : flow_(flow), kernel_(kernel), rags_(rags), edges_(rags), prediction_(prediction), two_way_(two_way) {}
  void sample(std::span<const Tile> tiles, const SampleSet& needed) override;
  FluidSamples at(std::size_t index, const Tile& tile, double elapsed, double step) override;
  bool answers() const override { return two_way_; }
  /// After a step of the flow: by how much the prediction missed its answers (WaterPrediction::missed_rates), in the order of particles().
  /// `given`: I of the particles in that step, N s. Two-way; collective.
  std::vector<Vec3> missed_rates(std::span<const Vec3> given) const;
  /// The particles of the last sample(), in the order of the kernel.
  const ParticleList& particles() const { return particles_; }
  /// Their places then, m.
  const std::vector<Vec3>& places() const { return places_; }
  /// Mean place of the weights of particle b, m.
  Vec3 mean_place(std::size_t b) const;
  /// Of the water to particle b of the list, 1/kg. Two-way.
  double response(std::size_t b) const { return arrays_.field(particles_.tile(b), sampled::response)[particles_.place(b)]; }

 private:
  void move_to_place(std::size_t b, double share, int acceleration);
  const Flow& flow_;
  Kernel& kernel_;
  const std::vector<Rag>& rags_;
  ClothEdges edges_;
  WaterPrediction& prediction_;
  bool two_way_;
  ParticleList particles_;
  std::vector<Vec3> places_;
  std::vector<std::vector<double>> made_;  // what the cells have for each row of samples, where it is computed
  TileArrays arrays_;
};

}  // namespace snag
