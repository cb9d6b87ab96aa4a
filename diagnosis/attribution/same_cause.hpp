#pragma once
// One cause of two names: in water of one density entrained water acts as added mass does. Two effects are one where what they add to the
// runs, as each is fitted, is the same for these data. With p_a, p_b what they add, whitened, and P what takes out the inputs
// (remainder.hpp),
//
//   cos = p_a.P p_b / sqrt(p_a.P p_a  p_b.P p_b) > 0.999   and   sqrt(p_a.P p_a (1 - cos^2)) < 1
//
// The first says that they are alike, not only too small to be distinguished; the second that the data distinguish them by half a nat at
// most. In addition, the evidence of the other effect is at most 6 nats lower. With a single number, the first two conditions hold for
// every effect, even for one that needs an unlikely strength.
#include "diagnosis/attribution/attribution.hpp"

namespace snag {

/// Effects that are the same cause as effect `effect` of this fit: by the fits of the same set with another one in its place, or, where
/// that set is not fitted, by those of both alone.
std::vector<int> same_causes(const Responses& model, const Attribution& attribution, int fit, int effect);

}  // namespace snag
