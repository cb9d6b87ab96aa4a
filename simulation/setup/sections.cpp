#include "simulation/setup/sections.hpp"

#include "coupling/coupling_settings.hpp"
#include "coupling/prescribed_field.hpp"
#include "dem/contacts/contact_settings.hpp"
#include "dem/holds.hpp"
#include "dem/templates/rag_settings.hpp"
#include "dem/walls/walls.hpp"
#include "observe/passage/passage_geometry.hpp"
#include "simulation/setup/observe_settings.hpp"
#include "simulation/setup/settings.hpp"
#include "simulation/setup/start_flow.hpp"
#include "solver/boundaries/boundary.hpp"
#include "solver/fields/rotating_zone.hpp"
#include "solver/flow_settings.hpp"
#include "solver/pump_monitor.hpp"
#include "solver/turbulence/turbulence.hpp"

namespace snag {

struct AllSections::Settings {
  CaseSettings case_settings;
  MeshSettings mesh;
  PeriodicSettings periodic;
  TimeSettings time;
  FlowSettings flow;
  RotatingZoneSettings rotating_zone;
  StartSettings start;
  PumpSettings pump;
  PassageSettings passage;
  PrescribedFlow prescribed;
  RagSettings rag{RagSettings::Shape::rag}, disc{RagSettings::Shape::disc}, fibre{RagSettings::Shape::fibre},
      particle{RagSettings::Shape::particle};
  HoldSettings hold;
  DemSettings dem;
  ContactSettings contact;
  WallSettings wall;
  OutputSettings output;
  CheckpointSettings checkpoint;
  ObserveSettings observe;
};

AllSections::AllSections() : settings_(new Settings) {}
AllSections::~AllSections() { delete settings_; }

std::vector<Section> AllSections::list() {
  Settings& s = *settings_;
  std::vector<Section> all{s.case_settings.section(), s.mesh.section(), s.periodic.section(), s.time.section(), s.flow.section()};
  const auto append = [&](const std::vector<Section>& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(boundary_sections());
  append({s.rotating_zone.section()});
  append(turbulence_sections());
  append({s.start.section(), s.pump.section(), s.passage.section(), s.prescribed.section(), s.rag.section(), s.disc.section(),
          s.fibre.section(), s.particle.section()});
  append(bond_law_sections());
  append({s.hold.section(), s.dem.section()});
  append({{"contact", "Contacts of particles that are not bonded to each other, and with walls.", s.contact.parameters()},
          {"wall", "What particles cannot pass: planes, boxes, patches of the mesh, surfaces from STL; at rest, turning or translating.",
           s.wall.parameters(), true}});
  append(contact_law_sections());
  append(coupling_sections());
  append({s.output.section(), s.checkpoint.section(), s.observe.section()});
  return all;
}

}  // namespace snag
