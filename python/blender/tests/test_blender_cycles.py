"""Light that comes straight from lamps is that of Cycles: the same watts are the same irradiance."""

import math
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from rooms import add_light, add_mesh, addon, empty_scene, matt  # noqa: E402

PROGRAM = os.environ["LIGHTWELL_PROGRAM"]
SAMPLES, PIXELS = 1024, 4

# Lamps without extent have no noise in Cycles; a file of a spot is linear between steps of 0.1 degrees: the
# smoothstep's second derivative is below 1e3 I_0 / rad^2, so 1e3 (1.75e-3)^2 / 8 = 4e-4 of I_0, here a
# share of at least a half. The tile is 1 cm across at 1 m: 1e-4.
EXACT = 1e-3
# The irradiance by points of the area lights here differs by less than a half from its mean. 1024 x 16
# samples: 3 x 0.5 / 128 at 3 sigma, if they were independent; Sobol's are better.
SAMPLED = 0.012


class Cycles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.scene = empty_scene()
        self.scene.lightwell.folder = os.path.join(self.folder, "scene")
        tile = [(-0.005, -0.005, 0), (0.005, -0.005, 0), (0.005, 0.005, 0), (-0.005, 0.005, 0)]
        add_mesh("tile", tile, [(0, 1, 2, 3)], matt("tile", (0.5, 0.5, 0.5)))

    def cycles(self):
        """Irradiance by Cycles' radiance of the tile: E = pi L / rho."""
        scene = self.scene
        data = bpy.data.cameras.new("above")
        data.type, data.ortho_scale, data.clip_start = "ORTHO", 0.004, 1e-4
        camera = bpy.data.objects.new("above", data)
        camera.location.z = 0.02
        scene.collection.objects.link(camera)
        scene.camera = camera
        scene.render.engine = "CYCLES"
        settings = scene.cycles
        settings.samples, settings.max_bounces = SAMPLES, 0
        settings.use_denoising = settings.use_adaptive_sampling = False
        settings.light_sampling_threshold = 0.0
        scene.render.resolution_x = scene.render.resolution_y = PIXELS
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = os.path.join(self.folder, "tile.exr")
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(scene.render.filepath)
        picture.colorspace_settings.name = "Non-Color"
        return np.array(picture.pixels[:]).reshape(-1, 4)[:, :3].mean(axis=0) * math.pi / 0.5

    def ours(self):
        """Irradiance by the exported scene."""
        bpy.context.view_layer.update()
        _, folder, _ = addon.solve.export(bpy.context)
        points, out = (os.path.join(folder, name) for name in ("points.csv", "light.csv"))
        with open(points, "w", encoding="utf-8") as file:
            file.write("x,y,z,nx,ny,nz\n0,0,0,0,0,1\n")
        command = [PROGRAM, "probe", os.path.join(folder, "scene.toml"), "--points", points, "-o", out]
        subprocess.run([*command, "--rays", "16384"], check=True, capture_output=True)
        with open(out, encoding="utf-8") as file:
            head, row = (line.split(",") for line in file.read().splitlines()[:2])
        return np.array([float(row[head.index(f"E_{band}")]) for band in "rgb"])

    def agree(self, tolerance):
        np.testing.assert_allclose(self.ours(), self.cycles(), rtol=tolerance)

    def test_point(self):
        add_light("p", "POINT", (0.3, 0.2, 1), 100.0, shadow_soft_size=0.0, color=(1.0, 0.5, 0.2), exposure=1.0)
        self.agree(EXACT)

    def test_spot_in_its_soft_rim(self):
        cone = {"spot_size": math.radians(60), "spot_blend": 0.6}
        spot = add_light("s", "SPOT", (0, 0, 1), 100.0, shadow_soft_size=0.0, **cone)
        spot.rotation_euler.x = math.radians(24)
        self.agree(EXACT)

    def test_sun(self):
        sun = add_light("s", "SUN", (0, 0, 1), 3.0, angle=0.0)
        sun.rotation_euler = (0.5, 0.2, 0)
        self.agree(EXACT)

    def test_rectangle_of_a_colour_temperature(self):
        warm = {"use_temperature": True, "temperature": 3000.0}
        light = add_light("a", "AREA", (0.4, 0, 0.8), 100.0, shape="RECTANGLE", size=0.6, size_y=0.3, **warm)
        light.rotation_euler = (0.2, 0.3, 0)
        light.scale = (1.0, 1.5, 1.0)
        self.agree(SAMPLED)

    def test_narrowed_disc_of_watts_a_square_metre(self):
        narrow = {"spread": math.radians(90), "normalize": False}
        light = add_light("a", "AREA", (0, 0.2, 1), 100.0, shape="DISK", size=0.1, **narrow)
        light.rotation_euler.x = math.radians(5)
        self.agree(SAMPLED)

    def test_mirrored_area_shines_where_cycles_does(self):
        scales = (-1.0, 1.0, 1.0), (1.0, 1.0, -1.0)
        for scale in scales:
            self.setUp()
            light = add_light("a", "AREA", (0.3, 0.1, 0.8), 100.0, shape="RECTANGLE", size=0.6, size_y=0.3)
            light.rotation_euler = (0.2, 0.3, 0.4) if scale[2] > 0 else (math.pi, 0.3, 0.4)
            light.scale = scale
            self.agree(SAMPLED)

    def test_portal_gives_no_light(self):
        add_light("s", "POINT", (0.3, 0.2, 1), 100.0, shadow_soft_size=0.0)
        add_light("portal", "AREA", (-0.2, 0, 0.8), 100.0, size=0.3).data.cycles.is_portal = True
        self.agree(EXACT)

    def test_emission_node_multiplies_the_light(self):
        data = add_light("s", "POINT", (0.3, 0.2, 1), 100.0, shadow_soft_size=0.0).data
        data.use_nodes = True
        node = next(node for node in data.node_tree.nodes if node.type == "EMISSION")
        node.inputs["Strength"].default_value = 3.0
        node.inputs["Color"].default_value = (0.5, 1.0, 0.25, 1.0)
        self.agree(EXACT)

    def test_lights_of_watts_a_square_metre_without_extent(self):
        add_light("s", "POINT", (0.3, 0.2, 1), 100.0, shadow_soft_size=0.0, normalize=False)
        add_light("spot", "SPOT", (0, 0, 2), 50.0, shadow_soft_size=0.0, normalize=False)
        add_light("sun", "SUN", (0, 0, 1), 2.0, angle=0.0, normalize=False).rotation_euler.x = 0.5
        self.agree(EXACT)

    def test_surface_shines_on_both_sides(self):
        points = [(-0.3, -0.2, 0.7), (-0.3, 0.2, 0.9), (0.3, 0.2, 0.9), (0.3, -0.2, 0.7)]
        for faces in ([(0, 1, 2, 3)], [(3, 2, 1, 0)]):
            self.setUp()
            material = matt("glow", (0.0, 0.0, 0.0))
            shader = material.node_tree.nodes["Principled BSDF"]
            shader.inputs["Emission Color"].default_value = (1, 0.5, 0.25, 1)
            shader.inputs["Emission Strength"].default_value = 7.0
            add_mesh("glow", points, faces, material)
            self.agree(SAMPLED)

    def test_world(self):
        self.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.6, 1)
        self.agree(EXACT)

    def test_map_turned_about_the_zenith(self):
        pixels = np.ones((64, 128, 4), np.float32)
        pixels[:, :, :3] = 0.5
        # Soft to the sides, so that Cycles and the solver interpolate alike.
        wave = 1 + np.cos(np.arange(128) / 128 * 2 * math.pi)
        pixels[40:60, :, 0] += wave
        pixels[40:60, :, 1] += np.roll(wave, 32)
        picture = bpy.data.images.new("map", 128, 64, float_buffer=True)
        picture.pixels.foreach_set(pixels.ravel())
        picture.filepath_raw, picture.file_format = os.path.join(self.folder, "map.hdr"), "HDR"
        picture.save()
        tree = self.scene.world.node_tree
        texture, mapping, places = (
            tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Mapping", "TexCoord")
        )
        texture.image = bpy.data.images.load(picture.filepath_raw)
        mapping.inputs["Rotation"].default_value[2] = math.radians(50)
        tree.links.new(places.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
        # A black wall to one side of the tile tells the sides apart.
        wall = [(-1, -1, -0.001), (-1, 1, -0.001), (-1, 1, 2), (-1, -1, 2)]
        add_mesh("wall", wall, [(0, 1, 2, 3)], matt("black", (0.0, 0.0, 0.0)))
        self.agree(SAMPLED)


if __name__ == "__main__":
    addon.register()
    unittest.main()
