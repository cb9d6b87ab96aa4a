#pragma once
// Passage of a rag through the volute: from the summary of a run, and from pictures, by the same rules
// (observe/passage/passage_tracker.hpp).
//
// In a picture a pixel of cloth counts as a particle. The rag is in the casing as soon as it is seen; it touches the tongue when cloth is
// seen nearer to it than tongue_reach; it is out when all of it is beyond the outlet, or when it was mostly in the discharge and is seen no
// more. Contact with the impeller cannot be seen.
#include <filesystem>
#include <vector>

#include "observe/blobs.hpp"
#include "observe/passage/passage_geometry.hpp"
#include "observe/passage/passage_tracker.hpp"
#include "observe/volute_histogram.hpp"

namespace snag {

class VoluteWatch {
 public:
  /// Of a camera with [pump_in_picture]. Throws Error(usage) on a view that is none of a pump.
  explicit VoluteWatch(const Camera& camera);
  /// The blobs of one picture, largest first, at `time`, s; `step`: since the last picture.
  void add(const std::vector<Blob>& blobs, double time, double step);
  VoluteHistogram histogram() const;

 private:
  RagSnapshot sighting(const Blob& blob) const;

  PassageGeometry geometry_;
  PassageTracker tracker_;
  RagSnapshot last_;
};

/// Of all rags of a run: from its summary.json, empty if it has none or was made without [rag_passage]. Throws Error(io) on a broken one.
VoluteHistogram volute_of_run(const std::filesystem::path& run);

}  // namespace snag
