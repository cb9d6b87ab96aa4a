#include "textile/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/words.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

constexpr int first_seed = 1, coarse_seeds = 2;
constexpr double first_share = 0.12;  // S_t of the scan's first point over the mean of the two S_nb: torsion and bending of a bond alike
constexpr double scan_factor = 2;
constexpr int scan_points = 3;
constexpr int most_extensions = 5;  // of the scan, where its best point is an end

double square(double x) { return x * x; }

/// One drape to be run.
struct Job {
  std::size_t point;
  int seed;
};

/// The fit: drapes at several S_t on all ranks.
class DrapeFit {
 public:
  DrapeFit(MPI_Comm comm, const TextileTests& tests, const CalibrationSettings& settings)
      : comm_(comm), tests_(tests), settings_(settings) {}

  void scan();
  void refine();
  void complete();
  std::size_t best() const {
    return std::min_element(points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.misfit < b.misfit; }) -
           points_.begin();
  }
  std::vector<DrapePoint>& points() { return points_; }
  RagSheet sheet(std::size_t point) const;

 private:
  void add(const std::vector<double>& stiffnesses);
  void run(const std::vector<Job>& jobs);
  void average(DrapePoint& point) const;

  MPI_Comm comm_;
  const TextileTests& tests_;
  const CalibrationSettings& settings_;
  std::vector<DrapePoint> points_;
  std::map<double, RagSheet> sheets_;  // of the first seed, by S_t: those that this rank has run
};

void DrapeFit::scan() {
  const std::array<BondProperties, 2> limp = bonds_at(tests_, settings_, 0);
  const double first = first_share * std::sqrt(limp[0].bending_stiffness * limp[1].bending_stiffness);
  std::vector<double> stiffnesses;
  for (int i = 0; i < scan_points; ++i) stiffnesses.push_back(first * std::pow(scan_factor, i));
  add(stiffnesses);
  for (int i = 0; i < most_extensions; ++i) {
    if (best() == 0)
      add({points_.front().tangential_stiffness() / scan_factor});
    else if (best() + 1 == points_.size())
      add({points_.back().tangential_stiffness() * scan_factor});
    else
      break;
  }
}

/// Between the best point and its neighbours.
void DrapeFit::refine() {
  const std::size_t at = best();
  std::vector<double> between;
  const auto middle = [&](std::size_t a, std::size_t b) {
    return std::sqrt(points_[a].tangential_stiffness() * points_[b].tangential_stiffness());
  };
  if (at > 0) between.push_back(middle(at - 1, at));
  if (at + 1 < points_.size()) between.push_back(middle(at, at + 1));
  add(between);
}

/// All seeds at the best point; where they make another one the best, at that one too.
void DrapeFit::complete() {
  for (std::size_t at = best(); static_cast<int>(points_[at].samples.size()) < settings_.n_seeds; at = best()) {
    std::vector<Job> jobs;
    for (int seed = static_cast<int>(points_[at].samples.size()) + 1; seed <= settings_.n_seeds; ++seed) jobs.push_back({at, seed});
    run(jobs);
  }
}

void DrapeFit::add(const std::vector<double>& stiffnesses) {
  std::vector<Job> jobs;
  for (const double stiffness : stiffnesses) {
    for (int seed = first_seed; seed <= coarse_seeds; ++seed) jobs.push_back({points_.size(), seed});
    points_.push_back({});
    points_.back().bond = bonds_at(tests_, settings_, stiffness);
  }
  run(jobs);
  std::sort(points_.begin(), points_.end(),
            [](const auto& a, const auto& b) { return a.tangential_stiffness() < b.tangential_stiffness(); });
}

void DrapeFit::run(const std::vector<Job>& jobs) {
  const std::vector<DrapeSample> samples = drape_samples(comm_, jobs.size(), [&](std::size_t j) {
    const DrapePoint& point = points_[jobs[j].point];
    Drape drape = relaxed_drape(drape_test(tests_), drape_cloth(tests_, settings_.radius, point.bond), jobs[j].seed);
    DrapeSample sample{jobs[j].seed, outline_from_above(drape.sheet, settings_.radius), drape.cost};
    if (jobs[j].seed == first_seed) sheets_[point.tangential_stiffness()] = std::move(drape.sheet);
    return sample;
  });
  for (std::size_t j = 0; j < jobs.size(); ++j) points_[jobs[j].point].samples.push_back(samples[j]);
  for (const Job& job : jobs) average(points_[job.point]);
  for (const DrapePoint& point : points_)
    if (std::any_of(jobs.begin(), jobs.end(),
                    [&](const Job& job) { return job.point == static_cast<std::size_t>(&point - points_.data()); }))
      settings_.report_progress("drape, S_t = " + number_text(point.tangential_stiffness()) + " N/m3, " +
                                std::to_string(point.samples.size()) + " seeds: area " + number_text(1e4 * point.area) + " cm2, " +
                                number_text(point.wave_count) + " waves of " + number_text(1e3 * point.wave_size) + " mm");
}

