#include <algorithm>
#include <cmath>

#include "diagnosis/fitting/fit.hpp"

namespace snag {

namespace {

/// Over what shares of the duration an error of form keeps its sign, and how much of its variance each has.
struct FormLength {
  double length, share;
};
constexpr std::array form_lengths{FormLength{1.0 / 3, 0.8}, FormLength{1.0 / 15, 0.2}};

// Matern correlation of order 3/2.
double matern(double distance) {
  const double r = std::sqrt(3.0) * distance;
  return (1 + r) * std::exp(-r);
}

// Size of an effect's contribution up to each row: an error of form does not vanish where the contribution crosses zero.
Eigen::VectorXd envelope(const PointSummary& point, const Eigen::VectorXd& part) {
  Eigen::VectorXd size(point.n_gaussian);
  double sum = 0;
  int n = 0;
  for (int i = 0; i < point.n_gaussian; ++i) {
    if (i == 0 || point.rows[i].observable != point.rows[i - 1].observable) sum = 0, n = 0;
    sum += part[i] * part[i], ++n;
    size[i] = std::sqrt(std::max(part[i] * part[i], sum / n));
  }
  return size;
}

double time_of(const Row& row) { return 0.5 * (row.begin + row.end); }

// Of errors of form between the rows of one observable.
Eigen::MatrixXd form_correlation(const PointSummary& point) {
  const double duration = std::max(point.duration, 1e-300);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(point.n_gaussian, point.n_gaussian);
  for (int i = 0; i < point.n_gaussian; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (point.rows[i].observable != point.rows[j].observable) continue;
      const double apart = i == j ? 0 : std::abs(time_of(point.rows[i]) - time_of(point.rows[j])) / duration;
      for (const FormLength& form : form_lengths) R(i, j) += form.share * matern(apart / form.length);
      R(j, i) = R(i, j);
    }
  }
  return R;
}

void add_form_error(const PointSummary& point, const std::vector<const Eigen::VectorXd*>& parts, double form_error, Eigen::MatrixXd& C) {
  if (form_error == 0 || parts.empty()) return;
  const Eigen::MatrixXd R = form_correlation(point);
  for (const Eigen::VectorXd* part : parts) {
    const Eigen::VectorXd size = form_error * envelope(point, *part);
    C += R.cwiseProduct(size * size.transpose());
  }
}

// Scatter of the runs over their number, and over the number of replicates where these are too few to show it themselves. Few seeds give
// the size of the scatter (Response::scatter) but not its shape: it is taken as sd_i sd_j exp(-|t_i - t_j|/tau), tau from neighbouring
// rows.
void add_scatter(const PointSummary& point, const Response& response, Eigen::MatrixXd& C) {
  const double n = static_cast<double>(response.paths.cols());
  const Eigen::MatrixXd S = response.paths * response.paths.transpose() / (n - 1);
  constexpr int few_replicates = 3;
  const auto of_few = [](const Row& row) { return row.n_replicates < few_replicates ? 1.0 / row.n_replicates : 0; };
  for (int begin = 0, end = 0; begin < point.n_gaussian; begin = end) {
    double next = 0, own = 0, step = 0;
    for (end = begin; end < point.n_gaussian && point.rows[end].observable == point.rows[begin].observable; ++end) {
      if (end == begin) continue;
      next += S(end, end - 1), own += 0.5 * (S(end, end) + S(end - 1, end - 1));
      step += (time_of(point.rows[end]) - time_of(point.rows[end - 1])) / std::max(1, point.n_gaussian - 1);
    }
    const double correlation = own > 0 ? std::clamp(next / own, 0.03, 0.999) : 0.03;
    const double tau = -(step > 0 ? step * (point.n_gaussian - 1) / std::max(1, end - begin - 1) : 1) / std::log(correlation);
    for (int i = begin; i < end; ++i) {
      for (int j = begin; j < end; ++j) {
        const double share = 1 / n + std::sqrt(of_few(point.rows[i]) * of_few(point.rows[j]));
        const double apart = i == j ? 0 : std::abs(time_of(point.rows[i]) - time_of(point.rows[j])) / tau;
        C(i, j) += share * std::sqrt(response.scatter[i] * response.scatter[j]) * std::exp(-apart);
      }
    }
  }
}

}  // namespace

Eigen::MatrixXd model_covariance(const PointSummary& point, const Response& response, const Eigen::VectorXd& numerical_error,
                                 const std::vector<const Eigen::VectorXd*>& parts, double form_error) {
  const int g = point.n_gaussian;
  Eigen::MatrixXd C = response.data_covariance.size() > 0 ? response.data_covariance : point.covariance;
  // The error of the step has one sign over a run, and is not known better than by a tenth.
  const Eigen::VectorXd e = numerical_error.head(g);
  C += e * e.transpose();
  C.diagonal() += (0.1 * e).cwiseAbs2();
  if (response.beyond.size() > 0) C.diagonal() += response.beyond.head(g).cwiseAbs2();
  if (response.paths.cols() > 1) add_scatter(point, response, C);
  add_form_error(point, parts, form_error, C);
  // Row by row: rows have units of their own.
  C.diagonal() = (1 + 1e-9) * C.diagonal().array() + 1e-300;
  return C;
}

}  // namespace snag
