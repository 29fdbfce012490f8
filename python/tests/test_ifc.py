"""IFC models: the light of the same room as a scene file."""

import contextlib
import importlib.util
import io
import os
import unittest

import numpy as np

import lightwell as lw
from scenes import SOURCE, scratch

PANEL = os.path.join(SOURCE, "examples", "office", "luminaires", "panel.ies")
IS_THERE = importlib.util.find_spec("ifcopenshell") is not None

# The room of ifc_room.py by hand: reflectances of floor, walls and ceiling, and its lamps.
ROOM = """
unit = "m"
materials.floor = {{ reflectance = {floor} }}
materials.walls = {{ reflectance = {walls} }}
materials.ceiling = {{ reflectance = {ceiling} }}

[[surfaces]]
name = "floor"
material = "floor"
polygon = [[0, 0, 0], [5, 0, 0], [5, 4, 0], [0, 4, 0]]

[[surfaces]]
name = "ceiling"
material = "ceiling"
polygon = [[0, 0, 3], [0, 4, 3], [5, 4, 3], [5, 0, 3]]

[[surfaces]]
name = "walls"
material = "walls"
polygons = [
  [[0, 0, 0], [0, 0, 3], [5, 0, 3], [5, 0, 0]], [[5, 0, 0], [5, 0, 3], [5, 4, 3], [5, 4, 0]],
  [[5, 4, 0], [5, 4, 3], [0, 4, 3], [0, 4, 0]], [[0, 4, 0], [0, 4, 3], [0, 0, 3], [0, 0, 0]],
]
"""
LAMP = """
[[lamps]]
file = "{file}"
position = [{at[0]}, {at[1]}, {at[2]}]
aim = [0, 0, -1]
"""
POINTS = np.array([[x, y, 0.8] for x in (0.7, 2.5, 4.1) for y in (0.6, 2.3)])


def linear(value):
    """sRGB above 0.04045 (IEC 61966-2-1)."""
    return ((value + 0.055) / 1.055) ** 2.4


