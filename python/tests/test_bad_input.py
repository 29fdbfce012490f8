"""Wrong input is refused with a sentence, and never crashes."""

import os
import unittest

import numpy as np

import lightwell as lw
from scenes import CORNELL, box, lit_room, scratch

VERTICES, FACES = box()


def changed(array, index, value):
    array = np.array(array)
    array[index] = value
    return array


class BadInput(unittest.TestCase):
    def assert_refused(self, pattern, call, *arguments, **options):
        with self.assertRaisesRegex(lw.InputError, pattern):
            call(*arguments, **options)

    def test_vertices(self):
        for bad, pattern in (
            (VERTICES[:, :2], r"shape \(8, 2\)"),
            (VERTICES[0], r"shape \(3,\)"),
            ([[0, 0, 0], [1, 0]], "no array of numbers"),
            ("room.stl", "elements of type"),
            (None, "elements of type"),
            (VERTICES * 1j, "elements of type complex"),
            (VERTICES.astype(str), "elements of type"),
            (changed(VERTICES, (3, 1), np.nan), "row 3 has a coordinate"),
            (changed(VERTICES, (3, 1), np.inf), "row 3 has a coordinate"),
            (VERTICES * 1e10, "nothing may lie beyond"),
            (VERTICES * 1e-12, "check the unit"),
            (np.zeros((0, 3)), "names vertex"),
        ):
            with self.subTest(pattern):
                self.assert_refused(pattern, lw.Scene.from_arrays, bad, FACES)

    def test_faces(self):
        for bad, pattern in (
            (FACES[:, :2], r"shape \(6, 2\)"),
            (FACES[0], r"shape \(4,\)"),
            (FACES.astype(float), "integers are needed"),
            (changed(FACES, (2, 3), 8), "face 2 names vertex 8, but there are 8"),
            (changed(FACES, (2, 3), -1), "face 2 names vertex -1"),
            (changed(FACES, (2, 3), 2**40), "beyond 2147483647"),
            ([[0, 1, 2], [3, "a", 5]], "face 1"),
            ([[0, 1, 2], 7], "face 1 has the shape"),
            (5, "no list of faces"),
            (np.zeros((0, 3), int), "no face has an area"),
            ([], "no face has an area"),
            ([[0, 1, 1]], "no face has an area"),
            ([[0, 1]], "no face has an area"),
        ):
            with self.subTest(pattern):
                self.assert_refused(pattern, lw.Scene.from_arrays, VERTICES, bad)

    def test_surfaces_and_materials(self):
        for options, pattern in (
            ({"surface": [0, 1]}, "2 entries for 6 faces"),
            ({"surface": [0, 0, 0, 0, 0, -1]}, "is of surface -1"),
            ({"surface": [0, 0, 0, 0, 0, 10**9]}, "number 1000000000, but 6 faces"),
            ({"cameras": ["door"]}, "list of lightwell.Camera"),
            ({"surface": [0.0] * 6}, "integers are needed"),
            ({"names": ["a", "b"]}, "2 entries for 1 surfaces"),
            ({"reflectance": 1.5}, "between 0 and 1|above 1|\\[0"),
            ({"reflectance": np.nan}, "finite number is needed"),
            ({"reflectance": [0.1, 0.2]}, "2 entries for 1"),
            ({"reflectance": "white"}, "a number is needed"),
            ({"emission": -1.0}, "emi"),
            ({"materials": "white"}, "lightwell.Material"),
            ({"materials": [lw.Material()] * 2}, "2 entries for 1"),
            ({"materials": lw.Material(reflectance=(0.1, 0.2))}, "has 2 values"),
            ({"materials": lw.Material(reflectance=0.8, specular=0.8)}, "material"),
            ({"cameras": [lw.Camera((0, 0, 0), (0, 0, 0))]}, "own position"),
            ({"cameras": [lw.Camera((0, 0, 0), (1, 0, 0), width=0)]}, "width is 0"),
            ({"cameras": [lw.Camera((0, 0), (1, 0, 0))]}, "position has 2 numbers"),
            ({"cameras": [lw.Camera((0, 0, 0), (1, 0, 0), projection="flat")]}, "is 'flat'; choose"),
            ({"cameras": [lw.Camera((0, 0, 0), (1, 0, 0), fov=180)]}, "camera"),
        ):
            with self.subTest(options):
                self.assert_refused(pattern, lw.Scene.from_arrays, VERTICES, FACES, **options)

    def test_files(self):
        folder = scratch(self)
        self.assert_refused("nowhere.toml", lw.read, os.path.join(folder, "nowhere.toml"))
        self.assert_refused("", lw.read, folder)
        broken = os.path.join(folder, "broken.toml")
        with open(broken, "w") as file:
            file.write("[[surfaces]\n")
        self.assert_refused("broken.toml", lw.read, broken)
        self.assert_refused("", lw.load, CORNELL)
        lit = lw.solve(lit_room(), refine="off", gather_rays=16)
        with self.assertRaisesRegex(lw.Error, "nowhere"):
            lit.save(os.path.join(folder, "nowhere", "s.vtp"))
        self.assert_refused("must end in .vtp", lit.save, os.path.join(folder, "s.vtk"))
        lossy = lw.Scene.from_arrays(VERTICES, np.vstack([FACES, [0, 0, 1, 1]]), surface=[0] * 7)
        self.assertTrue(lossy.losses)

    def test_options_of_a_solve(self):
        scene = lit_room()
        for options, pattern in (
            ({"accuracy": "1"}, "would be 100 %"),
            ({"accuracy": 1}, "would be 100 %"),
            ({"accuracy": -0.01}, "no accuracy"),
            ({"accuracy": "good"}, "no accuracy"),
            ({"accuracy": [0.01]}, "accuracy"),
            ({"accuracy": 0.01, "gather_rays": 64}, "only one of the two"),
            ({"seconds": 5, "refine": 0.01}, "only one of the two"),
            ({"seconds": 0}, "seconds is 0"),
            ({"max_patch_size": -1}, "max_patch_size is -1"),
            ({"max_patch_size": "1 m"}, "max_patch_size is '1 m'"),
            ({"max_patch_size": np.nan}, "max_patch_size is nan"),
            ({"max_patch_size": 1e-6}, ""),
            ({"max_element_size": 0.1, "elements_per_patch_edge": 2}, "only one of them"),
            ({"elements_per_patch_edge": 0}, "from 1 to 64"),
            ({"elements_per_patch_edge": 2.5}, "elements_per_patch_edge is 2.5"),
            ({"rays": 100}, "power of two"),
            ({"gather_rays": 1 << 40}, "gather_rays"),
            ({"form_factors": "exact"}, "exact"),
            ({"solver": "exact"}, "no solver 'exact'"),
            ({"refine": "fine"}, "refine is 'fine'"),
            ({"channels": "each"}, "channels is 'each'"),
            ({"channels": {"a": "nothing*"}}, "nothing"),
            ({"memory": 0.5}, "memory is 0.5; a number of bytes from"),
            ({"memory": 1e30}, r"memory is 1e\+30; a number of bytes from"),
            ({"start_from": "s.vtp"}, "give a lightwell.Solution"),
            ({"progress": 3}, "give a function"),
            ({"hemicube_resolution": 3}, "even number"),
        ):
            with self.subTest(options):
                self.assert_refused(pattern, lw.solve, scene, **options)
        with self.assertRaises(TypeError):
            lw.solve(scene, accuraccy=0.01)
        self.assert_refused("give a lightwell.Scene", lw.solve, CORNELL)
        self.assert_refused("", lw.solve, lw.Scene.from_arrays(VERTICES, FACES))  # no light
        # Light that is never absorbed.
        endless = lw.Scene.from_arrays(VERTICES, FACES, reflectance=1.0, emission=1.0, surface=[0] * 6)
        self.assert_refused("", lw.solve, endless)

    def test_options_of_form_factors(self):
        scene = lw.Scene.from_arrays(VERTICES, FACES)
        for options in (
            {"method": "exact"},
            {"target_error": 0},
            {"target_error": "small"},
            {"max_patch_size": -1},
            {"hemicube_resolution": 7},
            {"two_sided": "yes"},
            {"progress": "bar"},
        ):
            with self.subTest(options):
                self.assert_refused("", lw.form_factors, scene, **options)
        self.assert_refused("give a lightwell.Scene", lw.form_factors, VERTICES)

    def test_points_and_pictures(self):
        solution = lw.solve(lit_room(), refine="off", gather_rays=16)
        for points, normals, pattern in (
            ([0, 0, 1], [0, 0, 1], "shape"),
            ([[0, 0, np.nan]], [0, 0, 1], "row 0"),
            ([[1, 1, 1]], [0, 0, 0], "a direction is zero"),
            ([[1, 1, 1]] * 3, [[0, 0, 1]] * 2, "2 rows for 3 points"),
            ([[1, 1, 1]], ["up"], "elements of type"),
        ):
            self.assert_refused(pattern, solution.probe, points, normals)
        self.assert_refused("by the name of a channel", solution.relight, "panel")
        self.assert_refused("rays is 100", solution.probe, [[1, 1, 1]], [0, 0, 1], rays=100)
        self.assert_refused("", solution.probe, [[9, 9, 9]], [0, 0, 1], interpolate=True)
        self.assert_refused("no camera", solution.render)
        camera = lw.Camera((1, 1, 1), (2, 2, 1))
        for options in (
            {"quality": "best"},
            {"pass_": "both"},
            {"width": 0},
            {"height": 4},
            {"width": 1 << 20},
            {"samples": -1},
            {"noise": "much"},
            {"photons": 1.5},
        ):
            with self.subTest(options):
                self.assert_refused("", solution.render, camera, **options)
        self.assert_refused("give a lightwell.Camera", solution.render, 3)
        self.assert_refused(r"\(4, 4\)", lw.tone_map, np.zeros((4, 4)))
        self.assert_refused("must end in", lw.write_picture, "p.bmp", np.zeros((4, 4, 3)))
        with self.assertRaisesRegex(lw.InputError, "made by"):
            lw.Scene("room")
        with self.assertRaisesRegex(lw.InputError, "made by"):
            lw.Solution("room")
        self.assertEqual(solution.probe(np.zeros((0, 3)), [0, 0, 1]).shape, (0, 3))


if __name__ == "__main__":
    unittest.main()
