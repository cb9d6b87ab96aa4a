// snag-mesh: makes a named, watertight mesh of a parametric geometry, checks it, and writes it as a gmsh file.
#include <fcntl.h>
#include <gmsh.h>
#include <spdlog/fmt/fmt.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/case_file.hpp"
#include "base/error.hpp"
#include "base/open_file.hpp"
#include "base/section_text.hpp"
#include "base/terminal.hpp"
#include "base/words.hpp"
#include "mesh/generate/geometry.hpp"
#include "mesh/generate/verify.hpp"

namespace snag::generate {
namespace {

constexpr int max_attempts = 8;          // a mesh with poor cells is made again,
constexpr double size_reduction = 0.99;  // with sizes this much smaller each time: a slightly other mesh, seldom poor twice

struct Request {
  std::string geometry, format = "2.2";
  std::filesystem::path parameters, out;
  std::vector<std::string> overrides;
  bool binary = false;
};

// Angles and speeds are read in the units that users think in.
std::string shown(double value, const std::string& unit) {
  if (unit == "rad") return fmt::format("{:.6g} deg", value * 180 / std::numbers::pi);
  if (unit == "rad/s") return fmt::format("{:.6g} rpm", value * 30 / std::numbers::pi);
  return fmt::format("{:.6g}{}", value, unit == "1" ? "" : " " + unit);
}

std::string default_text(const Parameter& parameter) {
  if (const auto* number = std::get_if<double*>(&parameter.target)) return shown(**number, parameter.unit);
  if (const auto* number = std::get_if<std::optional<double>*>(&parameter.target))
    return (*number)->has_value() ? shown(***number, parameter.unit) : "automatic";
  if (const auto* number = std::get_if<int*>(&parameter.target)) return std::to_string(**number);
  if (const auto* text = std::get_if<std::string*>(&parameter.target)) return "\"" + **text + "\"";
  if (const auto* flag = std::get_if<bool*>(&parameter.target)) return **flag ? "true" : "false";
  return "";
}

std::string parameter_table(const std::string& geometry) {
  const auto model = geometries().make(geometry, "snag-mesh");
  std::string text = "Parameters of PARAMS.toml, table [" + geometry + "], and of --set:\n";
  for (const auto& parameter : model->parameters()) {
    text += fmt::format("  {:<26}{:<16}{}{}\n", parameter.key, default_text(parameter), parameter.meaning,
                        parameter.choices.empty() ? "" : " One of: " + joined(parameter.choices) + ".");
  }
  return text + "Lengths as \"12 mm\", angles as \"7 deg\", speeds as \"1200 rpm\".";
}

/// Tables of all geometries for the manual.
std::string manual() {
  std::string text;
  for (const std::string& name : geometries().names()) {
    const auto geometry = geometries().make(name, "snag-mesh");
    text += section_text({name, geometry->meaning(), geometry->parameters()});
  }
  return text;
}

CaseFile read_parameters(const Request& request, Geometry& geometry) {
  std::vector<std::string> overrides;
  for (const auto& text : request.overrides) {
    const bool has_table = text.substr(0, text.find('=')).find('.') != std::string::npos;
    overrides.push_back(has_table ? text : request.geometry + "." + text);
  }
  auto file = request.parameters.empty() ? CaseFile::parse("", "--set", overrides) : CaseFile::read(request.parameters, overrides);
  file.root().table(request.geometry).read(geometry.parameters());
  file.reject_unread();
  return file;
}

void set_options() {
  const std::pair<const char*, double> options[] = {
      {"General.Terminal", 0},
      {"General.NumThreads", 1},  // more threads would make other meshes each time
      {"Mesh.MaxNumThreads1D", 1},
      {"Mesh.MaxNumThreads2D", 1},
      {"Mesh.MaxNumThreads3D", 1},
      {"Mesh.Algorithm", 6},
      {"Mesh.Algorithm3D", 1},                // frontal Delaunay of faces, Delaunay of volumes
      {"Mesh.LcIntegrationPrecision", 1e-4},  // of the number of cells along a curve; gmsh's 1e-9 takes two thirds of the time of a pump
      {"Mesh.Optimize", 0},
      {"Mesh.SaveAll", 0},
      {"Mesh.IgnorePeriodicity", 1},  // names say what is periodic; readers take the section in different ways
  };
  for (const auto& [name, value] : options) gmsh::option::setNumber(name, value);
}

/// One mesh in the current model; throws Error(mesh) with gmsh's own words if gmsh gives up.
Expectation make_mesh(Geometry& geometry, double size_factor) {
  gmsh::clear();
  gmsh::model::add("snag");
  Expectation expectation = geometry.build(size_factor);
  gmsh::model::mesh::generate(3);
  gmsh::model::mesh::optimize("");  // swaps of edges and faces; removes the slivers of Delaunay
  return expectation;
}

void print(const Expectation& expectation, const MeshReport& report) {
  for (const auto& remark : expectation.remarks) std::printf("note: %s\n", remark.c_str());
  std::fputs(table(report).c_str(), stdout);
}

/// The mesh of the first attempt that passes all checks.
void make_good_mesh(Geometry& geometry) {
  double factor = 1;
  for (int attempt = 1;; ++attempt, factor *= size_reduction) {
    std::string reason;
    try {
      const auto expectation = make_mesh(geometry, factor);
      const auto report = verified(expectation);
      if (report.failures.empty() || attempt == max_attempts || report.n_poor == 0) {
        print(expectation, report);
        if (report.failures.empty()) return;
        throw Error(ExitCode::mesh, "snag-mesh: the mesh failed its checks:\n  " + fmt::format("{}", fmt::join(report.failures, "\n  ")));
      }
      reason = fmt::format("{} cells below a quality of {}", report.n_poor, report.quality_limit);
    } catch (const std::string& gmsh_error) {  // gmsh throws text
      if (attempt == max_attempts)
        throw Error(ExitCode::mesh, "snag-mesh: gmsh could not mesh this shape (" + gmsh_error + "); change sizes or parameters");
      reason = gmsh_error;
    }
    std::printf("note: attempt %d: %s; again with sizes times %.4f\n", attempt, reason.c_str(), factor * size_reduction);
    std::fflush(stdout);
  }
}

/// gmsh does not see that its writes fail: the mesh must have its last line. Throws Error(io).
void check_written(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line, last;
  const auto bytes = static_cast<std::streamoff>(std::filesystem::file_size(file));
  in.seekg(std::max<std::streamoff>(0, bytes - 100));
  while (std::getline(in, line)) last = line;
  if (last.starts_with("$End")) return sync_to_disk(file);
  OpenFile(file, O_WRONLY | O_APPEND).write("\n");  // throws with the reason, such as a full disk
  throw Error(ExitCode::io, file.string() + ": was interrupted after " + std::to_string(bytes) + " bytes; is the disk full?");
}

/// Through a temporary name, so that a reader never sees half a mesh.
void write(const Request& request, const CaseFile& parameters) {
  gmsh::option::setNumber("Mesh.MshFileVersion", request.format == "2.2" ? 2.2 : 4.1);
  gmsh::option::setNumber("Mesh.Binary", request.binary);
  auto partial = request.out;
  partial.replace_extension(".partial.msh");
  const auto fail = [&](const std::string& why) {
    return Error(ExitCode::io,
                 request.out.string() + ": cannot be written (" + why + "), the folder must exist and have room; choose another --out");
  };
  try {
    {
      const OpenFile created(partial, O_WRONLY | O_CREAT | O_TRUNC);  // gmsh does not say why it cannot
    }
    gmsh::write(partial.string());
    check_written(partial);
    std::filesystem::rename(partial, request.out);
  } catch (const std::string& why) {
    throw fail(why);
  } catch (const std::filesystem::filesystem_error& why) {
    throw fail(why.code().message());
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw;
  }
  auto resolved = request.out;
  resolved.replace_extension(".resolved.toml");
  write_atomically(resolved, parameters.resolved());
}

void run(const Request& request) {
  if (request.out.extension() != ".msh")
    throw Error(ExitCode::usage, "--out: the name of the mesh (" + request.out.string() + "), must end in .msh; add the ending");
  const auto geometry = geometries().make(request.geometry, "snag-mesh");
  const auto parameters = read_parameters(request, *geometry);
  const auto start = std::chrono::steady_clock::now();
  gmsh::initialize(0, nullptr, false);
  set_options();
  make_good_mesh(*geometry);
  write(request, parameters);
  gmsh::finalize();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("%s: %s, gmsh %s%s, %.1f s\n", request.out.c_str(), request.geometry.c_str(), request.format.c_str(),
              request.binary ? " binary" : "", elapsed.count());
}

void declare(CLI::App& app, const std::string& name, Request& request) {
  auto* command = app.add_subcommand(name, geometries().make(name, "snag-mesh")->meaning());
  command->add_option("PARAMS", request.parameters, "Parameters, a TOML file with the table [" + name + "]; all have defaults");
  command->add_option("--out,-o", request.out, "The mesh, MESH.msh; the parameters used go to MESH.resolved.toml beside it")->required();
  command->add_option("--set", request.overrides, "key=value, instead of what PARAMS.toml says")->allow_extra_args(true);
  command->add_option("--format", request.format, "Version of the gmsh format")
      ->check(CLI::IsMember({"2.2", "4.1"}))
      ->capture_default_str();
  command->add_flag("--binary", request.binary, "Binary instead of text");
  command->footer([name] { return parameter_table(name); });
  command->callback([&request, name] { request.geometry = name; });
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Makes meshes of parametric geometries for Snag; `snag-mesh GEOMETRY --help` lists its parameters.", "snag-mesh");
  Request request;
  bool print_manual = false;
  app.add_flag("--manual", print_manual, "Print the parameters of all geometries as tables of the manual");
  for (const auto& name : geometries().names()) declare(app, name, request);
  app.require_subcommand(0, 1);
  if (argc > 1 && argv[1][0] != '-') geometries().make(argv[1], "snag-mesh");  // its error lists the known names
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return static_cast<int>(ExitCode::usage);
    check_standard_output();
    return 0;
  }
  if (print_manual) {
    std::fputs(manual().c_str(), stdout);
    check_standard_output();
    return 0;
  }
  if (request.geometry.empty())
    throw Error(ExitCode::usage, "snag-mesh: a subcommand is required, one of " + joined(geometries().names()) + "; see snag-mesh --help");
  run(request);
  return 0;
}

}  // namespace
}  // namespace snag::generate

int main(int argc, char** argv) {
  using namespace snag;
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // `snag mesh` that is killed leaves no mesh generator behind that fills the memory
  try {
    return generate::parse_and_run(argc, argv);
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(error.code);
  } catch (const std::string& gmsh_error) {
    std::fprintf(stderr, "error: snag-mesh: gmsh stopped (%s); change sizes or parameters\n", gmsh_error.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: snag-mesh: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::mesh);
}