@unittest.skipUnless(IS_THERE, "ifcopenshell is not installed")
class FromIfc(unittest.TestCase):
    def setUp(self):
        import ifc_room

        self.room = ifc_room
        self.folder = scratch(self)
        self.table = self.write("fixtures.csv", f"fixture,file\nPanel*,{PANEL}\n")

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def from_ifc(self, model, **options):
        model.file.write(self.path("model.ifc"))
        options.setdefault("fixtures", self.table)
        return lw.from_ifc(self.path("model.ifc"), self.path("model.toml"), **options)

    def by_hand(self, floor, walls, ceiling):
        lamps = "".join(LAMP.format(file=PANEL, at=at) for at in self.room.LAMPS)
        return lw.read(self.write("hand.toml", ROOM.format(floor=floor, walls=walls, ceiling=ceiling) + lamps))

    def measure(self, scene, **options):
        return lw.solve(scene, **options).measure(POINTS, (0, 0, 1), rays=256)

    def test_light_of_lamps_alone_is_that_of_the_same_room(self):
        black = self.write("black.csv", "material,reflectance\n*,0\n")
        theirs = self.measure(self.by_hand(0, 0, 0), accuracy="5%").lux
        for options in ({"unit_metres": 1e-3}, {"schema": "IFC2X3"}):
            with self.subTest(options):
                ours = self.measure(self.from_ifc(self.room.room(**options), materials=black), accuracy="5%").lux
                # Positions are rounded to 1e-9 m, and light is summed in single precision: 64 terms of
                # 2^-24 for the parts of two openings.
                np.testing.assert_allclose(ours, theirs, rtol=64 * 2.0**-24)
                self.assertGreater(ours.min(), 50)

    def test_reflected_light_is_that_of_the_same_room_within_both_bounds(self):
        scene = self.from_ifc(self.room.room())
        ours = self.measure(scene, accuracy="5%")
        floor = linear(self.room.FLOOR_COLOUR)
        theirs = self.measure(self.by_hand(floor, self.room.WALL, self.room.CEILING), accuracy="5%")
        # A bound holds with odds of 19 to 1, two standard errors: twice the sum of both is more than
        # four standard errors of the difference.
        far = np.abs(ours.lux - theirs.lux) / (ours.lux_within + theirs.lux_within)
        self.assertLess(far.max(), 2.0)
        # Walls of another reflectance are told apart: the bounds are a few percent.
        other = self.measure(self.by_hand(floor, 0.1, self.room.CEILING), accuracy="5%")
        self.assertGreater((np.abs(other.lux - theirs.lux) / (other.lux_within + theirs.lux_within)).min(), 2.0)

    def test_openings_are_cut(self):
        model = self.room.room()
        whole = dict(zip(*(lambda s: (s.names, s.areas))(self.from_ifc(model))))
        self.room.cut(model, "south", (1, -0.3, 1), (2, 0.1, 2.5))
        scene = self.from_ifc(model)
        opened = dict(zip(scene.names, scene.areas))
        self.assertEqual(scene.losses, [])
        (south,) = [name for name in whole if "south" in name]
        # Both faces lose 1 m x 1.5 m and the reveal gains 2 (1 + 1.5) m x 0.2 m. Coordinates have nine
        # decimals: 1e-9 m along 20 m of edges.
        self.assertAlmostEqual(opened[south] - whole[south], -2 * 1.5 + 5 * 0.2, delta=2e-8)

    def test_a_pane_passes_what_its_style_says(self):
        model = self.room.room()
        pane = model.box("IfcWindow", "pane", (1, 1, 1), (2, 1.01, 2))
        model.coloured(pane, "glass", 1.0, transparency=0.64)
        self.from_ifc(model)
        with open(self.path("model.toml"), encoding="utf-8") as file:
            text = file.read()
        # Each face passes 0.8, both 0.64; white reflects the rest.
        self.assertIn('[materials."glass"]\nreflectance = [0.2, 0.2, 0.2]\ntransparent = 0.8', text)

    def test_spaces_are_measured_and_what_is_missing_is_told(self):
        model = self.room.room()
        plain = model.box("IfcFurniture", "desk", (1, 1, 0), (2, 2, 0.7))
        scene = self.from_ifc(model, height=1.2)
        self.assertTrue(any("IfcFurniture without colour" in note for note in scene.notes), plain)
        self.assertEqual(len(scene.lamps), 2)
        figures = lw.solve(scene, refine="off", gather_rays=16).report(rays=16)
        (grid,) = figures["surfaces"]
        self.assertRegex(grid["name"], "^office")
        # A working plane of 5 m x 4 m without half a metre along its walls.
        self.assertAlmostEqual(grid["area_m2"], 4 * 3, delta=1e-6)
        dark = self.from_ifc(model, fixtures=None)
        self.assertEqual(dark.lamps, [])
        self.assertEqual(sum("gives no light" in note for note in dark.notes), 2)
        table = self.write("other.csv", f"fixture,file\nSpot,{PANEL}\n*,{PANEL}\n")
        self.assertTrue(any("Spot: no light fixture" in note for note in self.from_ifc(model, fixtures=table).notes))

    def test_wrong_input_is_refused_with_a_sentence(self):
        self.room.room().file.write(self.path("room.ifc"))
        empty = self.room.Model()
        empty.file.write(self.path("empty.ifc"))
        self.write("text.ifc", "no model")
        tables = {
            "columns.csv": ("fixture\nPanel\n", r"columns.csv:1: there is no column 'file'"),
            "missing.csv": ("fixture,file\nPanel,none.ies\n", r"missing.csv:2: there is no file"),
            "extra.csv": (f"fixture,file,size\nPanel,{PANEL},1\n", "no column 'size'"),
            "number.csv": (f"fixture,file,lumens\nPanel,{PANEL},many\n", "lumens is 'many'"),
            "hole.csv": ("fixture,file\nPanel,\n", "needs fixture and file"),
        }
        for name, (text, sentence) in tables.items():
            with self.subTest(name), self.assertRaisesRegex(lw.InputError, sentence):
                lw.convert_ifc(self.path("room.ifc"), self.path("r.toml"), fixtures=self.write(name, text))
        white = self.write("white.csv", "material,reflectance\n*,1.5\n")
        for name, options, sentence in (
            ("room.ifc", {"materials": white}, "white.csv:2: reflectance is 1.5"),
            ("room.ifc", {"height": -1}, "height is -1"),
            ("empty.ifc", {}, "no element has a surface"),
            ("text.ifc", {}, "no IFC file"),
            ("none.ifc", {}, "there is no such file"),
        ):
            with self.subTest(sentence), self.assertRaisesRegex(lw.InputError, sentence):
                lw.convert_ifc(self.path(name), self.path("r.toml"), **options)
        with self.assertRaisesRegex(lw.InputError, "must end in .toml"):
            lw.convert_ifc(self.path("room.ifc"), self.path("r.obj"))
        self.assertFalse(os.path.exists(self.path("r.toml")))

    def test_the_command_writes_the_scene(self):
        from lightwell.ifc import main

        self.room.room().file.write(self.path("room.ifc"))
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(main([self.path("room.ifc"), "-o", self.path("r.toml"), "--fixtures", self.table]), 0)
            self.assertEqual(main([self.path("none.ifc"), "-o", self.path("r.toml")]), 3)
        self.assertRegex(errors.getvalue(), "error: .*there is no such file")
        self.assertEqual(len(lw.read(self.path("r.toml")).lamps), 2)


@unittest.skipIf(IS_THERE, "ifcopenshell is installed")
class WithoutIfcOpenShell(unittest.TestCase):
    def test_says_what_to_install(self):
        with self.assertRaisesRegex(lw.Error, "pip install"):
            lw.convert_ifc("room.ifc", "room.toml")


if __name__ == "__main__":
    unittest.main()
