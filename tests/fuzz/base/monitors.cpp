// Monitors and VTK files of a run that is observed or reported.
#include "base/series.hpp"
#include "base/vtk_reader.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

const fuzz::Registration series({"series", ".csv", [] { return std::vector<std::string>{"time [s],head [m]\n0,1\n0.5,2e-3\n1,nan\n"}; },
                                 [](const auto& file) { read_series(file); }});
const fuzz::Registration collection(
    {"pvd", ".pvd",
     [] {
       return std::vector<std::string>{
           "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n"
           "<DataSet timestep=\"0.5\" part=\"0\" file=\"rags_000001.vtp\"/>\n</Collection>\n</VTKFile>\n"};
     },
     [](const auto& file) { read_collection(file); }});

}  // namespace
