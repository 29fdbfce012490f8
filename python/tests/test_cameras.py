"""Cameras: every key of the scene format, with the bits of the command line."""

import json
import os
import unittest

import numpy as np

import lightwell as lw
from scenes import lit_room, run_program, scratch

ROOM = """
[motions.slide]
keys = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [0.4, 0.2, 0] }]

[materials.white]
reflectance = 0.6
[materials.lamp]
exitance = 40

[[surfaces]]
name = "room"
material = "white"
box = { min = [0, 0, 0], max = [4, 3, 2.5], inward = true }
[[surfaces]]
name = "panel"
material = "lamp"
polygon = [[1.5, 1, 2.4], [1.5, 2, 2.4], [2.5, 2, 2.4], [2.5, 1, 2.4]]
[[surfaces]]
name = "box"
material = "white"
motion = "slide"
box = { min = [2, 1, 0], max = [2.6, 1.6, 0.7] }
"""

# Keys of a scene file, and the same camera in Python.
KINDS = {
    "plain": ("fov = 60", {"fov": 60}),
    "lens by f-number": (
        "fov = 60\nf_number = 0.4\nfocus_distance = 2.0",
        {"fov": 60, "f_number": 0.4, "focus_distance": 2.0},
    ),
    "lens by radius": (
        "aperture_radius = 0.05\nfocus_distance = 1.5\nblades = 5",
        {"aperture_radius": 0.05, "focus_distance": 1.5, "blades": 5},
    ),
    "section": ("fov = 90\nnear = 0.9\nfar = 2.2", {"fov": 90, "near": 0.9, "far": 2.2}),
    "shift": ("fov = 70\nshift = [0.1, -0.3]", {"fov": 70, "shift": (0.1, -0.3)}),
    "crop": ("fov = 70\ncrop = [0.25, 0.1, 0.8, 0.7]", {"fov": 70, "crop": (0.25, 0.1, 0.8, 0.7)}),
    "distortion": (
        "fov = 80\ndistortion = { k1 = -0.2, k2 = 0.03, k3 = 0.001, p1 = 0.002, p2 = -0.001 }",
        {"fov": 80, "distortion": (-0.2, 0.03, 0.001, 0.002, -0.001)},
    ),
    "orthographic": ('projection = "orthographic"\nview_width = 3.0', {"projection": "orthographic", "view_width": 3.0}),
    "fisheye": (
        'projection = "fisheye"\nfov = 150\ncircle = 170',
        {"projection": "fisheye", "fov": 150, "circle": 170},
    ),
    "equisolid": ('projection = "equisolid"', {"projection": "equisolid"}),
    "hemispherical": ('projection = "hemispherical"', {"projection": "hemispherical"}),
    "stereographic": ('projection = "stereographic"\nfov = 200', {"projection": "stereographic", "fov": 200}),
    "cylindrical": ('projection = "cylindrical"\nfov = 100', {"projection": "cylindrical", "fov": 100}),
    "equirectangular": (
        'projection = "equirectangular"\nsize = [32, 16]',
        {"projection": "equirectangular", "width": 32, "height": 16},
    ),
    "stereo": (
        'projection = "stereo"\nsize = [32, 32]\neye_separation = 0.1',
        {"projection": "stereo", "width": 32, "height": 32, "eye_separation": 0.1},
    ),
    "cube": ('projection = "cube"\nsize = [24, 16]', {"projection": "cube", "width": 24, "height": 16}),
    "shutter": ("fov = 60\nshutter = [0.3, 0.7]", {"fov": 60, "shutter": (0.3, 0.7)}),
    "moving": ('fov = 60\nshutter = [0.3, 0.7]\nmotion = "slide"', {"fov": 60, "shutter": (0.3, 0.7), "motion": "slide"}),
}
PLACE = {"position": (0.8, 0.7, 1.2), "target": (3.0, 2.0, 1.0)}


def camera(name, options):
    return lw.Camera(**{"width": 32, "height": 24, **PLACE, **options}, name=name)


def table(name, keys):
    size = "" if "size" in keys else "size = [32, 24]\n"
    place = "position = [0.8, 0.7, 1.2]\nlook_at = [3.0, 2.0, 1.0]\nup = [0, 0, 1]\n"
    return f'[[cameras]]\nname = "{name}"\n{place}{size}{keys}\n'


