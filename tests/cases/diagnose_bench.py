"""The blind benchmark of the diagnosis at its full size: 390 spheres, 390 fibres, 120 rags at level L2; no score below what chance allows if its target holds."""
# labels: long
# timeout: 36000
# processors: 2
import json

import harness
from diagnose import chance


class Benchmark(harness.CaseTest):
    def score(self, twin, n):
        folder = harness.BINARY_DIR / "diagnose-bench" / twin  # kept: a run that was stopped goes on
        run = harness.snag(["diagnose", "--bench", "L2", "--twin", twin, "--n", n, "--seed", "402", "--out", folder], 2, folder, timeout=36000)
        self.assertEqual(run.code, 0, run.tail())
        print(run.stdout)
        for score in json.loads((folder / "score.json").read_text())["scores"]:
            limit, at_least = float(score["target"].split()[1]), score["target"].startswith(">=")
            with self.subTest(f"{twin}: {score['name']}"):
                self.assertGreater(chance(score["hits"], score["n"], limit, at_least), 0.01, score)

    def test_sphere(self):
        self.score("sphere", 390)

    def test_fibre(self):
        self.score("fibre", 390)

    def test_rag(self):
        self.score("rag", 120)


if __name__ == "__main__":
    harness.main()
