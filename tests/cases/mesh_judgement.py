# timeout: 200
# cost: 16
"""Requirement: `snag mesh --info` prints the same table on any number of ranks, ends with 0 on a sound mesh and with 3 on a bad one."""
import harness

MESHES = harness.SOURCE_DIR / "cases" / "meshes"
RANKS = (1, 2, 3, 5)


class Judgement(harness.CaseTest):
    def judged(self, mesh, ranks, code):
        run = harness.snag(["mesh", "--info", mesh], ranks, timeout=100)
        self.assertEqual(run.code, code, run.tail())
        return run.stdout

    def same_on_all(self, mesh, code):
        tables = {ranks: self.judged(mesh, ranks, code) for ranks in RANKS}
        for ranks in RANKS[1:]:
            self.assertEqual(tables[1], tables[ranks], f"{mesh.name} on {ranks} ranks")
        return tables[1]

    def test_pump(self):
        table = self.same_on_all(MESHES / "pump_coarse.msh", 0)
        for patch in ("inlet", "outlet", "impeller_walls", "casing_walls", "interface_rotor", "interface_stator"):
            self.assertIn(f"patch {patch} ", table)
        self.assertEqual(table, self.judged(MESHES / "pump_coarse_v41.msh", 2, 0), "both formats hold the same mesh")

    def test_fewer_cells_than_ranks(self):
        mesh = self.mesh("box", 'cells="hexahedra"', "size_m=1", "lower_m=[0,0,0]", "upper_m=[2,1,1]")
        self.assertIn("cells                                 2\n", self.same_on_all(mesh, 0))

    def test_named_faces_inside(self):
        """A wall without thickness that has the name of another wall."""
        lines = self.mesh("box", 'cells="hexahedra"', "size_m=1", "lower_m=[0,0,0]", "upper_m=[2,1,1]").read_text().splitlines()
        nodes = [line.split() for line in lines[lines.index("$Nodes") + 2 : lines.index("$EndNodes")]]
        at = {tuple(round(float(x)) for x in node[1:]): node[0] for node in nodes}
        patch = next(line.split()[1] for line in lines if line.endswith('"y0"'))
        count, end = lines.index("$Elements") + 1, lines.index("$EndElements")
        lines[count] = str(int(lines[count]) + 1)
        lines.insert(end, f"{lines[count]} 3 2 {patch} 99 {at[1, 0, 0]} {at[1, 1, 0]} {at[1, 1, 1]} {at[1, 0, 1]}")
        mesh = self.work / "plate.msh"
        mesh.write_text("\n".join(lines) + "\n")
        self.assertIn('surface "y0" lies inside the volume with 1 of its faces, between two cells of water; water passes through them', self.same_on_all(mesh, 0))

    def test_cell_turned_inside_out(self):
        lines = self.mesh("box", 'cells="hexahedra"', "size_m=0.25", "lower_m=[0,0,0]", "upper_m=[1,1,1]").read_text().splitlines()
        first = lines.index("$Nodes") + 2
        inner = next(i for i in range(first, len(lines)) if all(0.1 < float(x) < 0.9 for x in lines[i].split()[1:]))
        number, x, y, z = lines[inner].split()
        lines[inner] = f"{number} {float(x) + 0.6} {y} {z}"
        bad = self.work / "bad.msh"
        bad.write_text("\n".join(lines) + "\n")
        self.assertIn("BAD: quality", self.same_on_all(bad, 3))


if __name__ == "__main__":
    harness.main()
