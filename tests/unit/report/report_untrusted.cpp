// The results may be a stranger's: a report runs nothing of theirs, reads and writes nothing outside of their folder, and shows names as
// text.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/quotation.hpp"
#include "base/series.hpp"
#include "report/report.hpp"

namespace snag {
namespace {

namespace fs = std::filesystem;

class UntrustedResults : public testing::Test {
 protected:
  UntrustedResults() {
    for (const fs::path& folder : {dir / "monitors", dir / "pictures/vtkmodules"}) fs::create_directories(folder);
    write("summary.json", R"({"case": "<script>alert(1)</script>", "exit": 0, "simulated_s": 1, "time_steps": 2})");
    fs::current_path(dir);
  }
  ~UntrustedResults() override {
    fs::current_path(before);
    fs::remove_all(root);
  }
  void write(const fs::path& file, const std::string& content) const { std::ofstream(dir / file) << content; }
  /// The message of the refusal.
  std::string refusal() const {
    try {
      write_report(dir);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::io);
      return error.what();
    }
    return "";
  }

  const fs::path before = fs::current_path();
  const fs::path root = fs::temp_directory_path() / ("snag_untrusted_" + std::to_string(getpid())), dir = root / "results",
                 outside = root / "outside.txt";
};

// Modules that python would find before its own, in the folder of the script and in the working directory.
TEST_F(UntrustedResults, ModulesInTheResultsAreNotRun) {
  const std::string attack = "open('" + outside.string() + "', 'a').write(__name__)\n";
  for (const char* folder : {"", "pictures/"})
    for (const char* module : {"numpy.py", "json.py", "argparse.py", "sitecustomize.py", "usercustomize.py"})
      write(fs::path(folder) / module, attack);
  write("pictures/vtkmodules/__init__.py", attack);
  write_report(dir);
  EXPECT_FALSE(fs::exists(outside)) << file_text(outside).value_or("");
}

TEST_F(UntrustedResults, LinksOutOfTheFolderAreRefused) {
  std::ofstream(outside) << "mine";
  for (const char* link : {"report.html", "report.html.tmp", "log.txt", "monitors/pump.csv", "pictures/render.log"}) {
    fs::create_symlink(outside, dir / link);
    EXPECT_NE(refusal().find(shortened((dir / link).string()) + ": is a symbolic link to " + shortened(outside.string())),
              std::string::npos);
    fs::remove(dir / link);
  }
  fs::remove_all(dir / "pictures");
  fs::create_directory_symlink(root, dir / "pictures");
  EXPECT_NE(refusal().find("symbolic link"), std::string::npos);
  EXPECT_EQ(file_text(outside), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(root), fs::directory_iterator{}), 2) << "nothing is written beside the results";
}

TEST_F(UntrustedResults, NamesAreShownAsText) {
  Series patches("monitors/patches.csv", {"time [s]", "<script>alert(2)</script>_flow [m3/s]", "a,\"b\"_flow [m3/s]"});
  patches.add({0, 1, 2}), patches.add({1, 2, 1});
  Series pump("monitors/pump.csv", {"time [s]", "<script>alert(3)</script> [m]"});
  pump.add({0, 1});
  write_report(dir);
  const std::string page = file_text(dir / "report.html").value_or("");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(2)"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(3)"), std::string::npos);
  EXPECT_NE(page.find("a,&quot;b&quot;"), std::string::npos) << "a column with a comma and quotes stays one column";
}

// A section whose values no run writes has a sentence about that, and the others are there.
TEST_F(UntrustedResults, ForeignValuesCostTheirSection) {
  for (const char* found : {"{}", R"({"step_s": "x"})", R"({"step_s": 1, "degrees_per_step": 2, "accuracy": null, "notes": 5})", "7"}) {
    write("summary.json", R"({"case": "x", "exit": 0, "simulated_s": 1, "time_steps": 2, "auto_step": )" + std::string(found) + "}");
    write_report(dir);
    const std::string page = file_text(dir / "report.html").value_or("");
    EXPECT_NE(page.find("<h2>Run summary</h2>"), std::string::npos) << found;
    EXPECT_NE(page.find("<h2>Time step</h2>"), std::string::npos) << found;
  }
  write("summary.json", R"({"case": "x", "auto_step": {}})");
  write_report(dir);
  EXPECT_NE(file_text(dir / "report.html").value_or("").find("The choice of the time step cannot be shown: summary.json has other values"),
            std::string::npos);
}

}  // namespace
}  // namespace snag
