"""Lightmaps as arrays and in files."""

import hashlib
import os
import unittest

import numpy as np

import lightwell as lw
from scenes import FLOAT, ROOM, lit_room, run_program, scratch


class Lightmaps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = lit_room()
        cls.solution = lw.solve(cls.scene, max_patch_size=0.5, refine="off", gather_rays=64)

    def test_triangles_lie_in_charts_on_their_surfaces(self):
        maps = self.solution.lightmaps(size=256)
        self.assertEqual(maps.uv.shape, (len(maps.vertices), 2))
        self.assertTrue(((0.0 <= maps.uv) & (maps.uv <= 1.0)).all())
        self.assertEqual(len(maps.pictures), 1)
        corners = maps.vertices[maps.triangles]
        area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        # The room's walls from inside, 59 m^2 of 4 x 3 x 2.5 m, and both sides of the panel of 1 m^2, of which
        # one is dark: sums of a few hundred products, each rounded a few times.
        of_surface = np.bincount(maps.surface, area)
        self.assertAlmostEqual(of_surface[0], 59.0, delta=59.0 * 1000 * 2.0**-53)
        self.assertIn(round(of_surface[1], 9), (1.0, 2.0))
        # Charts keep shapes, but for the rounding of their rectangles to whole texels: a side of n texels is off
        # by half of one.
        flat = maps.uv[maps.triangles].astype(float) * maps.size
        a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        texels = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        lit = maps.surface == 0
        shortest = 2.5 * maps.texels_per_metre
        np.testing.assert_allclose(
            texels[lit].sum(), area[lit].sum() * maps.texels_per_metre**2, rtol=2 * 0.5 / shortest
        )
        self.assertTrue((maps.picture == 0).all())

    def test_texels_have_the_light_of_the_solution(self):
        maps = self.solution.lightmaps(size=256)
        (picture,) = maps.pictures
        self.assertEqual(picture.irradiance.shape, (256, 256, 3))
        self.assertEqual(picture.lux.shape, (256, 256))
        self.assertFalse(picture.irradiance.flags.writeable)
        floor = (maps.surface == 0) & (np.ptp(maps.vertices[maps.triangles][:, :, 2], axis=1) == 0.0)
        floor &= maps.vertices[maps.triangles][:, 0, 2] == 0.0
        triangle = maps.triangles[np.flatnonzero(floor)[10]]
        # The texel that holds a triangle's middle, and its own middle on the floor.
        at = (maps.uv[triangle].mean(axis=0) * maps.size).astype(int)
        uv, place = maps.uv[triangle].astype(float) * maps.size, maps.vertices[triangle]
        inside = np.linalg.solve(np.vstack([uv.T, np.ones(3)]), np.append(at + 0.5, 1.0))
        expected = self.solution.probe([inside @ place], [0, 0, 1], interpolate=True)[0]
        # The same interpolation along the element, whose coordinates are floats in the chart (256 texels to half
        # a unit of 2^-24 of the picture, in elements of 20 texels) and whose light differs by less than its value.
        np.testing.assert_allclose(picture.irradiance[at[1], at[0]], expected, rtol=256 / 20 * 4 * FLOAT + 16 * FLOAT)
        rho = 0.5
        np.testing.assert_allclose(
            picture.radiosity[at[1], at[0]], rho * picture.irradiance[at[1], at[0]], rtol=8 * FLOAT
        )
        self.assertTrue(picture.covered[at[1], at[0]])
        self.assertTrue(0.2 < picture.covered.mean() < 1.0)
        self.assertEqual(lw.tone_map(picture.radiance).shape, (256, 256, 3))

    def test_files_have_the_bits_of_the_command_line(self):
        folder = scratch(self)
        scene = lw.read(ROOM)
        solution = lw.solve(scene, accuracy="10%", channels="per-luminaire")
        vtp = os.path.join(folder, "room.vtp")
        solution.save(vtp)
        options = ["--lightmap", "--lightmap-size", "128", "--lightmap-channels", "--lightmap-padding", "2"]
        theirs, ours = (os.path.join(folder, name) for name in ("theirs", "ours"))
        for made in (theirs, ours):
            os.mkdir(made)
        run_program("export", vtp, "--scene", ROOM, "-o", os.path.join(theirs, "room.glb"), *options)
        lw.load(vtp, scene).export(
            os.path.join(ours, "room.glb"), lightmap=True, lightmap_size=128, lightmap_channels=True, lightmap_padding=2
        )
        names = sorted(os.listdir(theirs))
        self.assertGreater(len(names), 2)
        self.assertEqual(names, sorted(os.listdir(ours)))
        for name in names:
            digests = []
            for made in (theirs, ours):
                with open(os.path.join(made, name), "rb") as file:
                    digests.append(hashlib.sha256(file.read()).hexdigest())
            self.assertEqual(*digests, name)

    def test_several_pictures_and_passes(self):
        maps = self.solution.lightmaps(size=64, texels_per_metre=15, padding=1)
        self.assertGreater(len(maps.pictures), 1)
        self.assertEqual(set(maps.picture.tolist()), set(range(len(maps.pictures))))
        self.assertEqual(maps.texels_per_metre, 15)
        self.assertIn("64 x 64 texels", repr(maps))
        self.assertIn("covered", repr(maps.pictures[0]))
        direct = self.solution.lightmaps(size=64, pass_="direct")
        self.assertTrue((direct.pictures[0].lux >= 0.0).all())
        with self.assertRaises(lw.Interrupted):
            self.solution.lightmaps(size=512, pass_="gather", progress=lambda phase, share: False)

    def test_wrong_input_is_a_sentence(self):
        path = os.path.join(scratch(self), "room.vtp")
        self.solution.save(path)
        alone = lw.load(path)
        self.assertEqual(len(alone.lightmaps(size=64).pictures), 1)
        for call, sentence in (
            (lambda: self.solution.lightmaps(size=8), "size is 8"),
            (lambda: self.solution.lightmaps(size=2.5), "size is 2.5"),
            (lambda: self.solution.lightmaps(padding=65), "padding is 65"),
            (lambda: self.solution.lightmaps(texels_per_metre=float("nan")), "texels_per_metre is"),
            (lambda: self.solution.lightmaps(size=16, texels_per_metre=1e300), ""),
            (lambda: self.solution.lightmaps(pass_="final"), "no lightmap pass 'final'"),
            (lambda: self.solution.lightmaps(sides="left"), "no sides 'left'"),
            (lambda: alone.lightmaps(pass_="gather"), "needs the scene"),
            (lambda: self.solution.export(path + ".ply", lightmap=True), "must end in .glb"),
        ):
            with self.subTest(sentence), self.assertRaises(lw.InputError) as caught:
                call()
            self.assertIn(sentence, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
