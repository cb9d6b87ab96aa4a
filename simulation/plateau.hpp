#pragma once
// The plateau of a study: the values of a numerical choice (a kernel width, a step, a size of cells) over which the results do not depend
// on it, nor on the other numerical choices that the study varies.
//
//   x_1 < x_2 < ... < x_n   values of the choice;   q_r(g, x)   result r of the run of group g: one combination of all else that varies
//   A window x_i ... x_j is a plateau of tolerance tol if for each result r and each condition (a value of what is physical)
//       max |q_r(g, x)/m_r - 1| <= tol,     m_r = mean of q_r over the window and the groups of the condition
//
// Of several the widest, by x_j/x_i, and of equally wide ones the one with the smallest deviation. A run without a value breaks a window.
// With fewer values than asked for there is none: two runs that agree are no plateau.
#include <optional>
#include <string>
#include <vector>

namespace snag {

/// A run as the plateau sees it.
struct PlateauRun {
  double x = 0;
  std::string group;                           // of all else that varies: "kernel gaussian, radius_mm 2"
  std::string condition;                       // of what is physical of it: other results are expected there
  std::vector<std::optional<double>> results;  // absent: the run has no such value, or failed
};

struct PlateauWindow {
  double from = 0, to = 0;       // of x
  double middle = 0;             // the value next to the geometric middle
  double deviation = 0;          // largest |q/m - 1| in it
  std::size_t worst = 0;         // the result that has it
  std::string worst_group = {};  // and the group
  std::size_t n = 0;             // values of x in it
  bool within_tolerance = false;
};

struct Plateau {
  /// Over all groups: the plateau, or, not within the tolerance, the window of the fewest values that comes nearest to one. Absent: too few
  /// values of x, or no window in which all runs have all results.
  std::optional<PlateauWindow> window;
  /// Of each group by itself, in the order of the runs.
  std::vector<std::pair<std::string, std::optional<PlateauWindow>>> by_group;
};

/// `n_least`: values of x that a plateau must have.
Plateau find_plateau(const std::vector<PlateauRun>& runs, double tolerance, std::size_t n_least);

}  // namespace snag
