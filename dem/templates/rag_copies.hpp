#pragma once
// Many equal pieces from one table of the case file: a row of copies, put in at once or one after the other, at given places or at a patch
// through which they are released.
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "dem/templates/lattice.hpp"

namespace snag {

/// Keys of [[rag]], [[disc]], [[fibre]] and [[particle]].
struct RagCopies {
  int count = 1;
  Vec3 step;            // from the centre of one to that of the next, m
  double interval = 0;  // each is put in this much later than the one before, s
  int poses = 1;        // that differ: by the seed of the pose, taken in turn
  ReleasePlan release;

  std::vector<Parameter> parameters();
};

/// The copies of a piece, itself the first; named "NAME 1", "NAME 2" ... if there are several and it has a name. Throws Error(usage).
std::vector<RagPiece> copies_of(const RagPiece& piece, const RagCopies& copies, const std::string& where);

/// A number in [0, 1) that depends on seed and index alone: the share of the patch's area below which the face lies where copy `index` is
/// released.
double release_share(int seed, int index);

}  // namespace snag
