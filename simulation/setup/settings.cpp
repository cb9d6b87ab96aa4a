#include "simulation/setup/settings.hpp"

#include <cmath>

#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "base/words.hpp"
#include "mesh/import/mesh_reader.hpp"
#include "simulation/writers/field_writer.hpp"

namespace snag {

Section CaseSettings::section() {
  return {"case",
          "What this case is.",
          {setting("name", &name, "Short name, used in reports."), setting("description", &description, "One sentence.")}};
}
const bool case_table = add_case_table<CaseSettings>(10);

Section MeshSettings::section() {
  return {"mesh",
          "The mesh of the water: a file with named volumes and surfaces. Without it there is no water.",
          {file_setting("file", &file, "Mesh file, relative to the case file: " + readable_mesh_formats() + "."),
           {"scale", &scale, "1", 1e-9, 1e9, Basis::assumed, "Metres in one unit of length of the file (0.001 for millimetres)."},
           setting("geometry", &geometry, "Parametric geometry instead of a file: the mesh is generated for this run, as by `snag mesh`.",
                   {"", "pump", "pipe", "channel", "box", "tank", "blade_rows"}),
           file_setting("parameters", &parameters,
                        "Parameter file of the geometry, relative to the case file; by default the parameters have their defaults."),
           setting("set", &set, "Values that replace those of the parameter file, as for --set of `snag mesh`: \"wall_size_mm=2\".")}};
}
const bool mesh_table = add_case_table<MeshSettings>(20);

Section PeriodicSettings::section() {
  return {"periodic",
          "A pair of periodic patches: water that leaves through one enters through the other. Rags are not carried through: a run ends "
          "with code 5 where one gets there.",
          {setting("first", &pair.first, "First patch of the pair."),
           setting("second", &pair.second, "The matching patch."),
           {"translation", &pair.translation, "m", -1e6, 1e6, Basis::assumed, "Shift from the first patch to the second."}},
          true};
}
const bool periodic_table = add_case_table<PeriodicSettings>(30);

Section TimeSettings::section() {
  return {
      "time",
      "Time begins at zero; the rags take sub-steps within each step.",
      {{.key = "end",
        .target = &end,
        .unit = "s",
        .minimum = 0,
        .maximum = 1e9,
        .meaning = "Time to simulate.",
        .may_differ_on_resume = true},
       {.key = "step",
        .target = &step,
        .unit = "s",
        .minimum = 1e-12,
        .maximum = 1e6,
        .meaning = "Step of the water and of the coupling. \"auto\": the program finds it, by degrees_per_step or step_accuracy.",
        .choices = {"auto"}},
       {"degrees_per_step", &degrees_per_step, "1", 0.25, 30, Basis::assumed,
        "With step = \"auto\": degrees that the rotor turns in a step, a bare number. The step is the largest one that turns it no "
        "further, "
        "a whole number of them a revolution."},
       {"step_accuracy", &step_accuracy, "1", 1e-4, 0.1, Basis::assumed,
        "With step = \"auto\": largest error of the mean head and torque by the step, relative; 0.005 if neither this nor degrees_per_step "
        "is given. A trial before the run finds the largest step that is as accurate. Needs [pump] and a rotor that slides."},
       setting("end_when_rags_left", &end_when_rags_left, "true: the run ends as soon as every rag has left through an outlet."),
       {"run_on", &run_on, "s", 0, 1e9, Basis::assumed,
        "With end_when_rags_left: simulated time after the last rag has left; one revolution or more gives the head after the passage."}}};
}
const bool time_table = add_case_table<TimeSettings>(40);

bool TimeSettings::step_is_auto() const { return std::isnan(step); }

std::int64_t TimeSettings::n_steps() const {
  if (run_on > 0 && !end_when_rags_left)
    throw Error(ExitCode::usage,
                "[time] run_on = " + number_text(run_on) + " s has no effect without end_when_rags_left = true; give both");
  const double steps = end / step;
  const auto n = std::llround(steps);
  if (std::abs(steps - static_cast<double>(n)) > 1e-6)
    throw Error(ExitCode::usage, "[time] end_s = " + number_text(end) + " is " + std::to_string(steps) + " steps of step_s = " +
                                     number_text(step) + ", but must be a whole number of them; change one of the two");
  return n;
}

Section OutputSettings::section() {
  return {"output",
          "Files with fields and rags; monitors are written every step.",
          {{"fields_interval", &fields_interval, "s", 0, 1e9, Basis::assumed,
            "Time between fields of the water; not given: 20 of them over the run."},
           {"rags_interval", &rags_interval, "s", 0, 1e9, Basis::assumed,
            "Time between pictures of the rags; not given: 100 of them over the run."},
           setting("format", &format, field_format_meaning(), field_writers().names()),
           setting("report", &report, "Write report.html at the end."),
           setting("single_precision", &single_precision, "Fields as 32-bit numbers; false: 64-bit.")}};
}
const bool output_table = add_case_table<OutputSettings>(240);

Section CheckpointSettings::section() {
  return {"checkpoint",
          "Checkpoints in two alternating slots; one more is written on a request to stop (SIGTERM, SIGINT, SIGUSR1, or a file named stop "
          "in the output folder).",
          {{"interval", &interval, "s", 0, 1e9, Basis::assumed,
            "Simulated time between checkpoints; by default they follow the wall clock only."},
           {"wall_interval", &wall_interval, "s", 0, 1e9, Basis::assumed, "Wall-clock time between checkpoints."}}};
}
const bool checkpoint_table = add_case_table<CheckpointSettings>(250);

}  // namespace snag
