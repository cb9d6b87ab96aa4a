#include "app/build_info.hpp"

#include <hdf5.h>
#include <mpi.h>
#include <petscsys.h>
#include <zlib.h>

#include <openssl/crypto.h>
#include <Eigen/Core>
#include <boost/version.hpp>
#include <sstream>

#ifdef PETSC_HAVE_HYPRE
#include <hypre/HYPRE_config.h>
#endif

#include "base/version.hpp"

namespace snag {

namespace {

/// "Open MPI v4.1.4" of the first words that MPI says of itself; the rest is the packager's.
std::string mpi_library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string whole(text, static_cast<std::size_t>(length));
  return whole.substr(0, whole.find_first_of(",\n"));
}

std::string petsc() {
  PetscInt major = 0, minor = 0, subminor = 0;
  PetscGetVersionNumber(&major, &minor, &subminor, nullptr);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(subminor);
}

std::string hdf5() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

}  // namespace

std::string build_info() {
  std::ostringstream text;
  text << "snag " << version_number << " " << version_git << "\n" << version_build << "\n";
  text << "MPI: " << mpi_library() << "\nPETSc: " << petsc();
#ifdef PETSC_HAVE_HYPRE
  text << "\nhypre: " << HYPRE_RELEASE_VERSION;
#else
  text << "\nhypre: not in this PETSc";
#endif
  text << "\nHDF5: " << hdf5() << "\nEigen: " << EIGEN_WORLD_VERSION << "." << EIGEN_MAJOR_VERSION << "." << EIGEN_MINOR_VERSION;
  text << "\nBoost: " << BOOST_VERSION / 100000 << "." << BOOST_VERSION / 100 % 1000 << "." << BOOST_VERSION % 100;
  text << "\nOpenSSL: " << OpenSSL_version(OPENSSL_VERSION) << "\nzlib: " << zlibVersion();
  return text.str();
}

}  // namespace snag
