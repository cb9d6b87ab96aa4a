#pragma once
// What makes a model a candidate of the diagnosis: one number theta, its key in the case file, and what is known of it beforehand.
#include <string>
#include <vector>

namespace snag {

/// What a case must have so that an effect can be seen in it.
enum class Need {
  wall,
  gradient,    // of the velocity
  turbulence,  // k and epsilon
  sheet,       // bonds in two directions
  fibre,       // bonds in one direction
  bonds,
  solid_fraction,  // of a computed flow
  gravity,
  contact,
  several,    // particles
  hertz,      // contacts by the law of Hertz
  pipe,       // [pipe_flow], of water that is not computed
  bend,       // of that pipe
  crumple,    // a piece that starts crumpled by a pipe
  averaging,  // over a width that the case gives
};

/// theta = 0 is the base model to the bit. A force is switched on by its name in [coupling] forces with theta at `key`.
struct Prior {
  std::string key;                    // of theta in the case file: "coupling.added_mass.coefficient"; tables that repeat without number
  std::string meaning;                // of theta, in words
  std::string unit = "1";             // of theta
  double mean = 0, sd = 1;            // of theta, given that the effect is there
  double minimum = 0, maximum = 1e9;  // physical range of theta
  bool random = false;                // runs with another seed (key `seed` of the same table) give another result
  bool acts_on_water = false;         // cannot be expressed where the water is prescribed or replayed
  bool exclusive_forms = false;       // its law is exactly one of its forms (key `form`); else it may lie between them
  bool is_share = false;              // of one law in the place of another: there is nothing beyond 1
  std::vector<Need> needs = {};
};

/// A named effect that is not a force.
struct Candidate {
  std::string name;
  Prior prior;
  bool is_relative = false;               // the value of the case times 1 + theta; else theta is added to it
  std::string of_force = {};              // whose number it is; empty: of no force
  std::vector<std::string> with{};        // other values of the case that it takes, "section.key=value"
  std::vector<std::string> other_keys{};  // of theta, where the effect is written in other forms; that of the prior is the first form
};

}  // namespace snag
