"""Solutions: laws of light, arrays, readings, channels, files."""

import gc
import os
import unittest

import numpy as np

import lightwell as lw
from scenes import CORNELL, FLOAT, box, lit_room, scratch


def furnace(rho, emission):
    """A closed box of one material, black outside."""
    material = lw.Material(reflectance=rho, emission=emission, one_sided=True)
    return lw.Scene.from_arrays(*box(), materials=material, surface=[0] * 6)


class Laws(unittest.TestCase):
    def test_furnace(self):
        # In a closed room of one material B = M / (1 - rho) and E = B everywhere.
        for rho in (0.2, 0.5, 0.9):
            solution = lw.solve(furnace(rho, 10.0), refine="off")
            expected = 10.0 / (1 - rho)
            # The solver's tolerance, 1e-5, and 64 roundings of sums over some 1600 factors.
            tolerance = (1e-5 + 64 * FLOAT) * expected
            np.testing.assert_allclose(solution.patch_radiosity, expected, atol=tolerance)
            self.assertEqual(solution.outcome, "converged")

    def test_emitted_is_absorbed(self):
        energy = lw.solve(lit_room(), refine="off").energy
        # 30 W/m^2 in three bands from 1 m^2.
        self.assertAlmostEqual(energy["emitted"], 90.0, delta=90 * 8 * FLOAT)
        lost = energy["emitted"] - energy["absorbed"] - energy["escaped"] - energy["unshot"]
        # Sums of float32 factors over some 1600 patches: the error of the figure of the README, 1e-7,
        # times ten.
        self.assertAlmostEqual(lost, 0.0, delta=90 * 1e-6)


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = lw.solve(lit_room(), refine="off", gather_rays=64)

    def test_shapes(self):
        s = self.solution
        n, m, p = len(s.vertices), len(s.elements), len(s.patch_area)
        for name, shape, dtype in (
            ("vertices", (n, 3), np.float64),
            ("normals", (n, 3), np.float64),
            ("elements", (m, 4), np.int32),
            ("element_area", (m,), np.float64),
            ("irradiance", (n, 3), np.float32),
            ("radiosity", (n, 3), np.float32),
            ("direct_irradiance", (n, 3), np.float32),
            ("patch_radiosity", (p, 3), np.float32),
            ("patch_surface", (p,), np.int32),
            ("lux", (n,), np.float64),
        ):
            array = getattr(s, name)
            self.assertEqual((array.shape, array.dtype), (shape, dtype), name)
        # Both sides of 4 x 3, 4 x 2.5 and 3 x 2.5, each twice, and of the panel.
        self.assertAlmostEqual(s.element_area.sum(), 2 * (59 + 1), delta=1e-9)

    def test_triangles_cover_the_elements(self):
        s = self.solution
        a, b, c = (s.vertices[s.triangles[:, k]] for k in range(3))
        areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        sums = np.bincount(s.triangle_element, areas, len(s.elements))
        # Areas are sums of two products, with a few roundings of 2^-53 of coordinates below 4.
        np.testing.assert_allclose(sums, s.element_area, atol=1e-13)

    def test_irradiance_is_direct_and_indirect(self):
        s = self.solution
        self.assertEqual(
            s.irradiance.tobytes(), (s.direct_irradiance + s.indirect_irradiance).tobytes()
        )

    def test_lux_is_683_times_the_luminance_of_the_bands(self):
        s = self.solution
        weights = [0.2126, 0.7152, 0.0722]
        # Four digits of the weights.
        np.testing.assert_allclose(s.lux, 683 * s.irradiance @ weights, rtol=1e-4)

    def test_views_share_memory_and_are_read_only(self):
        for name in ("vertices", "elements", "direct_irradiance", "patch_radiosity", "element_area"):
            one, two = getattr(self.solution, name), getattr(self.solution, name)
            self.assertTrue(np.shares_memory(one, two), name)
            with self.assertRaises(ValueError):
                one[0] = 0

    def test_other_arrays_are_read_only(self):
        s = self.solution
        names = ("triangles", "triangle_element", "irradiance", "radiosity", "lux", "element_error")
        arrays = [(name, getattr(s, name)) for name in names]
        arrays += [(name, getattr(s.scene, name)) for name in ("vertices", "faces", "surface")]
        for name, array in arrays:
            with self.subTest(name), self.assertRaises(ValueError):
                array[0] = 0

    def test_views_outlive_the_solution(self):
        solution = lw.solve(lit_room(), refine="off", gather_rays=16)
        view, copy = solution.direct_irradiance, solution.direct_irradiance.copy()
        del solution
        gc.collect()
        np.zeros(10_000_000)  # would reuse memory that was given back
        self.assertEqual(view.tobytes(), copy.tobytes())

    def test_repr(self):
        self.assertRegex(repr(self.solution), r"<lightwell.Solution: \d+ elements, \d+ vertices, converged")
        self.assertIn("2 surfaces", repr(self.solution.scene))


