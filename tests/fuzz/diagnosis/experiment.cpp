// DIAGNOSIS.toml and its data.
#include <fstream>

#include "diagnosis/data/experiment.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

const std::string folder = "cases/diagnose-sphere/";

/// A folder with the other files of the experiment, beside the one that is damaged.
std::filesystem::path beside(const std::filesystem::path& file) {
  std::filesystem::path made = file.parent_path() / (file.stem().string() + "_files");
  std::filesystem::create_directories(made);
  return made;
}

void write(const std::filesystem::path& file, const std::string& content) { std::ofstream(file, std::ios::binary) << content; }

void read_diagnosis(const std::filesystem::path& file) {
  const auto made = beside(file);
  static const std::string data = fuzz::source_file(folder + "data.csv");
  write(made / "data.csv", data);
  std::filesystem::copy_file(file, made / "DIAGNOSIS.toml", std::filesystem::copy_options::overwrite_existing);
  read_experiment(made / "DIAGNOSIS.toml");
}

void read_data(const std::filesystem::path& file) {
  const auto made = beside(file);
  static const std::string diagnosis = fuzz::source_file(folder + "DIAGNOSIS.toml");
  write(made / "DIAGNOSIS.toml", diagnosis);
  std::filesystem::copy_file(file, made / "data.csv", std::filesystem::copy_options::overwrite_existing);
  read_experiment(made / "DIAGNOSIS.toml");
}

const fuzz::Registration experiment({"diagnosis", ".toml",
                                     [] { return std::vector<std::string>{fuzz::source_file(folder + "DIAGNOSIS.toml")}; },
                                     read_diagnosis});
const fuzz::Registration data({"diagnosis_data", ".csv", [] { return std::vector<std::string>{fuzz::source_file(folder + "data.csv")}; },
                               read_data});

}  // namespace
