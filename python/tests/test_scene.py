"""Scenes from arrays and from meshes of other packages, and back."""

import importlib.util
import types
import unittest

import numpy as np

import lightwell as lw
from scenes import CORNELL, box, lit_room


class FromArrays(unittest.TestCase):
    def test_round_trip(self):
        vertices, faces = box(high=(3, 2, 1))
        scene = lw.Scene.from_arrays(vertices, faces, names=list("abcdef"))
        self.assertEqual(scene.names, list("abcdef"))
        self.assertEqual(scene.areas.tolist(), [2, 2, 3, 3, 6, 6])
        self.assertEqual(scene.faces.shape, (12, 3))
        again = lw.Scene.from_arrays(
            scene.vertices, scene.faces, surface=scene.surface, names=scene.names
        )
        self.assertEqual(again.areas.tolist(), scene.areas.tolist())
        # Two coplanar triangles are cleaned up to the same rectangle, so light is the same.
        one = lw.solve(self.lit(scene), refine="off", gather_rays=16)
        two = lw.solve(self.lit(again), refine="off", gather_rays=16)
        self.assertEqual(len(one.elements), len(two.elements))

    def lit(self, scene):
        return lw.Scene.from_arrays(
            scene.vertices, scene.faces, surface=scene.surface, emission=[1, 0, 0, 0, 0, 0]
        )

    def test_lists_of_faces_of_any_size(self):
        vertices = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 3, 0], [0, 2, 0], [1, 1, 5]]
        scene = lw.Scene.from_arrays(vertices, [[0, 1, 2, 3, 4], [0, 1, 5]])
        self.assertEqual(scene.names, ["surface 0"])
        # 2 x 2 and half of 2 x 1; half of 2 times the height sqrt(1 + 25).
        self.assertAlmostEqual(scene.areas[0], 5 + np.sqrt(26), delta=1e-14)

    def test_any_type_and_layout(self):
        vertices, faces = box()
        expected = lw.Scene.from_arrays(vertices, faces)._data.hash
        for v in (vertices.astype(np.float32), np.asfortranarray(vertices), vertices[::-1][::-1]):
            for f in (faces.astype(np.uint8), faces.astype(np.int64), np.asfortranarray(faces), faces.tolist()):
                self.assertEqual(lw.Scene.from_arrays(v, f)._data.hash, expected)

    def test_materials(self):
        scene = lit_room()
        self.assertEqual(scene.materials[0].reflectance, (0.5, 0.5, 0.5))
        self.assertEqual(scene.materials[1].emission, (30, 30, 30))
        vertices, faces = box()
        mirror = lw.Material("mirror", reflectance=(0.1, 0.2, 0.25), specular=0.5, roughness=0.25, one_sided=True)
        scene = lw.Scene.from_arrays(vertices, faces, materials=mirror, title="a box")
        self.assertEqual(scene.title, "a box")
        self.assertEqual(scene.materials[0].roughness, 0.25)
        self.assertTrue(scene.materials[0].one_sided)
        np.testing.assert_array_equal(
            scene.materials[0].reflectance, np.array([0.1, 0.2, 0.25], np.float32)
        )

    def test_cameras_keep_their_lens(self):
        lens = {"shift": (0.25, -0.5), "distortion": (0.1, -0.02, 0.003, 0.004, -0.005)}
        camera = lw.Camera(position=(1, 1, 1), target=(2, 1, 1), fov=60.0, width=320, height=240, **lens)
        vertices, faces = box()
        scene = lw.Scene.from_arrays(vertices, faces, cameras=camera)
        self.assertEqual(scene.cameras[0].shift, lens["shift"])
        self.assertEqual(scene.cameras[0].distortion, lens["distortion"])
        again = lw.Scene.from_arrays(vertices, faces, cameras=scene.cameras)
        self.assertEqual(again.cameras[0], scene.cameras[0])

    def test_notes(self):
        vertices, faces = box()
        scene = lw.Scene.from_arrays(vertices, np.vstack([faces, [0, 0, 1, 1]]), surface=[0] * 7)
        self.assertEqual(len(scene.losses), 1)
        self.assertIn("losses", repr(scene))
        self.assertIn("no light", repr(scene))


class FromFiles(unittest.TestCase):
    def test_read(self):
        scene = lw.read(CORNELL)
        self.assertEqual(scene.names[:2], ["floor", "ceiling"])
        self.assertEqual(scene.bands, ["r", "g", "b"])
        self.assertEqual(scene.metres_per_unit, 0.001)
        self.assertEqual(scene.cameras[0].name, "diffuse")
        self.assertFalse(scene.relative_units)
        self.assertIn("cornell.toml", repr(scene))


class OtherPackages(unittest.TestCase):
    def test_what_looks_like_trimesh(self):
        vertices, faces = box()
        triangles = np.vstack([faces[:, :3], faces[:, [0, 2, 3]]])
        mesh = types.SimpleNamespace(vertices=vertices, faces=triangles)
        self.assertEqual(lw.Scene.from_trimesh(mesh, reflectance=0.3).areas.tolist(), [6])

    def test_what_looks_like_pyvista(self):
        mesh = types.SimpleNamespace(
            points=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], np.float32),
            faces=np.array([4, 0, 1, 2, 3, 3, 1, 4, 2]),
        )
        self.assertEqual(lw.Scene.from_pyvista(mesh).areas.tolist(), [1.5])

    @unittest.skipUnless(importlib.util.find_spec("trimesh"), "trimesh is not installed")
    def test_trimesh(self):
        import trimesh

        scene = lw.Scene.from_trimesh(trimesh.creation.box((1, 2, 3)))
        mesh = scene.to_trimesh()
        self.assertEqual(len(mesh.faces), 12)
        self.assertAlmostEqual(mesh.area, 22.0, delta=1e-12)

    @unittest.skipUnless(importlib.util.find_spec("pyvista"), "pyvista is not installed")
    def test_pyvista(self):
        import pyvista

        scene = lw.Scene.from_pyvista(pyvista.Cube(x_length=1, y_length=2, z_length=3))
        self.assertAlmostEqual(scene.to_pyvista().area, 22.0, delta=1e-5)
        solution = lw.solve(lit_room(), refine="off", gather_rays=16)
        self.assertIn("lux", solution.to_pyvista().point_data)


if __name__ == "__main__":
    unittest.main()