class Readings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = lw.solve(furnace(0.5, 1.0), refine="off")

    def test_directions_may_have_any_length(self):
        unit = self.solution.probe([[1, 1, 1]], [0, 0, 1])
        with np.errstate(over="ignore"):  # of the square of 1e200
            long = self.solution.probe([[1, 1, 1]], [0, 0, 1e200])
        self.assertEqual(long.tobytes(), unit.tobytes())

    def test_probes_in_a_furnace(self):
        # E = M / (1 - rho) = 2 W/m^2 on any side of any point; 683 lm/W.
        points = [[0.5, 0.5, 0.5], [0.1, 0.2, 0.3]]
        E = self.solution.probe(points, [[0, 0, 1], [1, 1, 1]])
        np.testing.assert_allclose(E, 2.0, rtol=1e-5 + 64 * FLOAT)
        on_floor = self.solution.probe([[0.5, 0.5, 0.0]], [0, 0, 1], interpolate=True)
        np.testing.assert_allclose(on_floor, 2.0, rtol=1e-5 + 64 * FLOAT)
        readings = self.solution.measure(points, [0, 0, 5])
        np.testing.assert_allclose(readings.lux, 2 * 683, rtol=1e-4)
        self.assertEqual(readings.lux_within.shape, (2,))
        self.assertEqual(self.solution.lux_at(points, [0, 0, 1]).shape, (2,))

    def test_any_layout_of_points(self):
        points = np.random.default_rng(1).uniform(0.2, 0.8, (6, 3))
        expected = self.solution.probe(points, [0, 0, 1])
        for other in (np.asfortranarray(points), np.repeat(points, 2, axis=0)[::2], points.tolist()):
            self.assertEqual(self.solution.probe(other, [0, 0, 1]).tobytes(), expected.tobytes())

    def test_a_picture_of_a_furnace(self):
        camera = lw.Camera(position=(0.5, 0.5, 0.2), target=(0.5, 0.5, 1), up=(0, 1, 0), width=8, height=6)
        picture = self.solution.render(camera)
        self.assertEqual(picture.shape, (6, 8, 3))
        # L = B / pi = 2 / pi; direct light by closed forms and the rest interpolated.
        np.testing.assert_allclose(picture, 2 / np.pi, rtol=1e-3)
        shown = lw.tone_map(picture)
        self.assertEqual((shown.shape, shown.dtype), ((6, 8, 3), np.uint8))
        self.assertEqual(self.solution.render(camera, width=4).shape, (3, 4, 3))


