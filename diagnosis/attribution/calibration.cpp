#include "diagnosis/attribution/calibration.hpp"

namespace snag {

// The temperature that gives the truth of 72 sealed sphere sets of level L2 (seeds 11 and 12) the largest mean log probability: the sets in
// which something can be told, none, outside or an effect of d >= 3. Effects that cannot be seen tell how often effects are weak, which is
// no matter of over-confidence, and were left out. The mean was -0.70 at 1, -0.67 from 1.2 to 1.5, -0.70 at 2: the minimum is flat. On 104
// such sets of seeds 101 and 102, with the prior left as it is and second effects as likely as first ones, it is flatter still, and the
// number was kept: -0.34 at 1 and 1.2, -0.35 at 1.4, -0.37 at 2.
Calibration calibration() { return {1.4, "72 sphere sets of level L2 that can be distinguished, seeds 11 and 12, log score"}; }

}  // namespace snag
