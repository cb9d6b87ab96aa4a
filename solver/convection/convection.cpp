#include "solver/convection/convection.hpp"

namespace snag {

Registry<ConvectionScheme>& convection_schemes() {
  static Registry<ConvectionScheme> schemes("convection scheme");
  return schemes;
}

std::string convection_meaning() {
  std::string meaning = "Convection scheme of the momentum equation: value u_f at a face, C the cell upwind of it, D the cell downwind.";
  for (const std::string& name : convection_schemes().names()) {
    const ConvectionDescription description = convection_schemes().make(name, "manual")->description();
    meaning +=
        " " + name + ": " + description.equation + ", of order " + std::to_string(description.order) + " (" + description.source + ").";
  }
  return meaning;
}

}  // namespace snag
