#pragma once
// Narrow gaps between the walls of a case against the thickness of its cloth in contacts, in words.
#include <string>
#include <vector>

#include "dem/contacts/contact_settings.hpp"
#include "dem/particles/rag.hpp"
#include "dem/walls/walls.hpp"

namespace snag {

/// A line for each gap that is narrower than the lattice spacing of some piece, the narrowest few, and one for each piece that a wall at
/// the impact speed would press in by more than half its contact thickness. `time`: of the walls, s.
std::vector<std::string> gap_lines(const WallSet& walls, const std::vector<Rag>& rags, const ContactSettings& contacts, double time);

}  // namespace snag
