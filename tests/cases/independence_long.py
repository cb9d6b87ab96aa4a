# labels: long
# timeout: 7200
# cost: 900
"""Requirement: independence.py for particles of 1 to 4 mm, cells down to a third and steps down to a quarter; the published forces are shown with them."""
import harness
from independence import Independence


class IndependenceLong(Independence):
    def test_recommended_forces(self):
        for piece in ("free", "held"):
            for setting in (*(f"rag.0.radius_mm={radius}" for radius in (1, 1.5, 2.5, 4)), "mesh.parameters='channel-half.toml'", "mesh.parameters='channel-third.toml'",
                            "time.step_ms=2", "time.step_ms=1"):
                self.assert_independent(piece, setting)

    def test_published_forces(self):
        for piece in ("free", "held"):
            for radius in (1, 1.5, 2, 2.5, 4):
                found = self.result(piece, "coupling.forces=['published']", f"rag.0.radius_mm={radius}")
                print(f"  {piece}, published forces, particles of {radius} mm: " + ", ".join(f"{name} {value:.4g}" for name, value in found.items()), flush=True)


if __name__ == "__main__":
    harness.main()