void DrapeFit::average(DrapePoint& point) const {
  const double n = static_cast<double>(point.samples.size());
  point.area = point.wave_size = point.wave_count = point.area_spread = point.wave_size_spread = 0;
  for (const DrapeSample& s : point.samples) {
    point.area += s.outline.area / n, point.wave_size += s.outline.mean_wave_size() / n;
    point.wave_count += static_cast<double>(s.outline.waves.size()) / n;
  }
  for (const DrapeSample& s : point.samples) {
    point.area_spread += square(s.outline.area - point.area),
        point.wave_size_spread += square(s.outline.mean_wave_size() - point.wave_size);
  }
  const double freedom = std::max(1.0, n - 1);
  point.area_spread = std::sqrt(point.area_spread / freedom), point.wave_size_spread = std::sqrt(point.wave_size_spread / freedom);
  const DrapeResult& measured = tests_.drape;
  point.misfit = square((point.area / measured.area - 1) / area_tolerance) +
                 square((point.wave_size / measured.wave_size - 1) / wave_size_tolerance) +
                 square((point.wave_count - measured.wave_count) / wave_count_tolerance);
}

/// Of the first seed; run once more where another rank had it.
RagSheet DrapeFit::sheet(std::size_t point) const {
  const auto kept = sheets_.find(points_[point].tangential_stiffness());
  if (kept != sheets_.end()) return kept->second;
  return relaxed_drape(drape_test(tests_), drape_cloth(tests_, settings_.radius, points_[point].bond), first_seed).sheet;
}

/// S_nb at the ends of the measured overhangs: it rises with the overhang.
MeasuredRange bending_range(const TextileTests& tests, int direction, double radius, const BondProperties& bond) {
  const MeasuredRange& measured = tests.bending[direction].overhang_range;
  if (!measured.given()) return {};
  Strip strip = strip_of(tests, direction, radius, bond);
  MeasuredRange range;
  strip.overhang = measured.low, range.low = bending_stiffness_to_plane(strip, tests.plane_angle);
  strip.overhang = measured.high, range.high = bending_stiffness_to_plane(strip, tests.plane_angle);
  return range;
}

bool within_tolerance(const DrapePoint& point, const DrapeResult& measured) {
  return std::abs(point.area / measured.area - 1) <= area_tolerance &&
         std::abs(point.wave_size / measured.wave_size - 1) <= wave_size_tolerance;
}

}  // namespace

std::array<BondProperties, 2> bonds_at(const TextileTests& tests, const CalibrationSettings& settings, double tangential_stiffness) {
  std::array<BondProperties, 2> bond;
  for (int d = 0; d < 2; ++d) {
    bond[d] = elongation_bond(tests, d, settings.radius, settings.as_published);
    bond[d].tangential_stiffness = tangential_stiffness > 0 ? tangential_stiffness : bond[d].normal_stiffness;
    bond[d].bending_stiffness = bending_stiffness_to_plane(strip_of(tests, d, settings.radius, bond[d]), tests.plane_angle);
  }
  return bond;
}

Calibration calibrate(MPI_Comm comm, const TextileTests& tests, const CalibrationSettings& settings) {
  Calibration result;
  result.settings = settings;
  result.contact_radius = contact_radius_bounds(std::max(tests.elongation[0].max_strain, tests.elongation[1].max_strain));
  DrapeFit fit(comm, tests, settings);
  fit.scan(), fit.refine(), fit.complete();
  result.chosen = fit.best();
  on_all_ranks(comm, [&] {
    if (rank_of(comm) == 0) result.sheet = fit.sheet(result.chosen);
  });
  result.drapes = std::move(fit.points());
  result.bond = result.drapes[result.chosen].bond;
  for (const DrapePoint& point : result.drapes)
    if (within_tolerance(point, tests.drape)) {
      MeasuredRange& range = result.tangential_range;
      range.low = range.given() ? std::min(range.low, point.tangential_stiffness()) : point.tangential_stiffness();
      range.high = std::max(range.high, point.tangential_stiffness());
    }
  for (int d = 0; d < 2; ++d) {
    const BondProperties& bond = result.bond[d];
    result.grab[d] = simulated_grab_test(tests, d, settings.radius, {bond, result.bond[1 - d]});
    BendingFit& bending = result.bending[d];
    bending.shape = hanging_strip(strip_of(tests, d, settings.radius, bond));
    bending.height = height_above_plane(bending.shape.tip, tests.plane_angle);
    bending.stiffness = bending_range(tests, d, settings.radius, bond);
    settings.report_progress(std::string(direction_name[d]) + ": simulated grab test " + number_text(result.grab[d].max_force) +
                             " N at a strain of " + number_text(result.grab[d].strain_at_max) + "; tip " +
                             number_text(1e3 * bending.height) + " mm above the plane");
  }
  return result;
}

}  // namespace snag
