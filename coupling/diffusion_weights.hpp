#pragma once
// Weights by diffusion through the faces of the mesh, from the cell h that holds the particle:
//
//   w = V c_m,   (V + a K) c_n = V c_(n-1),   V c_0 = e_h,   a = delta^2/(2 m),   K c = sum_f k_f (c_P - c_N)
//
// m implicit steps with no flux through walls: what leaves a cell enters its neighbours, so that the weights sum to 1, and nothing passes
// through a wall, however thin. K is symmetric: particles that fill the mesh evenly give evenly to all cells, and no factors of cells at
// walls are needed. The patch of cells that are joined to h within the cut counts; there is no flux through its end either.
//
// Particles in one cell share a row. Rows are kept until the mesh between their cells changes: in a turning mesh those that reach the
// sliding interface are made anew in every step. Each rank makes the rows that its cells occur in by itself, on a graph that has all cells
// within twice the reach of its own, in the order of cell_id: the weights are the same on any number of ranks. Periodic faces count where
// both cells are nearer than the cut as they stand.
#include <Eigen/Core>
#include <unordered_map>

#include "coupling/cell_graph.hpp"
#include "coupling/cell_weights.hpp"
#include "mesh/mesh.hpp"

namespace snag {

class DiffusionWeights final : public CellWeights {
 public:
  /// `area`: a, m2; `cut`: distance from the centre of h beyond which no cell counts, m. Collective.
  DiffusionWeights(const Mesh& mesh, double area, int n_steps, double cut);

  double reach() const override { return reach_; }
  void mesh_moved(const RankBoxes& boxes) override;
  void locate(const Announcement& announced) override;

 private:
  struct Row {
    std::vector<int> cell;  // owned
    std::vector<double> weight;
    bool at_interface = false;
    std::int64_t last_use = 0;
  };
  struct Patch;
  void make_missing_rows(std::span<const double> holder_ids);
  Row made_row(std::int64_t holder_id);
  void find_patch(int holder, Patch& patch);
  Eigen::VectorXd diffused(const Patch& patch) const;

  const Mesh& mesh_;
  double area_;
  int n_steps_;
  double cut_, reach_;
  RankBoxes boxes_;
  CellGraph graph_;
  bool graph_is_old_ = true;
  std::vector<int> place_in_patch_;  // of each cell of the graph, -1
  std::unordered_map<std::int64_t, Row> kept_;
  std::int64_t n_uses_ = 0;
};

}  // namespace snag
