#include "report/page.hpp"

namespace snag {

const std::string_view report_style = R"css(
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, "DejaVu Sans", Helvetica, Arial, sans-serif; color: #1c2430; background: #fff; max-width: 1040px; margin: 0 auto; padding: 24px; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 1.2rem; margin: 34px 0 10px; padding-bottom: 4px; border-bottom: 2px solid #0072b2; }
.origin { color: #596575; margin: 0 0 18px; }
.outcome { font-size: 1.1rem; background: #eef5fb; border-left: 5px solid #0072b2; padding: 12px 16px; margin: 0; }
.outcome.bad { background: #fdf0ea; border-color: #d55e00; }
.problem { background: #fff6e5; border-left: 5px solid #e69f00; padding: 8px 14px; margin: 10px 0; overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; margin: 8px 0; font-size: 0.93rem; }
th, td { text-align: left; vertical-align: top; padding: 5px 12px 5px 0; border-bottom: 1px solid #dde3ea; overflow-wrap: anywhere; }
th { color: #596575; font-weight: 600; }
td { font-variant-numeric: tabular-nums; } td:first-child:nth-last-child(-n+3) { width: 60%; } sup { line-height: 0; }
.pass { color: #00734f; font-weight: 700; } .fail { color: #b3400e; font-weight: 700; } .idle { color: #596575; }
.pictures, .plots { display: grid; gap: 14px; }
.pictures { grid-template-columns: repeat(3, 1fr); } .plots { grid-template-columns: repeat(2, 1fr); }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; border: 1px solid #dde3ea; display: block; }
figure.wide { margin: 14px 0; }
figure.scale { margin: 10px auto; max-width: 760px; } figure.scale img { border: 0; }
figure.path { margin: 14px auto; max-width: 560px; }
figcaption { font-size: 0.88rem; color: #3a4656; padding: 3px 0; }
.plot figcaption { font-weight: 600; color: #1c2430; }
svg { width: 100%; height: auto; display: block; font: 11px system-ui, "DejaVu Sans", Arial, sans-serif; fill: #3a4656; }
.grid { stroke: #e6eaef; stroke-width: 1; }
.legend { font-size: 0.8rem; color: #3a4656; line-height: 1.35; } .legend span { margin-right: 12px; white-space: nowrap; }
.note { font-size: 0.8rem; color: #8a5a00; }
.shares { display: flex; height: 26px; margin: 8px 0; border-radius: 3px; overflow: hidden; }
.shares div { color: #fff; font-size: 0.78rem; line-height: 26px; padding-left: 6px; white-space: nowrap; overflow: hidden; print-color-adjust: exact; }
pre { background: #f5f7f9; padding: 12px; font-size: 0.82rem; line-height: 1.4; overflow-x: auto; white-space: pre-wrap; overflow-wrap: anywhere; }
summary { cursor: pointer; color: #0072b2; margin: 8px 0; }
@media (max-width: 700px) { .pictures, .plots { grid-template-columns: 1fr; } }
@media print { body { font-size: 11px; max-width: none; padding: 0; } h2 { break-after: avoid; } details:not([open]) { display: none; } tr { break-inside: avoid; } }
)css";

std::string section(const std::string& heading, const std::string& content) {
  return content.empty() ? "" : "<section>\n<h2>" + heading + "</h2>\n" + content + "</section>\n";
}

}  // namespace snag
