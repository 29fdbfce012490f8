"""Scenes from tables of the scene format, without a file."""

import os
import shutil
import sys
import unittest

import numpy as np

import lightwell as lw
from scenes import SOURCE, box, scratch

PANEL = os.path.join("examples", "office", "luminaires", "panel.ies")
DATA = os.path.join(SOURCE, "tests", "data", "scene")
VERTICES, FACES = box(high=(4, 3, 2.5))
NAMES = ["west", "east", "south", "north", "floor", "ceiling"]
LAMP = {"name": "panel", "file": PANEL, "position": (2, 1.5, 2.45), "aim": (0, 0, -1)}
SKY = {"kind": "cie-overcast", "up": [0, 0, 1], "illuminance": 10000}
GRID = {"name": "task area", "surface": "floor", "height": 0.75, "margin": 0.5}


def room(**options):
    options = {"names": NAMES, "reflectance": 0.5, "folder": SOURCE, **options}
    return lw.Scene.from_arrays(VERTICES, FACES, **options)


class WholeRooms(unittest.TestCase):
    @unittest.skipUnless(sys.version_info >= (3, 11), "tomllib came with Python 3.11")
    def test_every_key_of_a_file_as_dictionaries(self):
        import tomllib

        for name, folder in (
            ("everything.toml", DATA),
            ("room.toml", os.path.join(SOURCE, "examples", "room")),
            ("office.toml", os.path.join(SOURCE, "examples", "office")),
        ):
            with self.subTest(name):
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    tables = tomllib.load(file)
                theirs, ours = lw.read(path), lw.Scene.from_tables(tables, folder=folder)
                self.assertEqual(ours._data.hash, theirs._data.hash)
                self.assertEqual(ours.cameras, theirs.cameras)
                self.assertEqual(ours.lamps, theirs.lamps)
                self.assertEqual(ours.notes, theirs.notes)
                self.assertEqual(ours.file, "")

    def test_a_saved_scene_is_the_scene_again(self):
        folder = scratch(self)
        shutil.copy(os.path.join(SOURCE, PANEL), os.path.join(folder, "panel.ies"))
        floor = {"name": 'a "floor"\x7f', "material": "grey", "polygon": VERTICES[FACES[4]]}
        tables = {
            "materials": {"grey": lw.Material(reflectance=0.5)},
            "surfaces": [floor],
            "lamps": [{**LAMP, "file": "panel.ies"}],
            "cameras": lw.Camera((1, 1, 1), (2, 1, 0)),
        }
        scene = lw.Scene.from_tables(tables, folder=folder)
        path = os.path.join(folder, "room.toml")
        scene.save(path)
        again = lw.read(path)
        self.assertEqual(again._data.hash, scene._data.hash)
        self.assertEqual(again.cameras, scene.cameras)
        self.assertEqual(again.names, scene.names)
        for made, name, sentence in (
            (scene, os.path.join(folder, "room.obj"), "must end in .toml"),
            (scene, os.path.join(scratch(self), "room.toml"), "save the scene there"),
            (again, path, "only a scene of from_tables"),
            (room(), path, "only a scene of from_tables"),
        ):
            with self.subTest(sentence), self.assertRaisesRegex(lw.InputError, sentence):
                made.save(name)

    def test_lamps_sky_and_grids_beside_arrays(self):
        grey = {"name": "grey", "reflectance": 0.5}
        options = {"reflectance": None, "materials": grey, "lamps": LAMP, "grids": GRID, "title": "made here"}
        scene = room(**options, sky=SKY)
        tables = {
            "title": "made here",
            "materials": {"grey": {"reflectance": 0.5}},
            "surfaces": [
                {"name": name, "material": "grey", "polygon": VERTICES[face]} for name, face in zip(NAMES, FACES)
            ],
            "lamps": [LAMP],
            "sky": SKY,
            "grids": [GRID],
        }
        same = lw.Scene.from_tables(tables, folder=SOURCE)
        self.assertEqual(scene._data.hash, same._data.hash)
        self.assertEqual(scene.lamps, ["panel"])
        self.assertEqual(scene.title, "made here")
        solution = lw.solve(scene, refine="off", gather_rays=16)
        figures = solution.report(rays=16)
        (grid,) = figures["surfaces"]
        self.assertEqual(grid["name"], "task area")
        self.assertEqual(figures["luminaires"][0]["watts"], 30)  # of the photometric file
        self.assertNotEqual(room(**options)._data.hash, scene._data.hash)

    def test_materials_by_their_keys(self):
        glass = {"name": "glass", "glass": {"ior": 1.5}}
        lamp = {"name": "lamp", "lumens": 800, "reflectance": 0}
        scene = room(reflectance=None, materials=[glass, lamp, lamp] + [lw.Material(reflectance=0.3)] * 3)
        # 800 lm over the two faces of 4 x 2.5 and 3 x 2.5 square metres at 683 lm/W; floats.
        area = 3 * 2.5 + 4 * 2.5
        np.testing.assert_allclose(scene.materials[1].emission, 800 / 683 / area, rtol=4 * 2.0**-24)
        self.assertEqual([material.name for material in scene.materials[:3]], ["glass", "lamp", "lamp"])
        self.assertAlmostEqual(scene.materials[5].reflectance[0], 0.3, delta=2.0**-24)

    def test_pictures_on_arrays(self):
        picture = os.path.join(DATA, "two-pixels.png")
        tiles = {"name": "tiles", "texture": picture, "reflectance": 0.9}
        uv = VERTICES[:, :2] / [4, 3]
        scene = room(reflectance=None, materials=tiles, uv=uv)
        tables = {
            "materials": {"tiles": {"texture": picture, "reflectance": 0.9}},
            "surfaces": [
                {"name": name, "material": "tiles", "polygon": VERTICES[face], "uv": uv[face]}
                for name, face in zip(NAMES, FACES)
            ],
        }
        self.assertEqual(scene._data.hash, lw.Scene.from_tables(tables)._data.hash)
        flat = room(reflectance=None, materials=tiles)
        self.assertNotEqual(scene._data.hash, flat._data.hash)
        self.assertTrue(any("texture" in note for note in flat.notes), flat.notes)

    def test_rows_of_view_factors_are_the_polygons(self):
        tables = {
            "materials": {"grey": lw.Material(reflectance=0.5)},
            "surfaces": [{"name": "room", "material": "grey", "polygons": VERTICES[FACES]}],
        }
        ours = lw.form_factors(lw.Scene.from_tables(tables), method="analytic")
        theirs = lw.form_factors(room(), method="analytic")
        self.assertEqual(ours.matrix.toarray().tobytes(), theirs.matrix.toarray().tobytes())

    def test_cameras_and_motions(self):
        slide = {"keys": [{"time": 0}, {"time": 1, "translate": (0.5, 0, 0)}]}
        camera = lw.Camera((1, 1, 1), (2, 1, 1), motion="slide", shutter=(0, 0.5))
        scene = room(cameras=camera, tables={"motions": {"slide": slide}})
        self.assertEqual(scene.cameras[0].motion, "slide")
        self.assertEqual(scene.cameras[0].shutter, (0, 0.5))
        # Moved to its pose at 0.25 s and back, by 0.125 m: rounding of 2 x 2^-53.
        np.testing.assert_allclose(scene.cameras[0].position, (1, 1, 1), rtol=2.0**-51)


