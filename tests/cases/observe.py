# cost: 25
"""Requirement: the same rags are seen in a run and in the pictures of it, by one code; their stay in the volute and the difference of operating
points come out as they were put in; a camera or a table that cannot be is refused with one message."""
import json
import math

import numpy

import harness

FALLING = """
[case]
name = "falling"
[time]
end_ms = 40
step_ms = 1
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[[rag]]
length_mm = 120
width_mm = 60
radius_mm = 2
centre_m = [0, 0, 0.3]
lengthwise = [0.8, 0, 0.6]
crosswise = [0.6, 0, -0.8]
[output]
report = false
rags_interval_ms = 5
"""
CAMERA = """
[camera]
pixels = [500, 400]
pixel_mm = 0.5
centre_m = [0, 0, 0.3]
right = [1, 0, 0]
up = [0, 0, 1]
blur = 1
noise = 2
[cloth]
threshold = 70
smoothing = 1
minimum_pixels = 100
"""

# The shaft in the middle, the tongue 100 pixels to the right of it, the outlet upwards.
PUMP = """
[camera]
pixels = [400, 400]
pixel_mm = 1
interval_ms = 20
[cloth]
background = "{background}"
[pump_in_picture]
axis = [200, 200]
tongue = [300, 200]
outlet = [340, 40]
outlet_direction = [0, 3]
outlet_radius_mm = 60
tongue_reach_mm = 5
impeller_radius_mm = 60
"""


def write_picture(file, cloth=()):
    """A grey picture of 400 x 400 pixels with a dark rectangle (left column, top row, width, height), or none."""
    picture = numpy.full((400, 400), 200, numpy.uint8)
    if cloth:
        left, top, width, height = cloth
        picture[top : top + height, left : left + width] = 60
    file.write_bytes(b"P5\n400 400\n255\n" + picture.tobytes())


def table_of(file):
    """Rows of a CSV file as dictionaries, units taken off."""
    lines = [line.split(",") for line in file.read_text().splitlines()]
    return [dict(zip((name.split(" [")[0] for name in lines[0]), line)) for line in lines[1:]]


def independent(groups):
    """n_eff of each group [group][rag][sample], as in docs/theory.md."""
    rags = [numpy.array(rag) for group in groups for rag in group]
    every = [numpy.concatenate(group) for group in groups]
    n_more = sum(len(group) - 1 for group in groups)
    between = sum(len(rag) * (numpy.mean(rag) - all.mean()) ** 2 for group, all in zip(groups, every) for rag in group) / n_more
    within = sum(((rag - rag.mean()) ** 2).sum() for rag in rags) / sum(len(rag) - 1 for rag in rags)
    size = [sum(len(rag) ** 2 for rag in group) / len(all) for group, all in zip(groups, every)]
    m_0 = sum(len(all) - m for all, m in zip(every, size)) / n_more
    rho = max(0, (between - within) / (between + (m_0 - 1) * within))
    return [len(all) / (1 + (m - 1) * rho) for all, m in zip(every, size)]