class Channels(unittest.TestCase):
    def test_relight(self):
        vertices, faces = box(high=(4, 3, 2.5))
        panels = np.array([[0, 0, 2.4], [0, 1, 2.4], [1, 1, 2.4], [1, 0, 2.4]])
        scene = lw.Scene.from_arrays(
            np.vstack([vertices, panels + [0.5, 1, 0], panels + [2.5, 1, 0]]),
            np.vstack([faces, [8, 9, 10, 11], [12, 13, 14, 15]]),
            surface=[0] * 6 + [1, 2],
            names=["room", "left", "right"],
            reflectance=[0.5, 0.0, 0.0],
            emission=[0.0, 10.0, 20.0],
        )
        solution = lw.solve(scene, channels="per-luminaire", refine="off", gather_rays=64)
        self.assertEqual(list(solution.channels), ["left", "right"])
        off = solution.relight({"left": "off", "right": 0.5})
        self.assertEqual(off.energy["emitted"], 30.0)  # 20 W/m^2 halved, 1 m^2, 3 bands
        self.assertGreater(solution.channels["left"], 0)
        self.assertEqual(off.channels["left"], 0)
        back = off.relight({"*": "on"})
        self.assertEqual(back.indirect_irradiance.tobytes(), solution.indirect_irradiance.tobytes())
        with self.assertRaisesRegex(lw.InputError, "left"):
            solution.relight({"middle": 1.0})
        with self.assertRaisesRegex(lw.InputError, "bright"):
            solution.relight({"left": "bright"})

    def test_patterns(self):
        solution = lw.solve(lit_room(), channels={"top": "pan*"}, refine="off", gather_rays=16)
        self.assertEqual(list(solution.channels), ["top"])
        with self.assertRaisesRegex(lw.InputError, "lamp"):
            lw.solve(lit_room(), channels={"top": "lamp*"})


class Files(unittest.TestCase):
    def test_save_and_load(self):
        file = os.path.join(scratch(self), "s.vtp")
        scene = lit_room()
        solution = lw.solve(scene, refine="off", gather_rays=16)
        solution.save(file)
        again = lw.load(file, scene)
        self.assertEqual(again.direct_irradiance.tobytes(), solution.direct_irradiance.tobytes())
        self.assertIn("gather_rays=16", again.options)
        self.assertEqual(again.probe([[1, 1, 1]], [0, 0, 1]).shape, (1, 3))
        with self.assertRaisesRegex(lw.InputError, "needs the scene"):
            lw.load(file).probe([[1, 1, 1]], [0, 0, 1])
        with self.assertRaises(lw.InputError):
            lw.load(file, lw.read(CORNELL))

    def test_exports(self):
        folder = scratch(self)
        solution = lw.solve(lit_room(), refine="off", gather_rays=16)
        for name in ("m.glb", "m.ply", "m.obj", "m.html"):
            path = os.path.join(folder, name)
            solution.export(path, sides="both")
            self.assertGreater(os.path.getsize(path), 1000)
        with self.assertRaisesRegex(lw.InputError, "must end in .glb"):
            solution.export(os.path.join(folder, "m.stl"))
        camera = lw.Camera(position=(1, 1, 1), target=(3, 2, 1), width=8, height=8)
        picture = solution.render(camera, quality="draft")
        for name in ("p.exr", "p.hdr", "p.png"):
            path = os.path.join(folder, name)
            lw.write_picture(path, picture)
            self.assertGreater(os.path.getsize(path), 50)

    def test_a_solve_that_starts_from_another(self):
        first = lw.solve(lit_room(), refine="off", gather_rays=16)
        again = lw.solve(lit_room(), refine="off", gather_rays=16, start_from=first)
        # Both within the solver's tolerance, of the largest radiosity.
        np.testing.assert_allclose(
            again.patch_radiosity, first.patch_radiosity, atol=2e-5 * first.patch_radiosity.max()
        )

    def test_limited_time_gives_a_solution(self):
        solution = lw.solve(lit_room(), seconds=2)
        self.assertIn(solution.outcome, ("converged", "cut_short"))
        self.assertGreater(solution.lux.max(), 0)


if __name__ == "__main__":
    unittest.main()
