"""IFC models: the light of the same room as a scene file."""

import contextlib
import importlib.util
import io
import os
import shutil
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
        # A working plane of 5 m x 4 m, with points from half a metre on from its walls.
        self.assertAlmostEqual(grid["area_m2"], 5 * 4, delta=1e-6)
        self.assertEqual(grid["margin_m"], 0.5)
        dark = self.from_ifc(model, fixtures=None)
        self.assertEqual(dark.lamps, [])
        self.assertEqual(sum("gives no light" in note for note in dark.notes), 2)
        table = self.write("other.csv", f"fixture,file\nSpot,{PANEL}\n*,{PANEL}\n")
        self.assertTrue(any("Spot: no light fixture" in note for note in self.from_ifc(model, fixtures=table).notes))

    def report_of(self, scene):
        return lw.solve(scene, refine="off", gather_rays=16).report(rays=16)["surfaces"]

    def text_of_scene(self):
        with open(self.path("model.toml"), encoding="utf-8") as file:
            return file.read()

    def test_grids_follow_the_footprint_of_an_l_with_a_hole(self):
        model = self.room.Model()
        outline = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 5), (0, 5)]
        shaft = [(3, 0.8), (3, 1.2), (3.4, 1.2), (3.4, 0.8)]
        model.prism("IfcSlab", "floor", outline, -0.2, 0)
        model.prism("IfcSlab", "ceiling", outline, 3, 3.2)
        model.prism("IfcSpace", "corner", outline, 0, 3, holes=[shaft])
        model.prism("IfcSpace", "hall", [(10, 0), (20, 0), (20, 8), (10, 8)], 0, 3)
        scene = self.from_ifc(model)
        self.assertTrue(any("hall" in note and "no slab" in note for note in scene.notes), scene.notes)
        lamp = "[[lamps]]\nposition = [1, 1, 2]\nlumens = 1000\n"  # without which there is nothing to solve
        self.write("lit.toml", self.text_of_scene() + lamp)
        (grid,) = self.report_of(lw.read(self.path("lit.toml")))
        # 6 x 2 and 2 x 3 less 0.4 x 0.4, margin included.
        self.assertAlmostEqual(grid["area_m2"], 18 - 0.16, delta=1e-6)
        self.assertEqual(grid["margin_m"], 0.5)
        text = self.text_of_scene()
        self.assertIn("outline = ", text)
        self.assertIn("holes = ", text)

    def test_a_space_of_two_parts_has_two_grids(self):
        model = self.room.room()
        (office,) = model.file.by_type("IfcSpace")
        model.file.remove(office)
        halves = model.prism("IfcSpace", "office", [(0, 0), (2, 0), (2, 4), (0, 4)], 0, 3)
        other = model.prism("IfcSpace", "other", [(3, 0), (5, 0), (5, 4), (3, 4)], 0, 3)
        solids = halves.Representation.Representations[0]
        solids.Items = [*solids.Items, *other.Representation.Representations[0].Items]
        model.file.remove(other)
        names = [grid["name"] for grid in self.report_of(self.from_ifc(model))]
        self.assertEqual(len(names), 2)
        self.assertEqual(names[1], names[0] + " part 2")

    def test_glass_passes_what_its_properties_say(self):
        model = self.room.room()
        pane = model.box("IfcWindow", "pane", (1, 1, 1), (2, 1.01, 2))
        model.properties(pane, "Pset_DoorWindowGlazingType", {"VisibleLightTransmittance": 0.6})
        plate = model.box("IfcPlate", "plate", (3, 1, 1), (4, 1.01, 2))
        model.optical([plate], "solar glass", 0.2, VisibleTransmittance=0.5)
        scene = self.from_ifc(model)
        found = {name: material for name, material in zip(scene.names, scene.materials)}
        (of_pane,) = [material for name, material in found.items() if "pane" in name]
        (of_plate,) = [material for name, material in found.items() if "plate" in name]
        for material, passed, reflected in ((of_pane, 0.6, 0.08), (of_plate, 0.5, 0.2)):
            # Two sheets that reflect r and pass t: T = t^2 / (1 - r^2), R = r (1 + T).
            r = reflected / (1 + passed)
            self.assertAlmostEqual(material.reflectance[0], r, delta=1e-6)  # six decimals in the file
            text = f"transparent = {round((passed * (1 - r * r)) ** 0.5, 6)!r}"
            self.assertIn(text, self.text_of_scene())
        table = self.write("glass.csv", "material,reflectance,transmittance\nsolar*,0.1,0.3\n*,0.5,\n")
        scene = self.from_ifc(model, materials=table)
        (of_plate,) = [material for name, material in zip(scene.names, scene.materials) if "plate" in name]
        self.assertAlmostEqual(of_plate.reflectance[0], 0.1 / 1.3, delta=1e-6)

    def test_doors_and_curtain_walls_are_surfaces(self):
        import ifcopenshell.api.aggregate as aggregate
        import ifcopenshell.api.root as root

        model = self.room.room()
        self.room.cut(model, "south", (1, -0.3, 0), (2, 0.1, 2))
        door = model.box("IfcDoor", "door", (1, -0.12, 0), (2, -0.08, 2))
        model.coloured(door, "oak", 0.6)
        wall = root.create_entity(model.file, ifc_class="IfcCurtainWall", name="curtain")
        parts = [
            model.box("IfcPlate", "panel", (4.9, 1, 0), (4.91, 2, 3)),
            model.box("IfcMember", "mullion", (4.88, 2, 0), (4.93, 2.05, 3)),
        ]
        aggregate.assign_object(model.file, products=parts, relating_object=wall)
        model.coloured(parts[0], "glass", 1.0, transparency=0.81)
        scene = self.from_ifc(model)
        for name in ("door", "panel", "mullion"):
            self.assertTrue(any(name in each for each in scene.names), name)
        self.assertEqual(scene.losses, [])
        self.assertIn("transparent = 0.9", self.text_of_scene())

    def test_fixtures_have_the_light_of_their_own_sources(self):
        model = self.room.Model()
        model.box("IfcSlab", "floor", (0, 0, -0.2), (5, 4, 0))
        # Lambert's cosine in cd/klm gives 1000 / pi of its lumens straight down, to 90 degrees.
        angles = np.arange(0.0, 90.1, 2.5)
        cosine = 1000 / np.pi * np.cos(np.radians(angles))
        half = model.distribution({0: (angles, cosine), 90: (angles, cosine), 180: (angles, cosine), 270: (angles, cosine)})
        model.light_source("downlight", (1, 2, 3), model.goniometric(half, flux=800.0, at=(0.5, 0, 0)))
        per_lumen = model.distribution({0: (angles, cosine / 1000)})
        # Its x axis points upwards and its z axis along -x, so it shines along +x.
        model.light_source("wall", (0, 2, 1.5), model.goniometric(per_lumen, flux=500.0), turn=[[0, 0, -1], [0, 1, 0], [1, 0, 0]])
        scene = self.from_ifc(model, fixtures=None)
        self.assertEqual(len(scene.lamps), 2, scene.notes)
        black = self.write("black.csv", "material,reflectance\n*,0\n")
        scene = self.from_ifc(model, fixtures=None, materials=black)
        solution = lw.solve(scene, refine="off", gather_rays=16)
        points = [(1.5, 2, 0.5), (2.0, 2.0, 1.5)]
        below, before = solution.lux_at(points, [(0, 0, 1), (-1, 0, 0)], rays=64)
        # E = flux / pi cos cos / d^2, with the cosines at the lamp and at the point.
        wall = 500 / np.pi * (1.5 / np.hypot(1.5, 1.0)) * (1.0 / np.hypot(1.5, 1.0)) / (1.5**2 + 1.0)
        # Intensities are linear between 2.5 degrees: up to (2.5 pi / 180)^2 / 8 of the cosine, 2.4e-4, too low.
        np.testing.assert_allclose(below, 800 / np.pi / 2.5**2 + wall, rtol=4e-4)
        down = np.array([2.0, 2.0, 1.5]) - np.array([1.5, 2, 3])
        cosines = (-down[2] / np.linalg.norm(down)) * (down[0] / np.linalg.norm(down))
        np.testing.assert_allclose(before, 500 / np.pi / 2.0**2 + 800 / np.pi * cosines / (down @ down), rtol=4e-4)

    def test_sources_of_types_a_and_b_have_the_light_of_the_same_web_in_lm63(self):
        def intensity(x, y, down):
            """cd/klm towards C0, C90 and the nadir; without light above."""
            return 400.0 * np.clip(down, 0.0, None) ** 2 * (1.0 + 0.5 * x + 0.3 * y)

        angles = np.arange(-90.0, 90.1, 2.5)

        def planes(kind):
            for main in np.radians(angles):
                sine, cosine = np.sin(np.radians(angles)), np.cos(np.radians(angles))
                across, down = cosine * np.sin(main), cosine * np.cos(main)
                yield intensity(across, sine, down) if kind == "TYPE_B" else intensity(-sine, across, down)

        c, gammas = np.arange(0.0, 360.1, 2.5), np.arange(0.0, 90.1, 2.5)
        lm63 = [intensity(np.sin(g) * np.cos(a), np.sin(g) * np.sin(a), np.cos(g))
                for a in np.radians(c) for g in [np.radians(gammas)]]  # fmt: skip
        rows = [" ".join(f"{value:.9g}" for value in row) for row in (gammas, c, *lm63)]
        text = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 %d %d 1 2 0 0 0\n1 1 0\n" % (len(gammas), len(c))
        self.write("web.ies", text + "\n".join(rows) + "\n")
        black = self.write("black.csv", "material,reflectance\n*,0\n")
        points = np.array([[x, y, 0.0] for x in (0.5, 2.0, 4.0) for y in (1.0, 2.0, 3.5)])
        found = {}
        for kind in ("TYPE_A", "TYPE_B", "lm63"):
            model = self.room.Model()
            model.box("IfcSlab", "floor", (0, 0, -0.2), (5, 4, 0))
            if kind == "lm63":
                data = model.file.createIfcDocumentReference("web.ies")
            else:
                data = model.distribution({main: (angles, row) for main, row in zip(angles, planes(kind))}, kind=kind)
            model.light_source("lamp", (2, 2, 2.5), model.goniometric(data, flux=1000.0))
            scene = self.from_ifc(model, fixtures=None, materials=black)
            self.assertEqual(len(scene.lamps), 1, scene.notes)
            found[kind] = lw.solve(scene, refine="off", gather_rays=16).lux_at(points, (0, 0, 1), rays=64)
        # Values are linear between 2.5 degrees in two angles. Second derivatives of the intensity are at most
        # 400 * 2 * 1.6 + 2 * 400 * 0.6 = 1760 per squared radian, so each of three interpolations (of the web in its
        # own type, of its conversion, of LM-63) is off by (2.5 pi / 180)^2 / 8 of that in each angle: 0.42 cd each,
        # within three times two of these, over the square of 2.5 m.
        within = 3 * 2 * 1760 * np.radians(2.5) ** 2 / 8 / 2.5**2
        for kind in ("TYPE_A", "TYPE_B"):
            np.testing.assert_allclose(found[kind], found["lm63"], rtol=0, atol=within)
        self.assertGreater(found["lm63"].min(), 4 * within)

    def test_half_of_a_symmetrical_source_is_all_of_it(self):
        from lightwell._ifc_lamps import _type_c_of

        def web(mains, inner):
            cosine = np.outer(np.cos(np.radians(mains)), np.cos(np.radians(inner)))
            return {float(main): (inner, row) for main, row in zip(mains, cosine)}

        whole, half = np.arange(-90.0, 91.0, 10.0), np.arange(0.0, 91.0, 10.0)
        for kind in ("TYPE_A", "TYPE_B"):
            all_planes, quarter = _type_c_of(kind, web(whole, whole)), _type_c_of(kind, web(half, half))
            self.assertEqual(list(all_planes), list(quarter))
            for main, (_, values) in all_planes.items():
                # The same products and sums of the same numbers, up to their order: units of 2^-53 of 1.
                np.testing.assert_allclose(quarter[main][1], values, atol=16 * 2.0**-53)

    def test_sources_that_give_no_light_say_why(self):
        model = self.room.Model()
        model.box("IfcSlab", "floor", (0, 0, -0.2), (5, 4, 0))
        file, white = model.file, model.file.createIfcColourRgb(None, 1.0, 1.0, 1.0)
        ambient = file.createIfcLightSourceAmbient(None, white, None, 1.0)
        flat = model.distribution({0: ([0, 90], [0.3, 0.0])}, kind="NOTDEFINED")
        beside = file.createIfcDocumentReference("panel.ies")
        for name, source in (
            ("ambient", ambient),
            ("b", model.goniometric(flat)),
            ("dark", model.goniometric(model.distribution({0: ([0, 90], [0.3, 0.0])}), flux=0.0)),
            ("turned", model.goniometric(model.distribution({10: ([0, 90], [0.3, 0.0])}))),
            ("missing", model.goniometric(beside)),
        ):
            model.light_source(name, (1, 1, 2), source)
        notes = "\n".join(self.from_ifc(model, fixtures=None).notes)
        for sentence in (
            "ambient .* gives no light: its IfcLightSourceAmbient has no photometry",
            "b .* gives no light: the intensities of its light source are of type NOTDEFINED",
            "dark .* gives no light: its light source has no luminous flux",
            "turned .* gives no light: the planes of its light source do not begin at C0",
            "missing .* the file of its light source, 'panel.ies', is not beside the model",
        ):
            self.assertRegex(notes, sentence)
        shutil.copy(PANEL, self.path("panel.ies"))
        scene = self.from_ifc(model, fixtures=None)
        self.assertEqual(len(scene.lamps), 1)
        self.assertIn('file = "panel.ies"', self.text_of_scene())

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
