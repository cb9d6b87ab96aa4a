#include "diagnosis/localisation/missing_force.hpp"

#include <cmath>
#include <map>

#include "diagnosis/localisation/weak_form.hpp"
#include "observe/observables.hpp"

namespace snag {

namespace {

/// Rows of a path of a position.
struct Path {
  int axis = 0;
  std::vector<int> rows;      // of the point
  std::vector<double> times;  // s
};

std::vector<Path> paths_of_positions(const Responses& model, const PointSummary& point) {
  std::vector<Path> paths;
  for (int begin = 0, end = 0; begin < point.n_gaussian; begin = end) {
    const Row& first = point.rows[static_cast<std::size_t>(begin)];
    const std::string& id = model.experiment().observables[static_cast<std::size_t>(first.observable)].id;
    const ObservableRecord* record = find_observable(id);
    Path path;
    for (end = begin; end < point.n_gaussian && point.rows[static_cast<std::size_t>(end)].observable == first.observable; ++end) {
      const Row& row = point.rows[static_cast<std::size_t>(end)];
      path.rows.push_back(end), path.times.push_back(0.5 * (row.begin + row.end));
    }
    const std::size_t axis = std::string("xyz").find(id);
    if (first.kind != Row::Kind::path || !record || !record->is_position() || axis == std::string::npos) continue;
    path.axis = static_cast<int>(axis);
    paths.push_back(std::move(path));
  }
  return paths;
}

/// Of one point, by the time of the test functions.
class ForcesOfPoint {
 public:
  ForcesOfPoint(const Responses& model, std::size_t p, const FittedGap& before, const FittedGap* after)
      : point_(model.points()[static_cast<std::size_t>(model.training()[p])]), p_(p), before_(before), after_(after) {
    for (const Path& path : paths_of_positions(model, point_)) add(path);
    for (auto& [time, force] : by_time_) {
      force.point = model.experiment().points[static_cast<std::size_t>(point_.point)].id, force.time = time;
      force.speed = std::sqrt(square_of_speed_[time]);
    }
  }

  std::vector<MissingForce> all() const {
    std::vector<MissingForce> forces;
    for (const auto& [time, force] : by_time_) forces.push_back(force);
    return forces;
  }

 private:
  void add(const Path& path) {
    const Eigen::MatrixXd W = test_functions(path.times);
    std::vector<int> rows;
    for (const int row : path.rows) rows.push_back(before_.row(p_, row));
    const Eigen::VectorXd a = W * before_.left(rows), variance = (W * before_.covariance(rows) * W.transpose()).diagonal();
    const auto axis = static_cast<std::size_t>(path.axis);
    for (Eigen::Index j = 0; j < W.rows(); ++j) {
      std::vector<std::size_t> support;
      for (Eigen::Index i = 0; i < W.cols(); ++i)
        if (W(j, i) != 0) support.push_back(static_cast<std::size_t>(i));
      const std::size_t from = support.front(), to = support.back(), middle = (from + to) / 2;
      const auto value = [&](std::size_t i) { return point_.rows[static_cast<std::size_t>(path.rows[i])].value; };
      const double time = path.times[middle], velocity = (value(to) - value(from)) / (path.times[to] - path.times[from]);
      MissingForce& force = by_time_[time];
      square_of_speed_[time] += velocity * velocity;
      force.place.at(axis) = value(middle), force.before.at(axis) = a[j], force.u.at(axis) = std::sqrt(variance[j]);
      if (after_) force.after.at(axis) = W.row(j).dot(after_->left(rows));
    }
  }

  const PointSummary& point_;
  std::size_t p_;
  const FittedGap& before_;
  const FittedGap* after_;
  std::map<double, MissingForce> by_time_;
  std::map<double, double> square_of_speed_;
};

}  // namespace

std::vector<MissingForce> missing_forces(const Responses& model, const FittedGap& before, const FittedGap* after) {
  std::vector<MissingForce> forces;
  for (std::size_t p = 0; p < model.training().size(); ++p)
    for (MissingForce& force : ForcesOfPoint(model, p, before, after).all()) forces.push_back(std::move(force));
  return forces;
}

}  // namespace snag
