#pragma once
// The water of the flow solver at the particles: kernel averages, frozen over the sub-steps of one fluid step.
//
//   solid fraction: volumes of the particles spread by the kernel and averaged back; grad k by Gauss over the faces of the cells
//   Du/Dt = (u^n - u^(n-1))/dt + G (u - u_c) + [Omega x u],   u_c = Omega x (x - origin) in a turning zone, 0 elsewhere
//
// from the last step's length dt, in a cell that moves with u_c. Omega x u belongs to a zone that stands in the turning frame (motion =
// "frame"), where the difference is that of components in this frame. Before the first step the flow counts as steady, in a turning zone
// as seen from it: Omega x u there for either motion.
#include "coupling/fluid_field.hpp"
#include "coupling/kernel.hpp"
#include "coupling/particle_list.hpp"
#include "coupling/water_response.hpp"
#include "solver/fields/flow.hpp"

namespace snag {

class KernelField final : public FluidField {
 public:
  /// `rags`: those that Tile::rag counts; `response` of the flow to them, null one-way.
  KernelField(const Flow& flow, Kernel& kernel, const std::vector<Rag>& rags, const WaterResponse* response)
      : flow_(flow), kernel_(kernel), rags_(rags), response_(response) {}
  /// Length of the step that led to the present state, s; 0: none yet.
  void set_last_step(double dt) { last_step_ = dt; }
  double last_step() const { return last_step_; }
  void sample(std::span<const Tile> tiles, const SampleSet& needed) override;
  FluidSamples at(std::size_t index, const Tile& tile, double elapsed) override;
  /// The particles of the last sample(), in the order of the kernel.
  const ParticleList& particles() const { return particles_; }
  /// Of the water to particle b of the list, 1/kg. Two-way.
  double response(std::size_t b) const { return arrays_.field(particles_.tile(b), sampled::response)[particles_.place(b)]; }

 private:
  void set_acceleration();
  void set_turbulence_gradient();
  void set_width();
  void set_solid_fraction(std::span<const Tile> tiles);
  void set_coverage(std::span<const Tile> tiles);
  void set_response();

  const Flow& flow_;
  Kernel& kernel_;
  const std::vector<Rag>& rags_;
  const WaterResponse* response_;
  double last_step_ = 0;
  ParticleList particles_;
  std::vector<Vec3> acceleration_;  // Du/Dt of the owned cells, m/s2
  std::vector<Vec3> k_gradient_;    // of the owned cells, m/s2
  std::vector<double> width_;       // of kernel and cell, of the owned cells, m
  std::vector<double> solid_;       // of the owned cells
  std::vector<double> covered_;     // area of cloth per volume over that within a flat sheet, of the owned cells
  TileArrays arrays_;
};

}  // namespace snag