class EveryKind(unittest.TestCase):
    def setUp(self):
        self.folder = scratch(self)
        self.file = os.path.join(self.folder, "room.toml")
        with open(self.file, "w", encoding="utf-8") as file:
            file.write(ROOM + "".join(table(name, keys) for name, (keys, _) in KINDS.items()))

    def test_pictures_have_the_bits_of_the_command_line(self):
        scene = lw.read(self.file)
        solution = lw.solve(scene, refine="off", gather_rays=16, max_patch_size=1.0)
        vtp = os.path.join(self.folder, "room.vtp")
        solution.save(vtp)
        seen = []
        for name, (_, options) in KINDS.items():
            with self.subTest(name):
                theirs, ours = (os.path.join(self.folder, f"{who}.exr") for who in ("theirs", "ours"))
                run_program("render", self.file, vtp, "--camera", name, "--quality", "draft", "-o", theirs)
                picture = solution.render(camera(name, options), quality="draft")
                lw.write_picture(ours, picture)
                compared = json.loads(run_program("compare", theirs, ours, "--json"))
                self.assertEqual(compared["rmse"], 0.0)
                self.assertEqual(picture.tobytes(), solution.render(name, quality="draft").tobytes())
                self.assertGreater(picture.max(), 0.0)
                seen.append(picture.tobytes())
        self.assertEqual(len(set(seen)), len(seen))

    def test_cameras_of_a_scene_give_the_same_cameras_again(self):
        scene = lw.read(self.file)
        again = lw.read(self.file)
        solution = lw.solve(scene, refine="off", gather_rays=16, max_patch_size=1.0)
        for made, (name, (_, options)) in zip(again.cameras, KINDS.items()):
            with self.subTest(name):
                self.assertEqual(made.name, name)
                for key, value in options.items():
                    if key == "f_number":  # which is kept as the radius of the lens: 18 mm / tan(30 degrees) / (2 f)
                        key, value = "aperture_radius", 0.018 / np.tan(np.radians(30)) / (2 * value)
                    if key == "crop":  # whose edges move to whole pixels of 32 x 24
                        value = (8 / 32, 2 / 24, 26 / 32, 17 / 24)
                    got = getattr(made, key)
                    if isinstance(value, str):
                        self.assertEqual(got, value)
                    else:
                        # Written, read and divided once each: a few units of 2^-53.
                        np.testing.assert_allclose(got, value, rtol=1e-14)
                one, two = (solution.render(each, quality="draft") for each in (made, camera(name, options)))
                # Points of view differ by rounding, 1e-15 of a metre, which moves an edge across a pixel's
                # sample with odds of 1e-13.
                np.testing.assert_allclose(one, two, rtol=1e-5, atol=1e-6)


class Refused(unittest.TestCase):
    def test_with_a_sentence(self):
        lens = {"aperture_radius": 0.1, "focus_distance": 1}
        for options, sentence in (
            ({"projection": "flat"}, "projection of camera .* is 'flat'; choose 'perspective'"),
            ({"projection": "orthographic"}, "view_width"),
            ({"projection": "orthographic", "view_width": 2, "fov": 40}, "fov.*has no effect"),
            ({"view_width": 2}, "view_width.*has no effect"),
            ({"circle": 180}, "circle.*has no effect"),
            ({"eye_separation": 0.06}, "eye_separation.*has no effect"),
            ({"near": -1}, "near .*is -1"),
            ({"near": 2, "far": 1}, "the end must lie behind the beginning"),
            ({"crop": (0.5, 0, 0.2, 1)}, "rising order"),
            ({"crop": (0, 0, 1)}, "crop has 3 numbers; 4 are needed"),
            ({"shift": (1,)}, "shift has 1 numbers; 2 are needed"),
            ({"shift": 1}, "shift is 1; 2 numbers are needed"),
            ({"distortion": (1, 2)}, "distortion has 2 numbers"),
            ({"shift": (float("nan"), 0)}, "shift is nan"),
            ({"distortion": (0.1, 0, 0, 0, 0), "projection": "fisheye"}, "only perspective cameras"),
            ({"aperture_radius": 0.1}, "focus_distance"),
            ({"focus_distance": 1}, "needs a lens"),
            ({**lens, "f_number": 2}, "second statement of the aperture"),
            ({**lens, "blades": 2}, "blades is 2"),
            ({"shutter": (2, 1)}, "before it has opened"),
            ({"motion": "slide"}, "not among the motions"),
            ({"position": (1, 1)}, "position has 2 numbers; 3 are needed"),
            ({"target": (1, 1, 1)}, "is the camera's own position"),
            ({"target": (1, 1, 2)}, "parallel to the viewing direction"),
        ):
            with self.subTest(options), self.assertRaisesRegex(lw.InputError, sentence):
                place = {"position": (1, 1, 1), "target": (2, 1, 1), "name": "c"}
                lit_room(cameras=lw.Camera(**{**place, **options}))

    def test_a_shutter_at_another_time_than_the_light(self):
        file = os.path.join(scratch(self), "room.toml")
        with open(file, "w", encoding="utf-8") as text:
            text.write(ROOM + table("c", "shutter = [0.3, 0.7]"))
        solution = lw.solve(lw.read(file), refine="off", gather_rays=16, max_patch_size=1.0)
        with self.assertRaisesRegex(lw.InputError, "middle is at 0.1 s, and light is solved for 0.5 s"):
            solution.render(camera("c", {"shutter": (0.0, 0.2)}), quality="draft")


if __name__ == "__main__":
    unittest.main()
