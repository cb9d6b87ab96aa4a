"""Requirement: the same rags are seen in a run and in the pictures of it, by one code; a camera that cannot be is refused with one message."""
import json

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


class Observe(harness.CaseTest):
    def observe(self, subject, camera, out, code=0):
        run = harness.snag(["observe", subject, "--camera", camera, "--out", self.work / out], 2, self.work / out)
        self.assertEqual(run.code, code, run.tail())
        return run

    def camera(self, text, name="camera"):
        file = self.work / f"{name}.toml"
        file.write_text(text)
        return file

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
        for name in ("coverage.png", "outlines/found_00000.png", "pictures/view_00008.png"):
            self.assertTrue((seen.folder / name).exists(), name)

        # The pictures of it as if they had been taken, with a picture without cloth: of the camera turned away.
        away = self.observe(run.folder, self.camera(CAMERA.replace("0, 0.3]", "5, 9]").replace("[0, 5, 9]", "[9, 9, 9]"), "away"), "away")
        self.assertEqual(json.loads((away.folder / "statistics.json").read_text())["blobs"], 0)
        background = away.folder / "pictures" / "view_00000.png"
        camera = self.camera(CAMERA.replace("[cloth]", f'[cloth]\nbackground = "{background}"'), "taken")
        taken = self.observe(seen.folder / "pictures", camera, "taken")
        again = json.loads((taken.folder / "statistics.json").read_text())
        for name in ("area", "elongation_ratio", "orientation", "x", "y"):
            self.assertAlmostEqual(again[name]["mean"], statistics[name]["mean"], delta=2e-3 * abs(statistics[name]["mean"]) + 1e-4)

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
