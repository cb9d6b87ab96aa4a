// Case and study files, read with every section of the manual.
#include "base/case_file.hpp"
#include "base/case_tables.hpp"
#include "base/error.hpp"
#include "simulation/study.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

/// Of several kinds of one table (boundary conditions) each is read; what one kind lacks another has.
void read_all(const std::vector<Table>& tables, const Section& section) {
  for (const Table& table : tables) try {
      table.read(section.parameters);
    } catch (const Error&) {
    }
}

void read_case(const std::filesystem::path& file) {
  const CaseTables tables;
  const CaseFile read = CaseFile::read(file, {});
  for (const Section& section : tables.sections()) {
    read_all(section.repeated ? read.root().tables(section.name) : std::vector<Table>{read.root().table(section.name)}, section);
  }
  read.resolved(), read.sha256(), read.resume_sha256();
}

const fuzz::Registration cases({"case", ".toml",
                                [] {
                                  return std::vector<std::string>{fuzz::source_file("cases/rag-in-channel/case.toml"),
                                                                  fuzz::source_file("cases/pump-demo/case.toml"),
                                                                  fuzz::source_file("cases/fibre-shear/case.toml")};
                                },
                                read_case});
const fuzz::Registration studies(
    {"study", ".toml",
     [] {
       return std::vector<std::string>{fuzz::source_file("cases/pump-curve/study.toml"), fuzz::source_file("cases/fibre-shear/study.toml")};
     },
     [](const auto& file) { read_study(file); }});

}  // namespace
