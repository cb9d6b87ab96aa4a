#include "solver/convection/limiter.hpp"

namespace snag {

Registry<Limiter>& limiters() {
  static Registry<Limiter> all("limiter");
  return all;
}

std::string limiter_meaning() {
  std::string meaning =
      "Limiter of the gradients that linear_upwind extrapolates with: the least psi of all faces of a cell, y the largest change to a "
      "neighbour over the change to the face. In tetrahedra, limiters of components also count the changes to the neighbours of these and "
      "to velocities given at boundaries.";
  for (const std::string& name : limiters().names()) {
    const LimiterDescription description = limiters().make(name, "manual")->description();
    meaning += " " + name + ": " + description.equation + (description.source.empty() ? "" : " (" + description.source + ")") + ".";
  }
  return meaning;
}

}  // namespace snag
