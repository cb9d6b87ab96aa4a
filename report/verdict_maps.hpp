#pragma once
// Where the gap is, drawn as SVG: by points, observables and parts of time, and along the measured paths.
#include <string>

#include "diagnosis/data/verdict.hpp"

namespace snag {

/// A square for every cell, coloured by `score`: points beside each other, observables and the parts of their time below each other.
std::string map_of_gap(const Verdict& verdict, double GapCell::*score);
/// Measured paths in the plane of the two coordinates that change most, each place coloured by |score|, with the missing forces as arrows;
/// empty where fewer than two coordinates were measured.
std::string map_of_ways(const Verdict& verdict);

}  // namespace snag
