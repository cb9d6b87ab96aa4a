#pragma once
// The largest time step whose error is below a limit, from trials of one flow at h, h/2, h/4 ... from the same state. Arithmetic only.
//
//   f_i(k)   mean of a quantity, such as the head, over revolution k = 1 .. K of trial i; h_i = h_0/2^i, n: the finest trial so far
//   f_i      = f_i(K): the first revolutions hold the change of the step
//   p        observed order of the last three trials, log2 of (f_(n-1) - f_(n-2))/(f_n - f_(n-1)), within 1/2 and 2; 1 where there are
//            only two, or where the two differences have different signs or do not shrink
//   r        = 1.25 |f_n - f_(n-1)|/(2^p - 1), the error of the finest trial (Richardson 1911) with the factor of safety of Roache (1994)
//   u_i      = |(f_i - f_n)(K) - (f_i - f_n)(K-1)|: the difference still changes, since the flow has not settled, or by noise; 0 if K = 1
//   e_i      = (|f_i - f_n| + r + u_i)/|f_n|, with u_n = u_(n-1): the error of trial i
//
// A drift that all trials have cancels in f_i - f_n, since they cover the same time. A step is accurate if its error and those of all
// finer ones are below the limit: two trials that agree by accident do not count where a third one disagrees.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace snag {

/// One trial: means over each revolution, [revolution][quantity]; or one row of what a trial gives as a whole.
struct StepTrial {
  int steps_per_revolution = 0;
  std::vector<std::vector<double>> means;
};

struct StepChoice {
  std::optional<std::size_t> chosen;       // the trial with the largest accurate step; none: no step is accurate
  std::vector<std::vector<double>> error;  // e, [trial][quantity], relative; infinity where f_n is zero
  bool converges = true;                   // of three trials the differences shrink, with one sign, in every quantity
  bool has_settled = true;                 // no difference changed by more than the limit in the last revolution
};

/// `trials`: each with half the step of the one before; two or more, equally many rows in each. `accuracy`: relative.
StepChoice choose_step(const std::vector<StepTrial>& trials, double accuracy);

}  // namespace snag
