# timeout: 600
# cost: 20
"""Requirement: what is told of a rag that goes through a turning zone agrees with its particles, on any number of ranks and after a resume."""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import harness
from small_cases import CHANNEL, CHANNEL_MESH, pump_case, tight_flow
from turning_zone import RING_WALLS, Rings

N_STEPS, N_PARTICLES = 100, 60
PASSAGE = """
[rag_passage]
inlet_flange_m = [0, 0, 0.04]
inlet_normal = [0, 0, -1]
inlet_radius_m = 0.05
outlet_flange_m = [0, 0, 0]
outlet_normal = [0, 0, -1]
outlet_radius_m = 0.08
tongue_m = [0.0565685, 0.0565685, 0.02]
tongue_reach_m = 0.03
impeller_radius_m = 0.05
"""
RAG = """
[[wall]]
kind = "patches"
patches = ["impeller_walls", "walls"]
[[rag]]
length_mm = 20
width_mm = 12
radius_mm = 1
centre_m = [0.04, 0, 0.05]
lengthwise = [0, 1, 0]
crosswise = [1, 0, 0]
[coupling]
forces = ["published"]
"""


def particles(folder, step):
    """Point arrays of rags/particles_<step>.vtp, positions as "x"."""
    data = harness.read_vtk(folder / "rags" / f"particles_{step:06}.vtp")
    return {"x": vtk_to_numpy(data.GetPoints().GetData()), **harness.arrays(data.GetPointData())}


