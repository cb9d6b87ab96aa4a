#pragma once
// Poses that are made for a run: made once, described in the log, and stored with the results for other runs and for a resume.
#include <mpi.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dem/contacts/contact_settings.hpp"
#include "dem/templates/lattice.hpp"

namespace snag {

class CheckpointReader;
class CheckpointWriter;

/// Poses that were made before in this process, by the text of all that decides about them.
using MadePoses = std::map<std::string, std::vector<ParticlePose>>;

class RagPoses {
 public:
  /// Makes the poses that take a run of their own, or reads them from the checkpoint `stored` of the run that is resumed (null: there is
  /// none). `made` (null: none) has those of earlier runs, and gets the new ones; `text` is all that the case says of pieces and contacts.
  /// Collective; throws Error(usage, io).
  RagPoses(MPI_Comm comm, std::vector<RagPiece>& pieces, const ContactSettings& contacts, CheckpointReader* stored,
           MadePoses* made = nullptr, const std::string& text = {});

  /// How each pose was made, and what a camera beside the pipe sees of it, for the log.
  const std::vector<std::string>& lines() const { return lines_; }
  /// pose_<number of the piece, from 0>.csv for each piece that does not lie flat. Rank 0 only; throws Error(io).
  void write(const std::filesystem::path& folder) const;
  /// The poses that took a run of their own. Collective.
  void save(CheckpointWriter& writer) const;

 private:
  std::vector<std::string> lines_;
  std::vector<RagPiece> pieces_;  // those that do not lie flat
  std::vector<std::size_t> numbers_;
};

}  // namespace snag
