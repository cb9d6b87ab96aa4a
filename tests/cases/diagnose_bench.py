"""The blind benchmark of the diagnosis at its full size: 390 spheres and 60 of another seed, 390 fibres, 120 rags at level L2; no score below what chance allows if its target holds."""
# labels: long
# timeout: 36000
import harness
from diagnose import assert_no_score_is_worse_than_chance


class Benchmark(harness.CaseTest):
    def score(self, twin, n, seed=402):
        folder = harness.BINARY_DIR / "diagnose-bench" / f"{twin}-{seed}"  # kept: a run that was stopped goes on
        run = harness.snag(["diagnose", "--bench", "L2", "--twin", twin, "--n", n, "--seed", seed, "--out", folder], 2, folder, timeout=36000)
        self.assertEqual(run.code, 0, run.tail())
        print(run.stdout)
        assert_no_score_is_worse_than_chance(self, run)

    def test_sphere(self):
        self.score("sphere", 390)

    def test_sphere_of_another_seed(self):
        self.score("sphere", 60, 1)

    def test_fibre(self):
        self.score("fibre", 390)

    def test_rag(self):
        self.score("rag", 120)


if __name__ == "__main__":
    harness.main()
