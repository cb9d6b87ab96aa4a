#include "simulation/output/balance_output.hpp"

#include <array>
#include <cmath>

#include "parallel/checkpoint.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

/// Of one instant, for the means.
struct Quantity {
  double BalanceSummary::*mean;
  double (*value)(const Balances&);
};

constexpr std::array quantities{
    Quantity{&BalanceSummary::shaft_torque, [](const Balances& now) { return now.shaft_torque(); }},
    Quantity{&BalanceSummary::torque_lost_rotor, [](const Balances& now) { return now.turning().lost(); }},
    Quantity{&BalanceSummary::torque_lost_stator, [](const Balances& now) { return now.at_rest().lost(); }},
    Quantity{&BalanceSummary::torque_residual,
             [](const Balances& now) { return std::abs(now.turning().residual()) + std::abs(now.at_rest().residual()); }},
    Quantity{&BalanceSummary::shaft_power, [](const Balances& now) { return now.energy().shaft; }},
    Quantity{&BalanceSummary::given_power, [](const Balances& now) { return now.energy().given; }},
    Quantity{&BalanceSummary::hydraulic_power, [](const Balances& now) { return now.energy().hydraulic; }},
    Quantity{&BalanceSummary::stored_power, [](const Balances& now) { return now.energy().stored; }},
    Quantity{&BalanceSummary::dissipation_viscous, [](const Balances& now) { return now.energy().dissipation_viscous; }},
    Quantity{&BalanceSummary::dissipation_turbulent, [](const Balances& now) { return now.energy().dissipation_turbulent; }},
    Quantity{&BalanceSummary::dissipation_walls, [](const Balances& now) { return now.energy().dissipation_walls; }},
    Quantity{&BalanceSummary::numerical_power, [](const Balances& now) { return now.energy().numerical(); }},
    Quantity{&BalanceSummary::power_residual, [](const Balances& now) { return std::abs(now.energy().residual()); }}};

using Record = const BalanceRecord&;

void add_zone(std::vector<Column<BalanceRecord>>& all, const FlowSolver& water, int zone) {
  const Mesh& mesh = water.flow.mesh;
  const std::string name = zone == 0 ? "rotor_" : "stator_";
  const auto add = [&](const std::string& column, auto value) {
    all.push_back(
        {name + column, "N m", [zone, value](Record r) { return value(zone == 0 ? r.balances->turning() : r.balances->at_rest()); }});
  };
  using Row = const AngularMomentumBalance&;
  add("stored", [](Row row) { return row.stored; });
  add("openings", [](Row row) { return row.openings; });
  add("interface", [](Row row) { return row.interface; });
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (water.boundary().is_open(static_cast<int>(p)) || !water.balances()->has_faces(zone, static_cast<int>(p))) continue;
    add("wall_" + mesh.patches[p].name + "_pressure", [p](Row row) { return row.wall_pressure[p]; });
    add("wall_" + mesh.patches[p].name + "_friction", [p](Row row) { return row.wall_friction[p]; });
  }
  add("given", [](Row row) { return row.given; });
  add("lost", [](Row row) { return row.lost(); });
  add("lost_convection", [](Row row) { return row.lost_convection; });
  add("lost_pressure", [](Row row) { return row.lost_pressure; });
  add("lost_friction", [](Row row) { return row.lost_friction; });
  add("residual", [](Row row) { return row.residual(); });
}

std::vector<Column<BalanceRecord>> columns(const FlowSolver& water) {
  std::vector<Column<BalanceRecord>> all{{"time", "s", [](Record r) { return r.time; }},
                                         {"shaft_torque", "N m", [](Record r) { return r.balances->shaft_torque(); }}};
  for (int zone = 0; zone < 2; ++zone)
    if (water.balances()->has_cells(zone)) add_zone(all, water, zone);
  const auto add = [&](const char* column, auto value) {
    all.push_back({column, "W", [value](Record r) { return value(r.balances->energy()); }});
  };
  using Row = const EnergyBalance&;
  add("shaft_power", [](Row row) { return row.shaft; });
  add("given_power", [](Row row) { return row.given; });
  add("hydraulic_power", [](Row row) { return row.hydraulic; });
  add("stored_power", [](Row row) { return row.stored; });
  add("dissipation_viscous", [](Row row) { return row.dissipation_viscous; });
  add("dissipation_turbulent", [](Row row) { return row.dissipation_turbulent; });
  add("dissipation_walls", [](Row row) { return row.dissipation_walls; });
  add("numerical", [](Row row) { return row.numerical(); });
  add("numerical_convection", [](Row row) { return row.numerical_convection; });
  add("numerical_time", [](Row row) { return row.numerical_time; });
  add("numerical_pressure", [](Row row) { return row.numerical_pressure; });
  add("numerical_friction", [](Row row) { return row.numerical_friction; });
  add("residual_power", [](Row row) { return row.residual(); });
  return all;
}

}  // namespace

BalanceOutput::BalanceOutput(const std::filesystem::path& monitors, const FlowSolver& water, const RotorState& start, bool resume,
                             double from_time)
    : root_(rank_of(water.flow.mesh.comm) == 0), turn_(start), sampler_(start.angle) {
  on_all_ranks(water.flow.mesh.comm, [&] {
    if (root_) monitor_ = Monitor<BalanceRecord>(monitors / "balance.csv", columns(water), resume, from_time);
  });
}

void BalanceOutput::after_step(const FlowSolver& water, const RotorState& rotor) {
  const Balances& balances = *water.balances();
  turn_.after_step(rotor, water.flow.time_step_size);
  for (const Revolution& revolution : sampler_.add(turn_.turned, values_of(quantities, balances)))
    last_means_ = revolution_means(revolution, quantities.size());
  if (root_) monitor_.add({water.flow.time, &balances});
}

BalanceSummary BalanceOutput::summary() const {
  const std::vector<double> means = last_means_.empty() ? revolution_means(sampler_.current(), quantities.size()) : last_means_;
  BalanceSummary summary;
  for (std::size_t q = 0; q < quantities.size(); ++q) summary.*quantities[q].mean = means[q];
  return summary;
}

void BalanceOutput::save(CheckpointWriter& writer) const {
  writer.shared("balance/turned", std::vector<double>{turn_.turned, turn_.speed});
  writer.shared("balance/revolution", sampler_.state());
  if (!last_means_.empty()) writer.shared("balance/last_means", last_means_);
}

void BalanceOutput::load(CheckpointReader& reader) {
  const std::vector<double> turned = reader.shared("balance/turned");
  turn_.turned = turned[0], turn_.speed = turned[1];
  sampler_.restore(reader.shared("balance/revolution"));
  if (reader.has("balance/last_means")) last_means_ = reader.shared("balance/last_means");
}

}  // namespace snag
