#pragma once
// One piece in a prescribed flow, for tests against exact motions.
#include <string>

#include "coupling/coupled_solver.hpp"

namespace snag {

inline RagPiece sphere_piece(double diameter, double density, Vec3 position = {}, Vec3 velocity = {}) {
  RagSettings settings(RagSettings::Shape::particle);
  settings.diameter = diameter, settings.density = density, settings.position = position, settings.velocity = velocity;
  return make_piece(settings, "test");
}

struct PieceInFlow {
  RagSystem rags;
  CoupledSolver solver;
  PieceInFlow(RagPiece piece, const std::string& case_text, const PrescribedFlow& flow)
      : rags(MPI_COMM_SELF, {}, {std::move(piece)}), solver(read_coupling(CaseFile::parse(case_text).root(), false), rags, flow) {}
  void advance(double time, int steps) {
    for (int n = 0; n < steps; ++n) solver.step(time / steps);
  }
  Vec3 velocity() const { return rags.tiles()[0].vector(Tile::vx, rags.tiles()[0].index(0, 0)); }
  Vec3 position() const { return rags.tiles()[0].vector(Tile::x, rags.tiles()[0].index(0, 0)); }
};

}  // namespace snag