class Refused(unittest.TestCase):
    def test_with_a_sentence(self):
        grey = {"name": "grey", "reflectance": 0.5}
        deep: list = []
        for _ in range(5000):
            deep = [deep]
        for options, sentence in (
            ({"grids": {"surface": "floor", "height": deep}}, "more than 100 levels"),
            ({"sky": {"kind": "\ud800"}}, "half of a pair of surrogates"),
            ({"lamps": {"postion": (0, 0, 1), "lumens": 1}}, "unknown key 'postion'.*position"),
            ({"lamps": {"file": "none.ies", "position": (1, 1, 1)}}, "none.ies: there is no such file"),
            ({"lamps": "panel.ies"}, "lamps is 'panel.ies'; a list of dictionaries is needed"),
            ({"lamps": ["panel.ies"]}, r"lamps\[0\] is 'panel.ies'"),
            ({"sky": {"kind": "blue"}}, "kind of sky is 'blue'"),
            ({"sky": "cie-clear"}, "sky is 'cie-clear'; a dictionary"),
            ({"grids": {"surface": "flor", "height": 1}}, "'flor'.*'floor'"),
            ({"grids": {"surface": "floor", "height": 1j}}, "type complex"),
            ({"grids": {"surface": "floor", "height": 2**70}}, "beyond 64 bits"),
            ({"grids": {1: "floor"}}, "the key 1 is no text"),
            ({"tables": {"lamps": []}}, "tables has 'lamps'"),
            ({"materials": {"reflectance": 0.5}, "reflectance": None}, "has no name"),
            ({"materials": [grey, {**grey, "reflectance": 0.1}] * 3, "reflectance": None}, "two materials have the name"),
            ({"materials": grey}, "reflectance and emission go with"),
            ({"uv": np.zeros((3, 2))}, r"uv has the shape \(3, 2\); \(8, 2\)"),
            ({"normals": np.full((8, 3), np.nan)}, "normals has a number that is not finite"),
        ):
            with self.subTest(options), self.assertRaisesRegex(lw.InputError, sentence):
                room(**options)

    def test_tables_of_a_whole_scene(self):
        floor = {"name": "floor", "material": "grey", "polygon": VERTICES[FACES[4]]}
        tables = {"materials": {"grey": {"reflectance": 0.5}}, "surfaces": [floor]}
        view = lw.Camera((1, 1, 1), (2, 1, 1))
        for change, sentence in (
            ({"surfaces": []}, "surfaces is empty"),
            ({"materials": {}}, "'grey'"),
            ({"unit": "mm", "cameras": [view]}, "has metres, and these tables another unit"),
        ):
            with self.subTest(change), self.assertRaisesRegex(lw.InputError, sentence):
                lw.Scene.from_tables({**tables, **change})
        with self.assertRaisesRegex(lw.InputError, "a dictionary with the keys"):
            lw.Scene.from_tables([])
        self.assertEqual(lw.Scene.from_tables({**tables, "cameras": view}).cameras[0].name, "camera")

    def test_files_outside_of_the_folder_where_asked(self):
        floor = {"name": "floor", "material": "grey", "polygon": VERTICES[FACES[4]]}
        tables = {"materials": {"grey": {"reflectance": 0.5}}, "surfaces": [floor], "lamps": [{**LAMP, "file": os.path.join(SOURCE, PANEL)}]}
        empty = scratch(self)
        self.assertEqual(lw.Scene.from_tables(tables, folder=empty).lamps, ["panel"])
        with self.assertRaisesRegex(lw.Error, "outside of its folder"):
            lw.Scene.from_tables(tables, folder=empty, inside_folder=True)


if __name__ == "__main__":
    unittest.main()
