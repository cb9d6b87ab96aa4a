#pragma once
// Textile passport: properties of the bonds of one cloth at some particle radii, as calibrated. `snag calibrate` writes it, a case names
// it.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/particles/rag.hpp"

namespace snag {

/// Bonds at one particle radius: [0] lengthwise, [1] crosswise.
struct PassportEntry {
  double radius = 0;  // m
  std::array<BondProperties, 2> bond{};
};

struct Passport {
  std::string name;                    // for messages
  std::vector<PassportEntry> entries;  // radii rising

  /// Bonds at a radius of the passport, as they stand; between two of them straight lines in the logarithms (S_n goes as r^-2). A property
  /// that is zero at one of the two is zero between them. Throws Error(usage) naming the radii outside of them.
  BondProperties bond(double radius, int direction) const;
};

/// Throws Error(usage, io) if the file is none, or lacks a direction at one of its radii.
Passport read_passport(const std::filesystem::path& file);

}  // namespace snag
