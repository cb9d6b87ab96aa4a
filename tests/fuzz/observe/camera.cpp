// Camera files, pictures, tables of repeats.
#include "observe/camera.hpp"
#include "observe/picture.hpp"
#include "observe/repeats.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace snag;

const fuzz::Registration camera(
    {"camera", ".toml",
     [] {
       return std::vector<std::string>{
           "[camera]\npixels = [640, 480]\npixel_mm = 0.5\ncentre_m = [0, 0, 0]\ndistance = \"2 m\"\nnoise = 2\n\n[cloth]\n"
           "threshold = 25\nsmoothing = 1\nfill_holes = true\n"};
     },
     [](const auto& file) { read_camera(file); }});

const std::string grey = "P5\n4 3\n255\n" + std::string("abcdefghijkl"), text = "P2\n2 2\n255\n1 2\n3 4\n";
const std::string bmp(
    "BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0\0\0\0\0\x10\0\0\0\x13\x0b\0\0\x13\x0b\0\0\0\0\0\0\0\0\0\0"
    "\0\0\xff\xff\xff\xff\0\0\xff\0\0\0\xff\0\0\0",
    70);
const fuzz::Registration pictures({"picture", ".pgm",
                                   [] {
                                     return std::vector<std::string>{grey, text};
                                   },
                                   [](const auto& file) { read_picture(file); }});
const fuzz::Registration png({"picture_png", ".png",
                              [] {
                                return std::vector<std::string>{fuzz::source_file("cases/diagnose-jeffery/picture.png").substr(0, 1 << 20)};
                              },
                              [](const auto& file) { read_picture(file); }});
const fuzz::Registration bitmaps({"picture_bmp", ".bmp", [] { return std::vector<std::string>{bmp}; },
                                  [](const auto& file) { read_picture(file); }});

const fuzz::Registration repeats(
    {"repeats", ".csv",
     [] {
       return std::vector<std::string>{
           "group,rag,area [m2],orientation [deg]\nA,1,0.02,10\nA,2,0.03,-80\nB,1,0.025,12\nB,2,0.021,85\n# end\n"};
     },
     [](const auto& file) { compare_groups(read_repeats(file), "table"); }});

}  // namespace
