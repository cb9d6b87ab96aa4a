#include "observe/passage/volute_watch.hpp"

#include <nlohmann/json.hpp>
#include <numbers>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace snag {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// The picture is the plane z = 0, metres from its middle to the right and up; the camera stands on the side of +z.
PassageGeometry geometry_of(const Camera& camera) {
  const VoluteView& view = *camera.volute;
  const auto point = [&](const std::vector<double>& pixel) {
    return Vec3{(pixel[0] - 0.5 * camera.width()) * camera.pixel, (0.5 * camera.height() - pixel[1]) * camera.pixel, 0};
  };
  const double to_inlet = view.seen_from == "inlet" ? 1 : -1, sense = view.impeller_turns == "counter_clockwise" ? 1 : -1;
  PassageSettings settings;
  settings.inlet_flange = point(view.axis) + Vec3{0, 0, to_inlet};  // before the picture: what is seen has come in
  settings.inlet_normal = {0, 0, -to_inlet}, settings.inlet_radius = view.impeller_radius;
  settings.outlet_flange = point(view.outlet), settings.outlet_normal = {view.outlet_direction[0], view.outlet_direction[1], 0};
  settings.outlet_radius = view.outlet_radius;
  settings.tongue = point(view.tongue), settings.tongue_reach = view.tongue_reach, settings.impeller_radius = view.impeller_radius;
  return {settings, point(view.axis), {0, 0, 1}, sense, "[pump_in_picture] of the camera"};
}

}  // namespace

VoluteWatch::VoluteWatch(const Camera& camera) : geometry_(geometry_of(camera)), tracker_(Passageway::pump, geometry_.sense()) {}

RagSnapshot VoluteWatch::sighting(const Blob& blob) const {
  RagSnapshot seen;
  const Coverage& cloth = blob.coverage;
  bool touches_tongue = false;
  for (int j = 0; j < cloth.ny; ++j)
    for (int i = 0; i < cloth.nx; ++i) {
      if (!cloth.at(i, j)) continue;
      const Vec3 x{cloth.x0 + (i + 0.5) * cloth.side, cloth.y0 + (j + 0.5) * cloth.side, 0};
      const PlaceInPump place = geometry_.place_of(x);
      ++seen.n, seen.n_out += place.out, seen.n_in_discharge += place.in_discharge, seen.n_outside_impeller += place.outside_impeller;
      if (place.just_past_tongue) ++(place.in_discharge ? seen.n_past_outside : seen.n_past_inside);
      touches_tongue = touches_tongue || norm(x - geometry_.tongue()) < geometry_.tongue_reach();
    }
  seen.touched[WallRegion::tongue] = touches_tongue;
  const Vec3 centre{blob.seen.x, blob.seen.y, 0};
  seen.angle = geometry_.angle(centre), seen.radius = geometry_.radius(centre);
  return seen;
}

void VoluteWatch::add(const std::vector<Blob>& blobs, double time, double step) {
  if (!blobs.empty()) {
    last_ = sighting(blobs.front());
    tracker_.add(last_, time, step);
  } else if (last_.n > 0 && 2 * last_.n_in_discharge > last_.n && !tracker_.exited_at()) {
    last_.n_out = last_.n, last_.touched = {};
    tracker_.add(last_, time, step);
  }
}

VoluteHistogram VoluteWatch::histogram() const {
  VoluteHistogram histogram;
  if (last_.n == 0) return histogram;
  const PassageResult verdict = tracker_.verdict();
  histogram.add(*verdict.volute);
  for (const PassageResult::Event& event : verdict.events) histogram.count(event.what, *event.angle / degrees);
  return histogram;
}

VoluteHistogram volute_of_run(const std::filesystem::path& run) {
  using nlohmann::json;
  const auto text = file_text(run / "summary.json");
  VoluteHistogram histogram;
  if (!text) return histogram;
  try {
    const json summary = json::parse(*text);
    for (const json& rag : summary.at("rags")) {
      if (rag.at("volute").empty()) continue;
      VoluteStay stay;
      for (const json& bin : rag.at("volute"))
        if (const double time = bin.at("time_s"); time > 0)
          stay.add(bin.at("angle_deg").get<double>() / degrees, bin.at("mean_radius_m"), time);
      histogram.add(stay);
      for (const json& event : rag.at("events"))
        if (const auto what = event_named(event.at("what").get<std::string>()))
          histogram.count(*what, event.at("angle_deg").get<double>() / degrees);
    }
  } catch (const json::exception& failure) {
    throw Error(ExitCode::io,
                (run / "summary.json").string() + ": is not the summary of a run (" + failure.what() + "); run the case again");
  }
  return histogram;
}

}  // namespace snag