class Observe(harness.CaseTest):
    def observe(self, subject, camera, out, code=0):
        return self.snag_observe([subject, "--camera", camera], out, code)

    def snag_observe(self, arguments, out, code=0):
        run = harness.snag(["observe", *arguments, "--out", self.work / out], 2, self.work / out)
        self.assertEqual(run.code, code, run.tail())
        return run

    def camera(self, text, name="camera"):
        file = self.work / f"{name}.toml"
        file.write_text(text)
        return file

    def test_path_that_does_not_exist(self):
        """It is said, with the name that was meant."""
        (self.work / "demo" / "mode-two_way").mkdir(parents=True)
        refused = self.snag_observe([self.work / "demo" / "two_way"], "seen", 6)
        self.assertIn("two_way: does not exist", refused.stderr)
        self.assertIn("mode-two_way", refused.stderr)
        like_a_command = self.observe("study", self.camera(CAMERA), "seen", 6)
        self.assertIn("study: does not exist", like_a_command.stderr)

    def test_silhouettes_are_those_of_the_camera(self):
        """A monitor of the run, that a diagnosis reads, shows the cloth from where [virtual_camera] stands, and as large as `snag observe` does."""
        run = self.run_case(self.case(FALLING + "[virtual_camera]\nright = [1, 0, 0]\nup = [0, 0, 1]\n"))
        seen = run.monitor("silhouettes")
        self.assertLess(abs(seen.column("area") / (0.120 * 0.060) - 1).max(), 0.01)
        self.assertLess(abs(seen.column("elongation_ratio") / 2 - 1).max(), 0.01)
        self.assertLess(abs(numpy.degrees(seen.column("orientation")) - 36.87).max(), 0.2)
        edge_on = self.run_case(self.case(FALLING, "edge-on"), out="edge-on").monitor("silhouettes")
        self.assertLess(edge_on.column("area").max(), 0.14 * 0.002)  # a row of pixels

    def test_run_and_pictures(self):
        run = self.run_case(self.case(FALLING))
        seen = self.observe(run.folder, self.camera(CAMERA), "seen")
        statistics = json.loads((seen.folder / "statistics.json").read_text())
        # A sheet of 30 x 15 particles that falls freely in the plane of the picture: 120 mm x 60 mm.
        self.assertEqual(statistics["whole_blobs"], 9)
        self.assertAlmostEqual(statistics["area"]["mean"], 0.120 * 0.060, delta=0.01 * 0.0072)
        self.assertAlmostEqual(statistics["elongation_ratio"]["mean"], 2, delta=0.02)
        self.assertAlmostEqual(statistics["orientation"]["mean"], 36.87, delta=0.2)
        self.assertAlmostEqual(statistics["y"]["minimum"], -0.5 * 9.81 * 0.04**2, delta=2e-4)
        # All centroids in one place: the contours are those of the sheet, but for the edges of pixels.
        half = next(contour for contour in statistics["extent"] if contour["share"] == 0.5)
        self.assertAlmostEqual(half["area_m2"], 0.120 * 0.060, delta=0.01 * 0.0072)
        self.assertAlmostEqual(half["elongation_ratio"], 2, delta=0.02)
        self.assertAlmostEqual(half["orientation_deg"], 36.87, delta=0.2)
        for name in ("coverage.png", "extent.png", "outlines/found_00000.png", "pictures/view_00008.png"):
            self.assertTrue((seen.folder / name).exists(), name)

        # The pictures of it as if they had been taken, with a picture without cloth: of the camera turned away.
        away = self.observe(run.folder, self.camera(CAMERA.replace("0, 0.3]", "5, 9]").replace("[0, 5, 9]", "[9, 9, 9]"), "away"), "away")
        self.assertEqual(json.loads((away.folder / "statistics.json").read_text())["blobs"], 0)
        self.assertIn("no cloth was found in any picture", away.stdout)
        self.assertNotIn("no cloth was found", seen.stdout)
        background = away.folder / "pictures" / "view_00000.png"
        camera = self.camera(CAMERA.replace("[cloth]", f'[cloth]\nbackground = "{background}"'), "taken")
        taken = self.observe(seen.folder / "pictures", camera, "taken")
        again = json.loads((taken.folder / "statistics.json").read_text())
        for name in ("area", "elongation_ratio", "orientation", "x", "y"):
            self.assertAlmostEqual(again[name]["mean"], statistics[name]["mean"], delta=2e-3 * abs(statistics[name]["mean"]) + 1e-4)

    def test_volute_of_runs(self):
        """What the summaries of two runs tell: 0.3 s at 120 mm and 0.1 s at 100 mm in one bin."""
        def summary(name, time, radius, events):
            bins = [{"angle_deg": 20 * k + 10, "time_s": 0, "mean_radius_m": None} for k in range(18)]
            bins[4].update(time_s=time, mean_radius_m=radius)
            bins[17].update(time_s=0.1, mean_radius_m=0.11)
            (self.work / name).mkdir()
            (self.work / name / "summary.json").write_text(json.dumps({"rags": [{"volute": bins, "events": events}]}))
            return self.work / name

        first = summary("first", 0.3, 0.12, [{"t_s": 1, "angle_deg": 381, "what": "recirculated"}, {"t_s": 0, "angle_deg": 90, "what": "entered"}])
        second = summary("second", 0.1, 0.10, [{"t_s": 1, "angle_deg": -1, "what": "stuck on tongue"}])
        run = self.snag_observe([first, second], "volute")
        rows = table_of(run.folder / "volute.csv")
        self.assertEqual([float(row["angle_from"]) for row in rows], [20.0 * k for k in range(18)])
        shares = {4: 0.4 / 0.6, 17: 0.2 / 0.6}
        for k, row in enumerate(rows):
            self.assertAlmostEqual(float(row["share"]), shares.get(k, 0), places=9)
        self.assertAlmostEqual(float(rows[4]["radius"]), (0.3 * 0.12 + 0.1 * 0.10) / 0.4, places=9)
        self.assertAlmostEqual(float(rows[4]["radius_sigma"]), 0.02 / math.sqrt(2), places=9)
        self.assertEqual([row["recirculated"] for row in rows], ["0", "1"] + 16 * ["0"])
        self.assertEqual([row["stuck_on_tongue"] for row in rows], 17 * ["0"] + ["1"])
        self.assertEqual(len(table_of(run.folder / "first" / "volute.csv")), 18)

    def test_volute_in_pictures(self):
        """A rag goes round twice from 45 degrees, 10 degrees a picture, and leaves by the outlet: two recirculations, one exit."""
        pictures = self.work / "orbit"
        pictures.mkdir()
        angles = [math.radians(45 + 10 * k) for k in range(103)]  # to 1065 degrees
        places = [(200 + 80 * math.cos(a), 200 - 80 * math.sin(a)) for a in angles] + [(340, 120), (340, 60)]
        for n, (column, row) in enumerate(places):
            write_picture(pictures / f"{n:03}.pgm", (round(column) - 10, round(row) - 10, 20, 20))
        for n in range(2):
            write_picture(pictures / f"{len(places) + n:03}.pgm")
        camera = self.camera(PUMP.format(background=pictures / f"{len(places):03}.pgm"), "pump")
        seen = self.observe(pictures, camera, "seen")
        rows = table_of(seen.folder / "volute_seen.csv")
        # Pictures in each bin of 20 degrees: 2 a turn; those in the discharge do not count.
        counts = [sum(math.degrees(a) % 360 // 20 == k for a in angles) for k in range(18)]
        for k, row in enumerate(rows):
            self.assertAlmostEqual(float(row["time"]), 0.02 * counts[k], places=9, msg=k)
            self.assertAlmostEqual(float(row["share"]), counts[k] / len(angles), places=9, msg=k)
            self.assertAlmostEqual(float(row["radius"]), 0.080, delta=7e-4)
        for event, expected in (("recirculated", {1: 2}), ("tongue_passed", {1: 1}), ("exited", {2: 1}), ("stuck_on_tongue", {})):
            self.assertEqual({k: int(row[event]) for k, row in enumerate(rows) if row[event] != "0"}, expected, event)
        without_time = self.camera(camera.read_text().replace("interval_ms = 20\n", ""), "timeless")
        self.assertIn("interval", "\n".join(self.observe(pictures, without_time, "mistake", 2).messages))

    def test_operating_points(self):
        """Rectangles of known area, three pictures a rag, two rags a point: mean, sigma, n, n_eff and F are those of the areas put in."""
        sizes = {"part": [[(20, 30), (20, 34), (22, 30)], [(30, 30), (31, 30), (30, 32)]], "best": [[(16, 20), (17, 21), (16, 24)], [(22, 20), (21, 24), (24, 20)]]}
        arguments = []
        for point, rags in sizes.items():
            arguments += ["--group", point]
            for r, rag in enumerate(rags):
                folder = self.work / f"{point}_{r}"
                folder.mkdir()
                for k, (width, height) in enumerate(rag):
                    write_picture(folder / f"{k}.pgm", (100 + 7 * k + 20 * r, 150 + 5 * k * k - 9 * r, width, height))
                arguments.append(folder)
        background = self.work / "empty.pgm"
        write_picture(background)
        camera = self.camera(PUMP[: PUMP.index("[pump_in_picture]")].format(background=background), "points")
        run = self.snag_observe([*arguments, "--camera", camera], "points")
        areas = [[[width * height * 1e-6 for width, height in rag] for rag in rags] for rags in sizes.values()]
        every = [numpy.concatenate(group) for group in areas]
        rows = [row for row in table_of(run.folder / "groups.csv") if row["quantity"] == "area"]
        self.assertEqual([row["group"] for row in rows], list(sizes))
        n_eff = independent(areas)
        for row, values, n in zip(rows, every, n_eff):
            numpy.testing.assert_allclose([float(row[name]) for name in ("mean", "sigma", "n", "n_eff")], [values.mean(), values.std(ddof=1), 6, n], rtol=1e-8)
        area = next(row for row in table_of(run.folder / "anova.csv") if row["quantity"] == "area")
        # Two groups of equal size: F = n_g (difference of means)^2/2 over the mean variance.
        ratio = (every[0].mean() - every[1].mean()) ** 2 / 2 / numpy.mean([values.var(ddof=1) for values in every])
        numpy.testing.assert_allclose([float(area["F"]), float(area["F_eff"])], [6 * ratio, n_eff[0] * ratio], rtol=1e-8)
        self.assertLess(float(area["p"]), float(area["p_eff"]))
        self.assertEqual(json.loads((run.folder / "part" / "statistics.json").read_text())["whole_blobs"], 6)
        self.assertEqual(json.loads((run.folder / "statistics.json").read_text())["whole_blobs"], 12)

    def test_background_that_is_not_given(self):
        pictures = self.work / "pictures"
        pictures.mkdir()
        for k in range(3):
            write_picture(pictures / f"{k}.pgm", (100 + 40 * k, 150, 20, 30))
        text = PUMP[: PUMP.index("[pump_in_picture]")]
        run = self.snag_observe([pictures, "--camera", self.camera(text.replace('background = "{background}"\n', ""), "none")], "none")
        self.assertIn("warning: [cloth] background is not given", run.stdout)
        write_picture(pictures / "empty.pgm")
        run = self.snag_observe([pictures, "--camera", self.camera(text.format(background=pictures / "empty.pgm"), "given")], "given")
        self.assertNotIn("background is not given", run.stdout)

    def test_mistakes_of_groups(self):
        table = self.work / "repeats.csv"
        for rows, message in (("a,1\na,2", "two"), ("a,1\na,2\nb,3", "1 sample"), ("a,1\na,1\nb,1\nb,1", "does not vary"), ("a,1\na,nan\nb,1\nb,2", "nan")):
            table.write_text(f"group,area [m2]\n{rows}\n")
            run = self.snag_observe([table], "mistake", 2)
            self.assertEqual(len(run.messages), 1, run.messages)
            self.assertIn(message, run.messages[0])
        for arguments, message in ((["--group", "a", table.parent], "at least two"), ([], "nothing to observe"), ([table, table], "alone"), ([table.parent], "--camera")):
            run = self.snag_observe(arguments, "mistake", 2)
            self.assertEqual(len(run.messages), 1, run.messages)
            self.assertIn(message, run.messages[0])

    def test_mistakes(self):
        run = self.run_case(self.case(FALLING.replace("end_ms = 40", "end_ms = 1")))
        for old, new, code, message in (("pixel_mm = 0.5\n", "", 2, "pixel"), ("up = [0, 0, 1]", "up = [2, 0, 0]", 2, "parallel"),
                                        ("noise = 2", "nois = 2", 2, "noise")):
            seen = self.observe(run.folder, self.camera(CAMERA.replace(old, new)), "mistake", code)
            self.assertEqual(len(seen.messages), 1, seen.messages)
            self.assertIn(message, seen.messages[0])
        self.assertIn("none", "\n".join(self.observe(self.work / "none", self.camera(CAMERA), "mistake", 6).messages))


if __name__ == "__main__":
    harness.main()