class RagThroughRings(harness.CaseTest):
    ranks = (2,)  # that are compared with one rank; passage_long.py has more

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        mesh = cls.shared / "rings.msh"
        Rings().write(mesh)
        cls.file = cls.shared / "case.toml"
        cls.file.write_text(pump_case(
            "rag-through-rings", mesh, rotor='rotation_speed = "600 rpm"', time="end_s = 0.1\nstep_s = 1e-3",
            flow="initial_velocity_m_s = [0, 0, -0.5]\n" + tight_flow("1e-11"), flow_rate_L_s=5, walls=RING_WALLS, more=PASSAGE + RAG,
            output="rags_interval_s = 0.001\n[checkpoint]\ninterval_s = 0.06"))
        cls.done = harness.snag(["run", cls.file, "--out", cls.shared / "1"], 1, cls.shared / "1")
        assert cls.done.code == 0, cls.done.tail()

    def test_monitor_agrees_with_particles(self):
        passage, rags = self.done.monitor("passage"), self.done.monitor("rags")
        count = {place: passage.column(f"particles_{place}") for place in ("upstream", "in_casing", "out")}
        self.assertTrue((sum(count.values()) == N_PARTICLES).all(), "every particle is in one place")
        self.assertEqual(count["upstream"][0], N_PARTICLES)
        self.assertGreater(count["out"][-1], 0, "the rag must have come through, else the case shows little")
        x, y, z = (rags.column(c) for c in "xyz")
        angle = numpy.degrees(numpy.unwrap(numpy.arctan2(y, x))) - 45
        numpy.testing.assert_allclose(passage.column("angle"), angle, atol=1e-6)
        numpy.testing.assert_allclose(passage.column("radius"), numpy.hypot(x, y), atol=1e-12)
        numpy.testing.assert_allclose(passage.column("height"), z, atol=1e-12)
        numpy.testing.assert_array_equal(passage.column("max_tension"), rags.column("bond_tension_max"))
        touching = sum(passage.column(f"touching_{wall}") for wall in ("impeller", "tongue", "other_wall"))
        there = self.steps_there()
        self.assertEqual(count["out"][there - 1], N_PARTICLES, "it is taken out when all of it has left")
        self.assertTrue(((touching > 0) == (self.done.monitor("contacts").column("wall_contacts")[:there] > 0)).all())
        for step in range(1, there + 1):
            seen = particles(self.done.folder, step)
            self.assertEqual((seen["x"][:, 2] < 0).sum(), count["out"][step - 1], f"step {step}")

    def steps_there(self):
        """Steps at whose end the rag is in the run: until it has left the mesh."""
        there = len(self.done.monitor("passage").column("time"))
        self.assertGreater(there, N_STEPS // 2)
        return there

    def test_forces_add_up(self):
        forces, coupling = self.done.monitor("rag_forces"), self.done.monitor("coupling")
        in_all = 0
        for step in range(1, self.steps_there() + 1):
            seen = particles(self.done.folder, step)
            total = [coupling.column(f"force_on_rags_{c}")[step - 1] for c in "xyz"]
            numpy.testing.assert_allclose(seen["fluid_force [N]"].sum(axis=0), total, atol=1e-6 * numpy.abs(total).max())
            for kind in ("fluid", "contact"):
                size = numpy.linalg.norm(seen[f"{kind}_force [N]"], axis=1)
                touched = size[size > 0] if kind == "contact" else size
                expected = [touched.mean(), touched.max()] if len(touched) else [0, 0]
                numpy.testing.assert_allclose([forces.column(f"{kind}_{what}")[step - 1] for what in ("mean", "max")], expected, rtol=1e-6, atol=1e-15)
            in_all += (size > 0).sum()
            self.assertEqual((size > 0).sum(), forces.column("in_contact")[step - 1])
            for kind in ("fluid", "contact"):
                values = [forces.column(f"{kind}_{what}")[step - 1] for what in ("p50", "p90", "p99", "max")]
                self.assertEqual(values, sorted(values))
        self.assertGreater(in_all, 0, "the rag must touch something, else the case shows little")

    def test_verdict_agrees_with_monitors(self):
        rag, passage = self.done.summary["rags"][0], self.done.monitor("passage")
        time, angle = passage.column("time"), passage.column("angle")
        first = {
            "entered": passage.column("particles_upstream") < N_PARTICLES,
            "wholly in the casing": passage.column("particles_upstream") == 0,
            "reached the outlet": passage.column("particles_out") > 0,
            "exited": passage.column("particles_out") == N_PARTICLES,
        }
        events = {event["what"]: event for event in rag["events"]}
        for what, happens in first.items():
            self.assertEqual(happens.any(), what in events, what)
            if happens.any():
                at = numpy.argmax(happens)
                self.assertAlmostEqual(events[what]["t_s"], time[at], places=12, msg=what)
                self.assertAlmostEqual(events[what]["angle_deg"], angle[at], places=9, msg=what)
        self.assertEqual([e["t_s"] for e in rag["events"]], sorted(e["t_s"] for e in rag["events"]))
        self.assertAlmostEqual(rag["time_to_enter_s"], events["wholly in the casing"]["t_s"] - events["entered"]["t_s"], places=12)
        if "exited" in events:
            self.assertEqual(rag["outcome"], "exited")
            self.assertAlmostEqual(rag["retention_time_s"], events["exited"]["t_s"] - events["wholly in the casing"]["t_s"], places=12)
        else:
            self.assertIsNone(rag["retention_time_s"])
        zones = rag["wall_contact_by_zone_s"]
        self.assertGreater(rag["wall_contact_s"], 0)
        self.assertGreaterEqual(rag["wall_contact_s"], max(zones.values()))
        self.assertLessEqual(rag["wall_contact_s"], sum(zones.values()) + 1e-12)
        for zone, column in (("impeller", "impeller"), ("tongue", "tongue"), ("other", "other_wall")):
            # A row tells the end of a step, the time counts touches within it as well.
            self.assertGreaterEqual(zones[zone] + 1e-12, 1e-3 * (passage.column(f"touching_{column}") > 0).sum(), zone)
        tension = passage.column("max_tension")
        self.assertAlmostEqual(rag["max_bond_tension_N"], tension.max(), places=12)
        self.assertAlmostEqual(rag["max_bond_tension_at"]["t_s"], time[numpy.argmax(tension)], places=12)
        self.assertEqual(len(rag["volute"]), 18)
        print("  " + self.done.stdout.split("rag 1: ")[-1].splitlines()[0])
        self.assertIn(f"rag 1: {rag['outcome']}, retention time", self.done.stdout)
        self.assertIn("pump: head", self.done.stdout)
        self.assertNotIn("no revolution is complete", self.done.stdout)
        self.assertGreaterEqual(self.done.summary["pump"]["revolutions"], 1)

    def test_less_than_one_revolution(self):
        run = self.run_case(self.case(self.file.read_text().replace("end_s = 0.1", "end_s = 0.02")))
        self.assertIn("no revolution is complete", run.stdout)
        self.assertAlmostEqual(run.summary["pump"]["revolutions"], 0.2, places=12)

    def test_any_number_of_ranks(self):
        for ranks in self.ranks:
            other = self.run_case(self.file, ranks, out=str(ranks))
            for monitor in ("passage", "rag_forces", "rags", "contacts"):
                self.assert_monitors_agree(self.done, other, monitor, 1e-6)
            mine, others = self.done.summary["rags"][0], other.summary["rags"][0]
            self.assertEqual(mine["outcome"], others["outcome"])
            self.assertEqual([e["what"] for e in mine["events"]], [e["what"] for e in others["events"]])

    def test_resume_to_the_bit(self):
        resumed = self.crashed_and_resumed(self.done, self.file, lambda run: sorted((run.folder / "rags").glob("*.vtp"))[-1:], "0.06")
        self.assert_equal_to_the_bit(self.done, resumed, lambda run: sorted((run.folder / "rags").glob("*.vtp"))[-1:])
        self.assertEqual(self.done.summary["rags"], resumed.summary["rags"])

    def test_pictures_change_nothing(self):
        other = self.run_case(self.file, 1, "--set", "output.rags_interval_s=0.02", out="few")
        for monitor in ("passage", "rag_forces", "rags"):
            self.assertEqual(self.done.monitor(monitor).lines, other.monitor(monitor).lines, monitor)

    def test_passage_needs_a_turning_zone(self):
        refused = self.run_case(self.case(CHANNEL.format(mesh=self.mesh(*CHANNEL_MESH), kernel="cell") + PASSAGE), code=2)
        self.assertIn("[rag_passage]", refused.stderr)
        self.assertIn("add [rotating_zone]", refused.stderr)


if __name__ == "__main__":
    harness.main()
