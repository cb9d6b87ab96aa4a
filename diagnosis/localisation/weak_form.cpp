#include "diagnosis/localisation/weak_form.hpp"

#include <algorithm>
#include <cmath>

#include "observe/observables.hpp"

namespace snag {

namespace {

// Second derivative of (1 - s^2)^4 by s.
double second_derivative(double s) {
  const double r = 1 - s * s;
  return r > 0 ? 8 * r * r * (7 * s * s - 1) : 0;
}

}  // namespace

Eigen::MatrixXd test_functions(const std::vector<double>& times) {
  constexpr std::ptrdiff_t fewest = 7;
  const std::ptrdiff_t n = std::ssize(times), half = std::max<std::ptrdiff_t>(3, n / 6), apart = std::max<std::ptrdiff_t>(1, half / 2);
  std::vector<Eigen::VectorXd> rows;
  for (std::ptrdiff_t centre = half; n >= fewest && centre + half < n; centre += apart) {
    const std::ptrdiff_t begin = centre - half, count = 2 * half + 1;
    const double c = times[centre], h = 0.5 * (times[centre + half] - times[begin]) * (1 + 1.0 / static_cast<double>(half));
    Eigen::VectorXd w(count), square(count);
    Eigen::MatrixXd lines(count, 2);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const double t = (times[begin + i] - c) / h;
      w[i] = second_derivative(t), square[i] = 0.5 * t * t, lines.row(i) << 1, t;
    }
    // Sums over samples are no integrals: what is left of lines is taken out, what is made of a parabola scaled.
    w -= lines * lines.colPivHouseholderQr().solve(w);
    w /= w.dot(square) * h * h;
    rows.emplace_back(Eigen::VectorXd::Zero(n));
    rows.back().segment(begin, count) = w;
  }
  Eigen::MatrixXd all(rows.size(), n);
  for (std::size_t j = 0; j < rows.size(); ++j) all.row(static_cast<Eigen::Index>(j)) = rows[j].transpose();
  return all;
}

WeakForm::WeakForm(const Responses& model, const Whitening& whitening) {
  Eigen::Index first = 0;
  for (std::size_t p = 0; p < model.training().size(); ++p) {
    const PointSummary& point = model.points()[model.training()[p]];
    std::vector<Eigen::MatrixXd> parts;
    Eigen::Index n_weak = 0;
    for (int begin = 0, end = 0; begin < point.n_gaussian; begin = end) {
      const Row& row = point.rows[begin];
      std::vector<double> times;
      for (end = begin; end < point.n_gaussian && point.rows[end].observable == row.observable; ++end)
        times.push_back(0.5 * (point.rows[end].begin + point.rows[end].end));
      const ObservableRecord* record = find_observable(model.experiment().observables[row.observable].id);
      if (row.kind != Row::Kind::path || !record || !record->is_position()) continue;
      const Eigen::MatrixXd functions = test_functions(times);
      parts.emplace_back(Eigen::MatrixXd::Zero(functions.rows(), point.n_gaussian));
      parts.back().middleCols(begin, end - begin) = functions;
      n_weak += functions.rows();
    }
    if (n_weak > 0) {
      Eigen::MatrixXd all(n_weak, point.n_gaussian);
      Eigen::Index at = 0;
      for (const Eigen::MatrixXd& part : parts) all.middleRows(at, part.rows()) = part, at += part.rows();
      const Eigen::MatrixXd of_whitened = all * Eigen::MatrixXd(whitening.factor[p].matrixL());
      Eigen::MatrixXd C = of_whitened * of_whitened.transpose();
      C.diagonal() *= 1 + 1e-9;
      blocks_.push_back({first, C.llt().matrixL().solve(of_whitened)});
      size_ += n_weak;
    }
    first += static_cast<Eigen::Index>(point.rows.size());
  }
}

Eigen::VectorXd WeakForm::operator()(const Eigen::VectorXd& whitened) const {
  Eigen::VectorXd all(size_);
  Eigen::Index at = 0;
  for (const Block& block : blocks_) {
    all.segment(at, block.weak.rows()) = block.weak * whitened.segment(block.first, block.weak.cols());
    at += block.weak.rows();
  }
  return all;
}

}  // namespace snag
