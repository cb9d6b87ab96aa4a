# labels: long
# timeout: 600
"""Requirement: the Debian package that cpack makes depends on the libraries of its programs, and Snag works from it in any folder."""
import re

import harness
from installed import Installation


class DebianPackage(Installation):
    def test_package(self):
        # The package of a build for one machine says so in its name; the list of libraries it depends on comes from its programs.
        self.call("cpack", "--config", harness.BINARY_DIR / "CPackConfig.cmake", "-G", "DEB", "-B", self.work / "pack")
        (package,) = (self.work / "pack").glob("*.deb")
        native = "SNAG_NATIVE:BOOL=ON" in (harness.BINARY_DIR / "CMakeCache.txt").read_text()
        self.assertRegex(package.name, rf"^snag_{re.escape(self.version())}-1{'native' if native else ''}_\w+\.deb$")
        depends = self.call("dpkg-deb", "-f", package, "Depends")
        for library in ("libpetsc-real3.18", "libgmsh4.8", "openmpi-bin"):
            self.assertIn(library, depends)
        self.call("dpkg-deb", "-x", package, self.work / "root")
        self.works(self.work / "root" / "usr")


if __name__ == "__main__":
    harness.main()
