#pragma once
// Poses of a sheet that does not fit flat into a pipe: a run of the particles alone, with their bonds, contacts with each other and a
// smooth wall, before the run that the case asks for.
//
// confined  A pipe that just holds the flat sheet closes in until it has the radius (and between its ends the length) that is asked for,
//           then stands still until the sheet is at rest. Where this crushes the sheet, or it does not come to rest, the run is repeated
//           with half the closing speed, up to three times.
// hopper    The flat sheet is let go above a cone that leads into the pipe and falls in; ends as soon as all of it is in the pipe.
//           Jensen (2018) section 5.2.2.
//
// The sheet begins with a slow motion along its normal, eight plane waves with amplitudes and phases from the seed: it decides which way
// the sheet buckles. The pipe's axis goes through the piece's `centre`; where the pipe has no ends the mean of the particles along it is at
// the centre. Speeds and damping of this run are no physics of the case: the pose is a sheet at rest, bent and pushed by a pipe, of which
// there are many.
#include <mpi.h>

#include <string>
#include <vector>

#include "dem/contacts/contact_settings.hpp"
#include "dem/templates/lattice.hpp"

namespace snag {

struct CrumpledPose {
  std::vector<ParticlePose> poses;  // about the piece's centre
  double duration = 0;              // of the run, s
  double strain_p99 = 0;            // of the bonds' magnitudes of strain
  double overlap_over_radius = 0;   // largest at the end, of particles with each other
  int attempts = 1;                 // the last of them gave the pose
  double closing_speed = 0;         // of its pipe, m/s
};

/// The run for one piece, on this rank alone; the same bits for the same piece, contacts and seed. `contacts` are those of the case;
/// contacts between particles are always on. Throws Error(usage) if the pipe cannot hold the cloth, or it does not come to rest in it.
CrumpledPose crumple(const RagPiece& piece, const ContactSettings& contacts);

/// Makes the poses of all pieces that are to be crumpled and have none: on rank 0, the same bits everywhere. Returns a line for the log for
/// each; that of rank 0 counts. Collective; throws Error(usage).
std::vector<std::string> make_poses(MPI_Comm comm, std::vector<RagPiece>& pieces, const ContactSettings& contacts);

}  // namespace snag
