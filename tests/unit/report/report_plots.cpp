// Plots of a report: every value has its place, extremes survive thinning, and what cannot be drawn is said.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <set>

#include "report/html.hpp"
#include "report/line_plot.hpp"
#include "report/monitor_plots.hpp"

namespace snag {
namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A line from corner to corner of its data ends in the corners of the frame.
TEST(LinePlotFigure, PlacesValuesInTheFrame) {
  const auto html = figure({"title", "time [s]", "head [m]", {{"", {0, 10}, {2, 4}}}});
  EXPECT_TRUE(holds(html, "d=\"M64.0 212.5L468.0 25.5\"")) << html;  // 4 % of the data is left free above and below: 202 pixels for 1.08
  EXPECT_TRUE(holds(html, "time [s]") && holds(html, "head [m]"));
}

// Among a hundred thousand values one spike stays visible, and the page stays small.
TEST(LinePlotFigure, KeepsExtremesOfLongLines) {
  LinePlot plot{"", "", "", {{"", {}, {}}}};
  for (int i = 0; i < 100000; ++i) {
    plot.lines[0].x.push_back(i);
    plot.lines[0].y.push_back(i == 77777 ? 900 : 1 + 0.1 * std::sin(i));
  }
  const auto html = figure(plot);
  EXPECT_LT(html.size(), 30000u);
  EXPECT_TRUE(holds(html, " 25.5L")) << "the spike reaches the top";
}

// A logarithmic axis spans whole decades; values that have no place on it leave a gap and are counted.
TEST(LinePlotFigure, CountsWhatALogarithmicAxisCannotShow) {
  EXPECT_DOUBLE_EQ(decades({"", "", "", {{"", {0, 1}, {1e-6, 1}}}}), 6);
  EXPECT_DOUBLE_EQ(decades({"", "", "", {{"", {0, 1, 2}, {10, 0, 1000}}}}), 2);
  EXPECT_LT(decades({"", "", "", {{"", {0, 1, 2}, {1e-6, 1, -1e-9}}}}), 0);
  EXPECT_LT(decades({"", "", "", {{"", {0, 1}, {0, 0}}}}), 0);
  const auto html = figure({"", "", "", {{"", {0, 1, 2, 3}, {1e-6, 0, 1, NAN}}}, true});
  EXPECT_TRUE(holds(html, "1 non-positive values are omitted")) << html;
  EXPECT_TRUE(holds(html, "1 values are not finite")) << html;
  EXPECT_TRUE(holds(html, "d=\"M64.0 220.0M")) << "a gap, not a line across it: " << html;
}

// Very small and very large numbers share one power of ten above the axis.
TEST(LinePlotFigure, FactorsOutAPowerOfTen) {
  const auto html = figure({"", "", "", {{"", {0, 1}, {1e-6, 4e-6}}}});
  EXPECT_TRUE(holds(html, ">× 10<tspan dy=\"-5\" font-size=\"8\">-6<")) << html;
  EXPECT_TRUE(holds(html, ">3</text>")) << html;
}

// A constant, a single value and no value at all are drawn without a division by zero.
TEST(LinePlotFigure, DrawsDegenerateLines) {
  for (const std::vector<double>& y : {std::vector<double>{5, 5}, {0, 0}, {1e-300, 1e-300}, {NAN, NAN}, {7}, {}}) {
    const auto html = figure({"", "", "", {{"", std::vector<double>(y.size(), 1.0), y}}});
    EXPECT_FALSE(holds(html, "nan\"") || holds(html, "inf") || holds(html, "nan ") || holds(html, "-nan")) << html;
  }
}

// A band fills what lies between its curves and takes part in the axis; where a logarithmic axis has no place for it, it ends at the frame.
TEST(LinePlotFigure, FillsBands) {
  LinePlot plot{"", "", "", {{"median", {0, 10}, {2, 2}}}};
  plot.bands = {{"to the largest", {0, 10}, {2, 2}, {4, 4}}};
  const auto html = figure(plot);
  EXPECT_TRUE(holds(html, "d=\"M64.0 25.5L468.0 25.5L468.0 212.5L64.0 212.5Z\"")) << html;
  EXPECT_TRUE(holds(html, "█</b> to the largest"));
  plot.logarithmic = true;
  plot.bands[0].low = {0, 0}, plot.bands[0].high = {10, 10};
  EXPECT_TRUE(holds(figure(plot), "d=\"M64.0 18.0L468.0 18.0L468.0 220.0L64.0 220.0Z\"")) << figure(plot);
  plot.bands[0] = {"", {}, {}, {}};
  EXPECT_FALSE(holds(figure(plot), "Z\""));
}

// Events are upright lines with letters that the legend explains, levels carry their names; what lies outside the plot is not drawn.
TEST(LinePlotFigure, MarksEventsAndLevels) {
  LinePlot plot{"", "", "", {{"", {0, 10}, {2, 4}}}};
  plot.marks = {{5, "entered"}, {50, "exited"}, {6, "tongue", true}};
  plot.spans = {{-3, 5, "inside"}, {20, 30, "outside"}};
  const auto html = figure(plot);
  EXPECT_TRUE(holds(html, "<line x1=\"266.0\" y1=\"18.0\" x2=\"266.0\" y2=\"220.0\"")) << html;
  EXPECT_TRUE(holds(html, ">a</text>") && holds(html, "<b>a</b> entered") && holds(html, "<b>b</b> exited"));
  EXPECT_FALSE(holds(html, ">b</text>"));
  EXPECT_TRUE(holds(html, ">tongue</text>") && !holds(html, "</b> tongue"));
  EXPECT_TRUE(holds(html, "<rect x=\"64.0\" y=\"18\" width=\"202.0\"")) << html;
  EXPECT_TRUE(holds(html, "M64.0 212.5L468.0 119.0")) << "the level is inside the plot: " << html;
}

// The axis of y spans what follows the start-up: the rest is cut at the frame, and the page says how much that is.
TEST(LinePlotFigure, ScalesToWhatFollowsTheStartUp) {
  LinePlot plot{"", "time [s]", "", {{"", {0, 1, 2, 3}, {-27, 16, 2, 4}}}};
  plot.scale_from = 2;
  const auto html = figure(plot);
  EXPECT_TRUE(holds(html, "L333.3 212.5L468.0 25.5\"")) << "2 and 4 span the axis: " << html;
  EXPECT_TRUE(holds(html, "clip-path=\"url(#frame)\"")) << html;
  EXPECT_TRUE(holds(html, "2 values up to 1 s lie outside it, between -27 and 16")) << html;
}

// Turns of a path are one line with gaps: one colour, one entry in the legend; given ticks span the axis.
TEST(LinePlotFigure, ContinuesALineAfterAGap) {
  LinePlot plot{"", "", "", {{"path", {300, 360}, {1, 2}}, {"path", {0, 60}, {2, 3}}, {"means", {10, 30}, {2, 2}}}};
  plot.lines[1].continues = true;
  plot.x_ticks = {0, 180, 360};
  const auto html = figure(plot);
  EXPECT_EQ(html.find("━</b> path"), html.rfind("━</b> path"));
  EXPECT_TRUE(holds(html, "━</b> means"));
  EXPECT_TRUE(holds(html, "L468.0 119.0\" fill=\"none\" stroke=\"#0072B2\"")) << html;
  EXPECT_TRUE(holds(html, "M64.0 119.0L131.3 25.5\" fill=\"none\" stroke=\"#0072B2\"")) << html;
  EXPECT_TRUE(holds(html, ">180</text>"));
}

/// A folder of monitors that is gone at the end.
struct Monitors {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("snag_monitor_plots_" + std::to_string(getpid()));
  Monitors() { std::filesystem::create_directories(folder); }
  ~Monitors() { std::filesystem::remove_all(folder); }
  void write(const char* name, const char* text) const { std::ofstream(folder / name) << text; }
};

// Known columns come under plain titles, vectors share a plot, each rag is a line, and every other column is shown as well.
TEST(MonitorPlots, ShowEveryColumn) {
  const Monitors monitors;
  monitors.write("rags.csv", "time [s],rag [1],x [m],y [m],z [m],own [1]\n0,0,1,2,3,4\n0,5,1,2,3,4\n1,0,1,2,3,4\n1,5,1,2,3,9\n");
  monitors.write("probe.csv", "time [s],time_step [1],u_x [m/s],u_y [m/s],u_z [m/s],p [Pa]\n0,1,1,2,3,4\n1,2,1,2,3,5\n");
  monitors.write("patches.csv", "time [s],in_flow [m3/s],in_pressure [Pa],out_flow [m3/s],out_pressure [Pa]\n0,1,2,3,4\n");
  monitors.write("empty.csv", "time [s],a [1]\n");
  const auto found = monitor_plots(monitors.folder);
  std::vector<std::string> titles;
  for (const auto& plot : found.plots) titles.push_back(plot.title + "|" + plot.y_label + "|" + std::to_string(plot.lines.size()));
  EXPECT_EQ(titles, (std::vector<std::string>{"Centroid of the rag|[m]|6", "Flow rate through each part of the boundary|[m3/s]|2",
                                              "Mean pressure on each part of the boundary|[Pa]|2", "probe: u|u [m/s]|3",
                                              "probe: p|p [Pa]|1", "rags: own|own|2"}));
  EXPECT_EQ(found.plots.back().lines[1].label, "rag 5");
  EXPECT_EQ(found.plots.back().lines[1].y, (std::vector<double>{4, 9}));
  EXPECT_EQ(found.problems, std::vector<std::string>{"empty.csv holds no record"});
  EXPECT_TRUE(monitor_plots(monitors.folder / "absent").plots.empty());
}

// Where the pump's start-up ends is read from the revolutions; lines have titles, not names of columns.
TEST(MonitorPlots, LeaveTheStartUpOutOfTheScale) {
  const Monitors monitors;
  monitors.write("pump.csv", "time [s],head [m],head_total [m]\n0,-27,-20\n1,16,17\n2,3,4\n3,4,5\n");
  monitors.write("revolutions.csv", "time [s],revolution [1],start_up [1]\n1.5,1,1\n2.5,2,0\n");
  const auto found = monitor_plots(monitors.folder);
  ASSERT_EQ(found.plots.size(), 1u);
  EXPECT_EQ(found.plots[0].scale_from, 1.5);
  EXPECT_EQ(found.plots[0].lines[0].label, "mean pressures and velocities");
  EXPECT_EQ(found.plots[0].lines[1].label, "total pressure, weighted with the flux");
}

// A column of the balance keeps its whole name in the legend: the pressure part of a loss is not the loss.
TEST(MonitorPlots, NameThePartsOfTheBalance) {
  const Monitors monitors;
  monitors.write("balance.csv",
                 "time [s],rotor_lost [N m],rotor_lost_pressure [N m],numerical [W],numerical_pressure [W]\n0,1,2,3,4\n1,2,3,4,5\n");
  std::set<std::string> titles;
  for (const auto& plot : monitor_plots(monitors.folder).plots)
    for (const auto& line : plot.lines) titles.insert(line.label.empty() ? plot.y_label : line.label);
  EXPECT_EQ(titles, (std::set<std::string>{"rotor lost [N m]", "rotor lost pressure [N m]", "numerical [W]", "numerical pressure [W]"}));
}

// What never changes is a number, not a plot; columns of different units never share an axis.
TEST(MonitorPlots, KeepConstantsAndUnitsApart) {
  const Monitors monitors;
  monitors.write("rags.csv", "time [s],rag [1],broken_bonds [1],x [m],y [cm]\n0,0,0,1,2\n1,0,0,2,3\n");
  const auto found = monitor_plots(monitors.folder);
  ASSERT_EQ(found.constants.size(), 1u);
  EXPECT_EQ(found.constants[0], (std::pair<std::string, double>{"Broken bonds", 0}));
  ASSERT_EQ(found.plots.size(), 2u);
  EXPECT_EQ(found.plots[0].y_label, "x [m]");
  EXPECT_EQ(found.plots[1].y_label, "y [cm]");
}

// Columns that another section shows are left out, the others of their monitor stay.
TEST(MonitorPlots, LeaveOutWhatIsShownElsewhere) {
  const Monitors monitors;
  monitors.write("passage.csv", "time [s],rag [1],radius [m],own [m]\n0,0,1,2\n1,0,2,3\n");
  const auto found = monitor_plots(monitors.folder, {{"passage", {"radius"}}, {"absent", {"a"}}});
  ASSERT_EQ(found.plots.size(), 1u);
  EXPECT_EQ(found.plots[0].title, "passage: own");
}

// Residuals and relative errors are read by their order of magnitude; forces and seconds never are.
TEST(MonitorPlots, UseLogarithmsForWhatShouldBeSmall) {
  const Monitors monitors;
  monitors.write(
      "coupling.csv",
      "time [s],momentum_exchange_rel [1],loss_rel [1],flow_s [s],ratio [1],small [1]\n0,1e-14,-1,1e-6,1e-6,1\n1,2e-14,1,9,9,2\n");
  std::vector<bool> logarithmic;
  for (const auto& plot : monitor_plots(monitors.folder).plots) logarithmic.push_back(plot.logarithmic);
  EXPECT_EQ(logarithmic, (std::vector<bool>{true, false, false, true, false}));
}

// Numbers are written for people: four digits, powers of ten where needed, thin spaces between thousands.
TEST(ReportNumbers, AreReadable) {
  EXPECT_EQ(html::number(0.123456), "0.1235");
  EXPECT_EQ(html::number(-1.2e-5), "-1.2 × 10<sup>−5</sup>");
  EXPECT_EQ(html::number(3.5e7), "3.5 × 10<sup>7</sup>");
  EXPECT_EQ(html::number(0), "0");
  EXPECT_EQ(html::number(1e-12), "10<sup>−12</sup>");
  EXPECT_EQ(html::number(NAN), "not a number");
  EXPECT_EQ(html::count(-1234567), "-1\u2009234\u2009567");
  EXPECT_EQ(html::count(999), "999");
  EXPECT_EQ(html::bytes(310e6), "310 MB");
}

}  // namespace
}  // namespace snag
