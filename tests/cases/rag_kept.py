# labels: long
# timeout: 7200
# processors: 3
"""Requirement: a rag that stays in the casing of a pump for 20 revolutions at 2 L/s loses no particle and no bond, on 1 and 3 ranks; if it may tear, it tears before it is overstrained."""
import harness

REVOLUTION = 0.05  # s
# It comes in with the design flow, which is then throttled; times in s, shares of 26.8 L/s. Contacts are stiffer than in the demo: a rag that
# stays is jammed between vane and tongue again and again.
THROTTLED = ["rag.0.shear_modulus_MPa=10", "rag.0.insert_time_ms=112", "time.end_ms=1260", "boundary.0.times_s=[0, 0.02, 0.2, 0.24]", "boundary.0.factors=[0, 1, 1, 0.0746]", "boundary.0.ramp_ms=0",
             "output.report=false", "output.fields_interval_ms=1000", "output.rags_interval_ms=20"]


class RagKept(harness.CaseTest):
    def keep(self, ranks, *more, tears=False):
        case = harness.SOURCE_DIR / "cases" / "pump-demo" / "case.toml"
        run = self.run_case(case, ranks, *[word for one in (*THROTTLED, *more) for word in ("--set", one)], timeout=3600)
        summary, rag, passage = run.summary, run.summary["rags"][0], run.monitor("passage")
        time, inside = passage.column("time"), passage.column("particles_in_casing")
        kept = time[inside == rag["particles"]]
        print(f"  {ranks} ranks: {rag['outcome']}, wholly in the casing from {kept[0]:.3f} s to {kept[-1]:.3f} s, "
              f"{rag['recirculations']} recirculations, flow {summary['pump']['flow_m3_s'] * 1000:.2f} L/s, head {summary['pump']['head_m']:.2f} m, "
              f"wall overlap {rag['max_wall_overlap_over_radius']:.2f} r, strain p99 {rag['bond_strain_p99']:.4f}, {summary['wall_s']:.0f} s")
        if not tears:  # pieces of a torn rag may leave
            self.assertGreater(kept[-1] - kept[0], 20 * REVOLUTION)
        self.assertAlmostEqual(summary["pump"]["flow_m3_s"], 2e-3, delta=2e-5)
        self.assertEqual(rag["broken_bonds"] > 0, tears)
        for name in ("particles_lost", "bonds_lost", "particles_beyond_walls"):
            self.assertEqual(summary["conservation"][name], 0, name)
        self.assertLess(summary["conservation"]["momentum_exchange_rel"], 1e-10)
        self.assertLess(rag["max_wall_overlap_over_radius"], 0.5)
        return run

    # Without breakage, as published, no bound on the strain: the vane, whose motion is given, passes the tongue while the cloth hangs on both, and pulls it further than it would bear (cases/pump-demo/README.md).

    def test_on_one_rank(self):
        self.keep(1)

    def test_on_three_ranks(self):
        self.keep(3)

    def test_that_may_tear(self):
        run = self.keep(1, "rag.0.breakage=true", tears=True)
        strain = run.monitor("rags").column("bond_strain_p99").max()
        print(f"  {run.summary['rags'][0]['broken_bonds']} bonds torn, strain that 99 % do not exceed at most {strain:.3f}")
        self.assertLess(strain, 0.26)


if __name__ == "__main__":
    harness.main()
