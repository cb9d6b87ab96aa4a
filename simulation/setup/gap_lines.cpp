#include "simulation/setup/gap_lines.hpp"

#include <algorithm>

#include "base/words.hpp"
#include "dem/contacts/contact_pair.hpp"
#include "dem/walls/wall_gaps.hpp"

namespace snag {

namespace {

constexpr std::size_t most_gaps = 5;  // that are listed

std::string mm(double length) { return rounded(1e3 * length) + " mm"; }

/// Pieces of the same thickness share a line: the first of each.
std::vector<const Rag*> kinds_of(const std::vector<Rag>& rags) {
  std::vector<const Rag*> kinds;
  for (const Rag& rag : rags)
    if (std::none_of(kinds.begin(), kinds.end(), [&](const Rag* other) {
          return other->wall_reach() == rag.wall_reach() && other->radius == rag.radius && other->mass == rag.mass;
        }))
      kinds.push_back(&rag);
  return kinds;
}

}  // namespace

std::vector<std::string> gap_lines(const WallSet& walls, const std::vector<Rag>& rags, const ContactSettings& contacts, double time) {
  std::vector<std::string> lines;
  if (walls.empty() || rags.empty()) return lines;
  const std::vector<const Rag*> kinds = kinds_of(rags);
  double widest = 0;
  for (const Rag* rag : kinds) widest = std::max(widest, 2 * rag->radius);
  const std::vector<WallGap> gaps = narrow_gaps(walls, time, widest);
  for (std::size_t i = 0; i < gaps.size() && i < most_gaps; ++i) {
    const WallGap& gap = gaps[i];
    const auto name = [&](int part) { return walls.parts()[static_cast<std::size_t>(part)]; };
    std::string line = "gap of " + mm(gap.width) + " between " + name(gap.part_1) +
                       (gap.part_1 == gap.part_2 ? " and itself" : " and " + name(gap.part_2)) + ":";
    for (const Rag* rag : kinds) {
      const double thickness = 2 * rag->wall_reach();
      line += " " + rounded(gap.width / thickness) + " of the contact thickness of " + rag->name + ", " + mm(thickness) +
              (gap.width > thickness ? ", which enters it;" : ", which cannot enter it;");
    }
    line.back() = '.';
    if (std::any_of(kinds.begin(), kinds.end(),
                    [&](const Rag* rag) { return rag->contact_thickness <= 0 && gap.width <= 2 * rag->radius; }))
      line += " Without contact_thickness cloth is as thick as its particles";
    lines.push_back(line);
  }
  for (const Rag* rag : kinds) {
    if (rag->contact_thickness <= 0) continue;
    const double deepest = wall_pair(*rag, contacts).law->deepest_overlap(contacts.impact_speed), half = rag->wall_reach();
    if (deepest > half)
      lines.push_back("an impact at [contact] impact_speed = " + number_text(contacts.impact_speed) + " m/s presses " + rag->name +
                      " into a wall by " + mm(deepest) + ", more than half its contact_thickness, " + mm(half) +
                      ": raise [contact] wall_stiffness_factor");
  }
  return lines;
}

}  // namespace snag
