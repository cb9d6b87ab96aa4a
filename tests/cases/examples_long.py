# labels: long
# timeout: 1200
"""Requirement: examples.py, with the meshes of all cases as they stand."""
import examples
import harness


class AllMeshes(examples.Examples):
    medium_mesh = True


del examples.Examples

if __name__ == "__main__":
    harness.main()
