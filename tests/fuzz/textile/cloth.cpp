// Laboratory tests of a cloth, its passport, poses of its particles.
#include "dem/templates/passport.hpp"
#include "dem/templates/pose_file.hpp"
#include "tests/fuzz/target.hpp"
#include "textile/textile_tests.hpp"

namespace {

using namespace snag;

const fuzz::Registration tests({"textile_tests", ".toml",
                                [] {
                                  return std::vector<std::string>{fuzz::source_file("cases/textile-aro/tests.toml"),
                                                                  fuzz::source_file("cases/textile-limp/tests.toml")};
                                },
                                [](const auto& file) { read_textile_tests(file); }});

const fuzz::Registration passport({"passport", ".toml",
                                   [] { return std::vector<std::string>{fuzz::source_file("cases/textile-aro/passport.toml")}; },
                                   [](const auto& file) {
                                     const Passport read = read_passport(file);
                                     read.bond(read.entries.front().radius, 0);
                                   }});

Rag row_of_three() {
  Rag rag;
  rag.n_columns = 3, rag.n_rows = 1, rag.radius = 1e-3;
  return rag;
}

const fuzz::Registration poses(
    {"pose_file", ".csv",
     [] {
       return std::vector<std::string>{
           "particle,x [m],y [m],z [m],w [1],qx [1],qy [1],qz [1]\n0,0,0,0,1,0,0,0\n1,0.002,0,0,1,0,0,0\n2,0.004,0,0,1,0,0,0\n"};
     },
     [](const auto& file) { read_pose_file(file, row_of_three()); }});

}  // namespace
