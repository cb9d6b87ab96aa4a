#pragma once
// Outliers: samples of paths that no noise makes (a tracker that lost its piece, a digit that was misread), found before any model is run.
//
//   z = (y - p)/(s sqrt(1 + |w|^2)),   p = sum_j w_j y_j   from other samples,   s = 1.4826 median |z s|, at least noise_u
//   evidence: product of (1 - e) N(z; 1) + e N(z; k^2)  over  N(z; 1),   shares e and widths k from a grid of equal prior
//
// p comes from the two samples before and the two after in the same series (the cubic through them), or from the median of the other
// repeats at the same time where there are two of them: whichever has the smaller s at this point. A sample is an outlier where |z| > 5 and
// the samples before it predict those behind it. A kink of the path is therefore no outlier, nor is a deviation that most of the other
// repeats have. Up to three outliers in a row are found. They are left out where the mixture leads by 6 nats over all samples of an
// observable; otherwise no sample is left out. Scalars of a replicate are not examined: their scatter is evidence of its own.
// Nor are means of several repeats: a false number among the repeats shows in their standard deviation.
//
// s of a short path: an outlier is far from its prediction, and so are the four samples that it predicts. In a path of 20 samples three
// outliers thus spoil most of the predictions. So s is found without the samples that spoil it. It is not taken below what is usual, the
// median of s at the other points, because noise that is merely larger than stated spoils nothing. With a single point s is that of all.
#include <vector>

#include "diagnosis/data/experiment.hpp"

namespace snag {

struct OutliersFound {
  double share = 0;                    // of the samples of the observable
  double nats = 0;                     // by which the data speak for outliers; 0: there are none
  std::vector<std::size_t> samples{};  // indices into Experiment::data, rising
};

/// By observable; withheld points are judged by themselves, so that they change nothing of the others.
std::vector<OutliersFound> find_outliers(const Experiment& experiment);

/// The experiment but for these samples.
Experiment without(const Experiment& experiment, const std::vector<OutliersFound>& outliers);

}  // namespace snag
