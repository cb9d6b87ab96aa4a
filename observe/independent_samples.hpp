#pragma once
// How many independent samples the samples of a group are worth: passes of one rag resemble each other, and so do neighbours in time.
//
//   rags known       n_eff = n/(1 + (m' - 1) rho),   m' = sum m_r^2/n,   rho = (B - W)/(B + (m_0 - 1) W)
//                    m_r samples of rag r; B and W mean squares between the rags of a group and within the rags, over all groups;
//                    m_0 = [sum_g (n_g - sum_r m_r^2/n_g)]/[sum_g (k_g - 1)],  k_g rags of group g
//                    rho, the intraclass correlation: analysis-of-variance estimate, A. Donner and J. J. Koval, Biometrics 36 (1980) 19;
//                    n_eff, samples over the design effect: L. Kish, Survey Sampling, Wiley, 1965
//   a row in time    n_eff = n (1 - r)/(1 + r),   r = sum d_i d_{i+1}/sum d_i^2 over all groups,   d = value - mean of its group
//                    first-order autoregression, long rows: G. V. Bayley and J. M. Hammersley, J. R. Stat. Soc. Suppl. 8 (1946) 184
//
// Squares and products of values with two components are those of vectors. rho or r below zero counts as zero: samples are not taken for
// more than they are. n_eff is at least 1.
#include <array>
#include <span>
#include <vector>

namespace snag {

struct RagSample {
  int group = 0;
  int rag = -1;                   // of its group; -1: not known
  std::array<double, 2> value{};  // a number and 0; of an axis the cosine and sine of twice its angle, so that nothing wraps
};

enum class Dependence {
  none,            // every rag was seen once
  intraclass,      // several samples of each of several rags
  autocorrelation  // rags not known, or one in each group
};

struct IndependentSamples {
  Dependence dependence = Dependence::none;
  double correlation = 0;      // rho or r as estimated, may be negative
  std::vector<double> counts;  // n_eff [n_groups]
};

/// Samples in the order in which they were taken, at least two in each group and some scatter within the groups.
IndependentSamples independent_samples(std::span<const RagSample> samples, int n_groups);

}  // namespace snag
