"""View factors against closed forms (Howell, Menguc & Siegel, Thermal Radiation Heat Transfer,
configurations C-11 and C-14), and their laws."""

import unittest
from math import atan, log, pi, sqrt

import numpy as np

import lightwell as lw
from scenes import FLOAT, box

# A closed form is rounded to a float32 twice: when it is stored, and when closure scales its row.
CLOSED_FORM = 2 * FLOAT


def parallel_rectangles(a, b, c):
    """F_12 of opposite rectangles a x b at the distance c."""
    x, y = a / c, b / c
    return (
        2
        / (pi * x * y)
        * (
            0.5 * log((1 + x * x) * (1 + y * y) / (1 + x * x + y * y))
            + x * sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))
            + y * sqrt(1 + x * x) * atan(y / sqrt(1 + x * x))
            - x * atan(x)
            - y * atan(y)
        )
    )


def perpendicular_rectangles(w, h, length):
    """F_12 of rectangles w and h wide at right angles that share an edge of the given length."""
    x, y = w / length, h / length
    z = x * x + y * y
    return (
        1
        / (pi * x)
        * (
            x * atan(1 / x)
            + y * atan(1 / y)
            - sqrt(z) * atan(1 / sqrt(z))
            + 0.25
            * (
                log((1 + x * x) * (1 + y * y) / (1 + z))
                + x * x * log(x * x * (1 + z) / ((1 + x * x) * z))
                + y * y * log(y * y * (1 + z) / ((1 + y * y) * z))
            )
        )
    )


def plates(a, b, c):
    vertices = [[x, y, z] for z in (0, c) for x, y in ((0, 0), (a, 0), (a, b), (0, b))]
    return lw.Scene.from_arrays(vertices, [[0, 1, 2, 3], [7, 6, 5, 4]], names=["floor", "ceiling"])


class ClosedForms(unittest.TestCase):
    def test_parallel_plates(self):
        for a, b, c in ((1, 1, 1), (2, 1, 0.5), (1, 5, 3)):
            found = lw.form_factors(plates(a, b, c))
            F = found.matrix.toarray()
            expected = parallel_rectangles(a, b, c)
            self.assertAlmostEqual(F[0, 1], expected, delta=CLOSED_FORM)
            self.assertAlmostEqual(F[1, 0], expected, delta=CLOSED_FORM)
            self.assertEqual(F[0, 0], 0.0)
            self.assertAlmostEqual(found.open[0], 1 - expected, delta=2 * CLOSED_FORM)
            self.assertEqual(found.areas.tolist(), [a * b, a * b])
            self.assertEqual(found.names, ["floor", "ceiling"])
            self.assertEqual(found.face.tolist(), [0, 1])

    def test_perpendicular_plates(self):
        for w, h, length in ((1, 1, 1), (2, 1, 3), (0.5, 2, 1)):
            vertices = [[0, 0, 0], [w, 0, 0], [w, length, 0], [0, length, 0], [0, 0, h], [0, length, h]]
            scene = lw.Scene.from_arrays(vertices, [[0, 1, 2, 3], [0, 3, 5, 4]])
            F = lw.form_factors(scene).matrix.toarray()
            self.assertAlmostEqual(F[0, 1], perpendicular_rectangles(w, h, length), delta=CLOSED_FORM)
            self.assertAlmostEqual(F[1, 0] * h, F[0, 1] * w, delta=CLOSED_FORM * max(w, h))

    def test_box(self):
        vertices, faces = box(high=(3, 2, 1))
        found = lw.form_factors(lw.Scene.from_arrays(vertices, faces))
        F = found.matrix.toarray().astype(float)
        self.assertAlmostEqual(F[4, 5], parallel_rectangles(3, 2, 1), delta=CLOSED_FORM)
        self.assertAlmostEqual(F[4, 0], perpendicular_rectangles(3, 1, 2), delta=CLOSED_FORM)
        # Six factors a row, each below 1/2 rounded to float32, and none beyond rounding is lost.
        np.testing.assert_allclose(F.sum(axis=1), 1.0, atol=6 * CLOSED_FORM)
        flux = found.areas[:, None] * F
        np.testing.assert_allclose(flux, flux.T, atol=CLOSED_FORM * found.areas.max())
        self.assertEqual(found.areas.tolist(), [2, 2, 3, 3, 6, 6])
        self.assertLess(found.report["closure_max_error"], 6 * CLOSED_FORM)


class Methods(unittest.TestCase):
    def test_rays_and_hemicubes_agree(self):
        expected = parallel_rectangles(1, 1, 1)
        rays = lw.form_factors(plates(1, 1, 1), method="ray-cast", target_error=1e-3)
        # Four standard errors.
        self.assertAlmostEqual(rays.matrix[0, 1], expected, delta=4e-3)
        self.assertFalse(rays.is_short)
        cubes = lw.form_factors(plates(1, 1, 1), method="hemicube", hemicube_resolution=512)
        self.assertAlmostEqual(cubes.matrix[0, 1], expected, delta=1e-2)
        self.assertIsNone(cubes.error)
        self.assertIn("no error estimate", repr(cubes))

    def test_backs_have_rows(self):
        found = lw.form_factors(plates(1, 1, 1), two_sided=True)
        self.assertEqual(found.is_back.tolist(), [False, False, True, True])
        self.assertEqual(found.matrix.shape, (4, 4))
        self.assertEqual(found.open.tolist()[2:], [1.0, 1.0])  # backs see nothing

    def test_patches_have_rows(self):
        found = lw.form_factors(plates(1, 1, 1), max_patch_size=0.5)
        self.assertEqual(found.face.tolist(), [0] * 4 + [1] * 4)
        F = found.matrix.toarray()[:4, 4:].astype(float)
        # The mean over four patches of sums of four factors.
        self.assertAlmostEqual(
            F.sum(axis=1).mean(), parallel_rectangles(1, 1, 1), delta=4 * CLOSED_FORM
        )

    def test_faces_without_area_keep_empty_rows(self):
        vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]
        scene = lw.Scene.from_arrays(vertices, [[0, 1, 4], [0, 1, 2, 3]], surface=[0, 0])
        found = lw.form_factors(scene)
        self.assertEqual(found.areas.tolist(), [0, 1])
        self.assertTrue(any("empty rows: 1" in note for note in found.notes), found.notes)

    def test_result_unpacks(self):
        F, report = lw.form_factors(plates(1, 1, 1))
        self.assertEqual(F.format, "csr")
        self.assertEqual(report["rows"], 2)

    def test_arrays_of_rows_are_read_only(self):
        found = lw.form_factors(plates(1, 1, 1))
        for name in ("areas", "open", "blocked", "face", "is_back", "emittance"):
            with self.subTest(name), self.assertRaises(ValueError):
                getattr(found, name)[0] = 0


if __name__ == "__main__":
    unittest.main()
