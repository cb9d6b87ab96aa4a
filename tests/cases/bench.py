# timeout: 600
# cost: 25
# processors: 2
"""Requirement: a benchmark writes what it measured, with its limit, under stable keys; and refuses what it does not know."""
import json
import shutil
import subprocess
import unittest

import harness

KEYS = ["name", "value", "unit", "ranks", "limit", "peer", "peer_value", "ratio", "note"]
EQUATIONS = ["momentum", "pressure", "turbulence", "rest"]


class Bench(harness.CaseTest):
    def bench(self, *arguments, ranks=1, code=0):
        run = harness.snag(["bench", *arguments, "--out", self.work / "bench"], ranks, self.work / "bench")
        self.assertEqual(run.code, code, run.tail())
        return run

    def pump_mesh(self):
        """The mesh of the coarse pump, there already; the duct of test_coupling is made."""
        mesh = self.work / "bench" / "pump_coarse.msh"
        mesh.parent.mkdir()
        shutil.copy(harness.SOURCE_DIR / "cases" / "meshes" / mesh.name, mesh)
        return mesh

    def test_flow(self):
        mesh = self.pump_mesh()
        made = mesh.stat().st_mtime_ns
        run = self.bench("flow", "--level", "coarse", "--steps", "2", ranks=2)
        records = json.loads((run.folder / "bench.json").read_text())
        for record in records:
            self.assertEqual(list(record), KEYS)
            self.assertEqual(record["ranks"], 2)
            self.assertEqual((record["peer"], record["peer_value"], record["ratio"]), (None, None, None), "no peer was asked for")
            self.assertIn(record["name"], run.stdout)
        values = {record["name"]: record for record in records}
        self.assertEqual(len(values), len(records), "no name twice")
        step = values["flow.step"]
        self.assertAlmostEqual(values["flow.step_mean"]["value"], step["value"], places=12, msg="the median of two steps is their mean")
        self.assertEqual(step["unit"], "s")
        self.assertLessEqual(values["flow.step_lowest"]["value"], step["value"])
        self.assertGreaterEqual(values["flow.step_highest"]["value"], step["value"])
        self.assertAlmostEqual(values["flow.step_per_cell"]["value"], step["value"] * 1e6 / values["flow.cells"]["value"])
        # The parts make up the whole, in time and in traffic.
        parts = [values[f"flow.{name}"] for name in EQUATIONS] + [values["flow.mesh_motion"]]
        self.assertAlmostEqual(sum(part["value"] for part in parts) / step["value"], 1, delta=0.2)
        self.assertAlmostEqual(sum(values[f"flow.{name}"]["limit"] for name in EQUATIONS) / step["limit"], 1, places=9)
        for name in EQUATIONS:
            traffic, bandwidth = 1e6 * values[f"flow.{name}_traffic"]["value"], 1e9 * values["machine.bandwidth"]["value"]
            self.assertAlmostEqual(values[f"flow.{name}"]["limit"] / (traffic / bandwidth), 1, places=9)
        # Residuals drop at least as far as the peer is told to reduce them.
        for name in ("momentum", "k", "epsilon", "pressure"):
            self.assertLess(values[f"flow.{name}_drop"]["value"], 0.02, name)
        self.assertAlmostEqual(values["flow.courant_max"]["value"], 6, delta=4)
        self.assertGreater(values["flow.import"]["value"], 0)
        self.assertGreater(values["flow.memory"]["value"], 1, "kB a cell: the fields alone are more")
        self.assertGreaterEqual(values["flow.memory_peak"]["value"], 0.99 * values["flow.memory"]["value"], "pages are counted some at a time")
        again = self.bench("flow", "--level", "coarse", "--steps", "1")
        self.assertEqual(mesh.stat().st_mtime_ns, made, "a mesh that is there is used again")
        self.assertEqual(json.loads((again.folder / "bench.json").read_text())[0]["ranks"], 1)

    @unittest.skipUnless(shutil.which("pimpleFoam"), "the Debian package openfoam is not installed")
    def test_peer(self):
        """The other program does the same steps under an MPI job of its own; its numbers stand beside ours."""
        run = self.bench("flow", "--peer", "--level", "coarse", "--steps", "2", ranks=2)
        values = {record["name"]: record for record in json.loads((run.folder / "bench.json").read_text())}
        for name in ("step", "step_cpu", "momentum_sweeps", "pressure_iterations", "k_sweeps", "epsilon_sweeps", "momentum_drop", "pressure_drop"):
            record = values[f"flow.{name}"]
            self.assertEqual(record["peer"], "OpenFOAM 1912")
            self.assertGreater(record["peer_value"], 0, name)
            self.assertAlmostEqual(record["ratio"], record["value"] / record["peer_value"], msg=name)
        self.assertLess(values["flow.momentum_drop"]["peer_value"], 0.02)
        self.assertIsNone(values["flow.momentum"]["peer"], "the peer does not tell the time of each equation")
        self.assertEqual(len(json.loads((run.folder / "peer" / "peer.json").read_text())["wall_s"]), 2)

    def test_coupling(self):
        """Each kernel: the parts make up the step, and the exchange loses nothing. The transfers by themselves."""
        self.pump_mesh()
        run = self.bench("coupling", "--quick", "--steps", "8", ranks=2)
        records = json.loads((run.folder / "bench.json").read_text())
        values = {record["name"]: record["value"] for record in records}
        self.assertEqual(len(values), len(records), "no name twice")
        for kernel in ("cell", "gaussian", "wendland"):
            step, flow, rags, coupling = (values[f"coupling.{kernel}_{part}"] for part in ("step", "flow", "rags", "coupling"))
            self.assertGreater(min(flow, rags, coupling), 0)
            self.assertAlmostEqual((flow + rags + coupling) / step, 1, delta=0.3)
            self.assertAlmostEqual(values[f"coupling.{kernel}_share"], coupling / step)
            self.assertLess(values[f"coupling.{kernel}_exchange"], 1e-10)
        self.assertGreater(values["coupling.rag_in_prescribed_flow"], 0)
        transfers = [values[f"coupling.transfers_{part}"] for part in ("locate", "average", "spread")]
        self.assertGreater(min(transfers), 0)
        self.assertAlmostEqual(values["coupling.transfers"], 2 * sum(transfers), msg="of both ranks")

    def test_dem(self):
        """The cases on one rank, the same sheet on both, and the limits."""
        run = self.bench("dem", "--quick", ranks=2)
        records = json.loads((run.folder / "bench.json").read_text())
        values = {record["name"]: record for record in records}
        self.assertEqual(len(values), len(records), "no name twice")
        for name in ("flat", "stack", "stack_moving", "flat_4k"):
            self.assertEqual(values[f"dem.{name}"]["ranks"], 1)
            self.assertGreater(values[f"dem.{name}"]["value"], 0)
            self.assertGreater(values[f"dem.{name}"]["limit"], values[f"dem.{name}"]["value"], "faster than the machine allows")
        self.assertAlmostEqual(values["dem.stack_contacts"]["value"], 5.91, delta=0.05)
        self.assertEqual(values["dem.flat_on_2"]["ranks"], 2)
        self.assertGreater(values["dem.flat_speedup"]["value"], 0)

    def test_refusals(self):
        self.assertIn("there are: flow, dem", self.bench("mesh", code=2).stderr)
        self.assertIn("known: coarse, medium, fine", self.bench("flow", "--level", "huge", code=2).stderr)
        self.assertIn("at least 1", self.bench("flow", "--steps", "0", code=2).stderr)

    def test_missing_peer_is_named(self):
        """Before anything is computed."""
        command = [harness.BINARY_DIR / "snag", "bench", "flow", "--peer", "--out", self.work / "bench"]
        run = subprocess.run(command, env=dict(harness.ENVIRONMENT, PATH=str(self.work), OMPI_MCA_plm_rsh_agent="/bin/false"), capture_output=True, text=True)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("Debian package openfoam", run.stderr)
        self.assertFalse((self.work / "bench").exists())


if __name__ == "__main__":
    harness.main()
