# timeout: 600
# cost: 22
"""Requirement: with the recommended forces and the kernel width that a case gets by itself, drag and strain of a held rag and motion and path of a free one depend by less than 3 %
on the size of the particles, on the cells and on the step."""
import harness
import numpy

FOLDER = harness.SOURCE_DIR / "cases" / "study-independence"
LIMIT = 0.03
SMALL_STRAIN = 1e-4  # of a free rag, which hardly strains: no percentage of it is a result


class Independence(harness.CaseTest):
    def result(self, piece, *settings):
        """What a run of free.toml or held.toml gives; {name: value}."""
        words = [word for s in settings for word in ("--set", s)]
        run = self.run_once(FOLDER / f"{piece}.toml", 1, *words, name=f"{piece} {' '.join(settings)}".replace("/", "-"))
        self.assertFalse([line for line in run.messages if "kernel_width" in line], "the width fits particles and cells")
        self.assertEqual(run.summary["coupling"]["kernel_width_m"], 0.006)
        rags = run.monitor("rags")
        time, strain = rags.column("time"), rags.column("bond_strain_p99")
        if piece == "free":
            self.assertLess(strain.max(), SMALL_STRAIN)
            return {"speed at 16 ms": numpy.interp(0.016, time, rags.column("vx")), "path": run.summary["rags"][0]["before_contact"]["path_m"]}
        late = time > 0.6 * time[-1]
        return {"drag": run.monitor("coupling").column("force_on_rags_x")[late].mean(), "strain": strain[late].mean()}

    def deviations(self, piece, *settings):
        """From the case as it stands; printed."""
        standard, changed = self.result(piece), self.result(piece, *settings)
        deviation = {name: changed[name] / standard[name] - 1 for name in standard}
        print(f"  {piece}, {', '.join(settings)}: " + ", ".join(f"{name} {100 * d:+.1f} %" for name, d in deviation.items()), flush=True)
        return deviation

    def assert_independent(self, piece, *settings):
        with self.subTest(piece=piece, settings=settings):
            self.assertLess(max(map(abs, self.deviations(piece, *settings).values())), LIMIT)


class IndependenceOfParticles(Independence):
    def test_size_of_the_particles(self):
        for piece in ("free", "held"):
            for radius in (1.5, 4):
                self.assert_independent(piece, f"rag.0.radius_mm={radius}")

    def test_step(self):
        self.assert_independent("free", "time.step_ms=2")
        self.assert_independent("held", "time.step_ms=2")

    def test_published_forces_depend_on_the_particles(self):
        """Drag of free spheres: the reason for the recommended set."""
        published = "coupling.forces=['published']"
        drag = [self.result("held", published, f"rag.0.radius_mm={radius}")["drag"] for radius in (1.5, 4)]
        print(f"  held, published forces, particles of 1.5 and 4 mm: drag {drag[0]:.2f} and {drag[1]:.2f} N")
        self.assertGreater(drag[0] / drag[1], 1.3)


if __name__ == "__main__":
    harness.main()
