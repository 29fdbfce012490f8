"""What the Blender add-on makes of lights, materials, cameras and meshes, without Blender."""

import json
import math
import os
import shutil
import subprocess
import sys
import unittest
import zipfile

import numpy as np
from scenes import SOURCE, run_program, scratch

import lightwell as lw

sys.path.insert(0, os.path.join(SOURCE, "python", "blender"))

from logic import cameras, lights, materials, meshes, scene_folder, toml_text  # noqa: E402
from logic.lights import Light  # noqa: E402
from logic.materials import Shader  # noqa: E402

BOX = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


def polygons(points, faces):
    first = np.concatenate([[0], np.cumsum([len(face) for face in faces])])
    return meshes.Polygons(np.array(points, float), np.concatenate(faces), first)


def box(size=1.0):
    return polygons([[size * (i >> k & 1) for k in range(3)] for i in range(8)], BOX)


def room(**more):
    """A box of 3 m and a lamp in its middle."""
    scene = scene_folder.Scene(
        surfaces=[scene_folder.Surface("walls [1]", "paint", box(3.0))],
        materials={"paint": Shader(base=(0.5, 0.5, 0.5), roughness=1.0)},
        lights=[Light("lamp", "POINT", 10.0, position=(1.5, 1.5, 1.5))],
        light_collections=["lamps"],
    )
    for key, value in more.items():
        setattr(scene, key, value)
    return scene


class Lights(unittest.TestCase):
    def test_watts_become_candela_and_lumens(self):
        # I = 683 P / (4 pi); green alone has 0.715 of white's luminance.
        point = Light("p", "POINT", 4 * math.pi)
        # The weights of the bands have seven digits, and add up to 1 + 1e-7.
        self.assertAlmostEqual(lights.candela_of(point, 683.0), 683.0, delta=683 * 2e-7)
        green = Light("p", "POINT", 4 * math.pi, colour=(0, 1, 0), exposure=1.0)
        self.assertAlmostEqual(lights.candela_of(green, 683.0), 2 * lights.LUMINANCE[1] * 683.0)
        self.assertIn("12.57 W radiant, 8583 lm, 683 cd to all sides", lights.spoken(point, 683.0))

    def test_watts_of_each_square_metre(self):
        area = Light("a", "AREA", 5.0, normalized=False, shape="ELLIPSE", size=(2.0, 1.0))
        self.assertAlmostEqual(lights.watts(area)[0], 5.0 * math.pi / 2)
        point = Light("p", "POINT", 5.0, normalized=False, radius=0.1)
        self.assertAlmostEqual(lights.watts(point)[0], 5.0 * 4 * math.pi * 0.01)

    def test_spot_has_its_intensity_and_the_flux_of_its_cone(self):
        spot = Light("s", "SPOT", 4 * math.pi, cone=60.0, blend=0.6)
        self.assertEqual(lights.spot_share(spot, 10.0), 1.0)
        self.assertEqual(lights.spot_share(spot, 30.0), 0.0)
        # Smoothstep of u in the cosine: 2 pi (c - cos h) of full light, 2 pi w / 2 of the rim of width w.
        edge = math.cos(math.radians(30))
        rim = 0.6 * (1 - edge)
        self.check_flux(spot, 683 * 2 * math.pi * ((1 - edge - rim) + rim / 2), 683.0)

    def test_rims_of_all_widths_keep_their_flux(self):
        for cone in (1.0, 10.0, 90.0):
            for blend in (0.0, 1e-3, 1.0):
                spot = Light("s", "SPOT", 4 * math.pi, cone=cone, blend=blend)
                # 1 - cos h, where the rim, of half the light in the cosine, takes half of its share.
                share = 2 * math.sin(math.radians(cone / 4)) ** 2 * (1 - blend / 2)
                with self.subTest(cone=cone, blend=blend):
                    self.check_flux(spot, 683 * 2 * math.pi * share, 683.0)

    def test_lights_without_extent_shine_as_in_cycles(self):
        # The same numbers in Cycles: test_blender_cycles.py.
        self.assertEqual(lights.watts(Light("p", "POINT", 5.0, normalized=False)), (20.0, 20.0, 20.0))
        self.assertEqual(lights.watts(Light("s", "SUN", 5.0, normalized=False, angle=0.0)), (5.0, 5.0, 5.0))

    def test_narrowed_area_keeps_its_flux(self):
        area = Light("a", "AREA", 2.0, spread=80.0, size=(0.1, 0.1))
        self.check_flux(area, 2 * 683.0, lights.spread_intensity(area, 0.0) * 2 * 683)

    def check_flux(self, light, lumens, candela):
        table, text = lights.lamp_table(light, 683.0)
        folder = scratch(self)
        path = os.path.join(folder, "light.ies")
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        found = json.loads(run_program("info", path, "--json"))
        # Linear between steps: |I''| h^2 / 8 of I. |I''| is below 6 / w^2 in a rim of width w, and h is below
        # w / 64: 2e-4. An area falls as its cosine: less. A hard edge of 0.5 degrees ends within 1e-4: half of
        # 2 x 1e-4 / 0.5, 2e-4 more.
        self.assertAlmostEqual(found["lumens"] / lumens, 1.0, delta=4e-4)
        self.assertAlmostEqual(found["peak_candela"] / candela, 1.0, delta=1e-6)
        self.assertEqual(table["aim"], [0.0, 0.0, -1.0])

    def test_areas_shine_from_their_front_and_round_ones_keep_their_area(self):
        for shape, area in (("RECTANGLE", 2.0), ("ELLIPSE", math.pi / 2)):
            corners = np.array(lights.outline(Light("a", "AREA", 1.0, shape=shape, size=(2.0, 1.0))))
            ahead = np.roll(corners, -1, axis=0)
            self.assertAlmostEqual(0.5 * np.cross(corners, ahead).sum(axis=0)[2], -area, places=12)


class Materials(unittest.TestCase):
    def test_matt_and_metal(self):
        matt, said = materials.material_table(Shader(base=(0.5, 0.4, 0.3), roughness=1.0), False)
        self.assertEqual((matt, said), ({"reflectance": [0.5, 0.4, 0.3]}, []))
        metal, _ = materials.material_table(Shader(base=(0.9, 0.8, 0.7), metallic=1.0, roughness=0.5), False)
        self.assertEqual((metal["reflectance"], metal["specular"]), ([0.0] * 3, [0.9, 0.8, 0.7]))
        self.assertEqual(metal["roughness"], 0.25)

    def test_glossy_layer_leaves_what_it_does_not_mirror(self):
        # Egan & Hilgeman 1979: 0.0918 of even light for an index of 1.5.
        self.assertAlmostEqual(materials.even_reflectance(1.5), 0.0918, delta=2e-4)
        table, _ = materials.material_table(Shader(base=(1.0, 0.5, 0.0)), False)
        self.assertAlmostEqual(table["coat"]["ior"], 1.5)
        self.assertAlmostEqual(table["reflectance"][1], 0.5 * (1 - materials.even_reflectance(1.5)))

    def test_glass_is_a_pane_on_open_sheets(self):
        glass = Shader(base=(0.81, 1.0, 1.0), transmission=1.0, roughness=0.0)
        self.assertAlmostEqual(materials.material_table(glass, True)[0]["glass"]["tint"][0], 0.9)
        self.assertTrue(materials.material_table(glass, False)[0]["glass"]["thin"])

    def test_what_a_kind_does_not_have_is_said(self):
        glow = Shader(emission=(1.0, 1.0, 1.0), alpha=0.5, metallic=1.0)
        said = materials.material_table(glow, False)[1]
        self.assertEqual(said, ["alpha of a material that shines", "metallic of a material that shines"])
        mask = materials.Picture("pictures/a.png")
        said = materials.material_table(Shader(transmission=1.0, mask=mask, coat=0.1), True)[1]
        self.assertEqual(said, ["a mask of glass", "a coat of glass"])
        for shader, words in (
            (Shader(coat=0.4), ["a coat of a weight below 0.5"]),
            (Shader(coat=1.0, metallic=1.0), ["a coat of metal or of what lets light through"]),
            (Shader(coat=1.0), []),
        ):
            self.assertEqual(materials.material_table(shader, False)[1], words)

    def test_every_kind_is_read_by_the_program(self):
        kinds = {
            "white": Shader(base=(1.0, 1.0, 1.0), roughness=0.1),
            "coated": Shader(base=(1.0, 1.0, 1.0), coat=1.0, coat_ior=2.0, coat_roughness=0.5),
            "half metal": Shader(base=(1.0, 1.0, 1.0), metallic=0.5, alpha=0.3),
            "sheet": Shader(base=(1.0, 1.0, 1.0), translucent=0.5, roughness=1.0),
            "glass": Shader(base=(1.0, 1.0, 1.0), transmission=1.0, roughness=0.3, ior=1.0),
            "lamp": Shader(base=(1.0, 1.0, 1.0), emission=(1.0, 2.0, 3.0), transmission=1.0),
            "dense": Shader(ior=50.0, specular_level=1.0),
        }
        scene = room()
        scene.materials.update(kinds)
        for i, name in enumerate(kinds):
            block = box(0.2)
            block.points += [0.3 * i + 0.1, 1.0, 1.0]
            for closed in (True, False):
                part = meshes.part_of(block, np.arange(6) != (6 if closed else 5))
                part.points[:, 1] += 0.0 if closed else 0.5
                scene.surfaces.append(scene_folder.Surface(name, name, part, closed=meshes.is_closed(part)))
        found = lw.read(scene_folder.write_scene(scene, scratch(self)))
        self.assertEqual(len(found.names), 1 + 2 * len(kinds))
        for note in found.notes:
            self.assertNotIn("left out", note)


class Cameras(unittest.TestCase):
    def test_angle_shift_and_size(self):
        place = {"position": (0, 0, 0), "direction": (0, 1, 0), "up": (0, 0, 1)}
        wide = cameras.camera_table(cameras.Camera("c", **place, lens=18.0, pixels=(200, 100), shift=(0.1, 0.1)))
        self.assertAlmostEqual(wide["fov"], 90.0)
        self.assertEqual(wide["shift"], [0.1, 0.2])
        # A sensor 36 mm high makes a picture half as wide see half of that: tan = 18 / 2 / 18.
        tall = cameras.camera_table(cameras.Camera("c", **place, lens=18.0, pixels=(100, 200)))
        self.assertAlmostEqual(math.tan(math.radians(tall["fov"] / 2)), 0.5)
        plan = cameras.Camera("c", **place, is_orthographic=True, view=4.0, pixels=(100, 200))
        self.assertEqual(cameras.camera_table(plan)["view_width"], 2.0)

    def test_units(self):
        self.assertEqual(cameras.metres_per_unit("IMPERIAL", 0.3048), 0.3048)
        self.assertEqual(cameras.metres_per_unit("NONE", 0.01), 1.0)


class Meshes(unittest.TestCase):
    def test_closed_bodies(self):
        self.assertTrue(meshes.is_closed(box()))
        self.assertFalse(meshes.is_closed(meshes.turned_over(box())))
        self.assertFalse(meshes.is_closed(meshes.part_of(box(), np.arange(6) != 2)))
        fan = polygons([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 1, 3], [1, 0, 3]])
        self.assertFalse(meshes.is_closed(fan))

    def test_file_keeps_polygons_of_all_sizes(self):
        mesh = polygons([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]], [[0, 1, 2, 3], [3, 2, 4]])
        path = os.path.join(scratch(self), "mesh.ply")
        with open(path, "wb") as file:
            file.write(meshes.ply_bytes(mesh))
        scene = lw.read(path)
        self.assertEqual(len(scene.faces), 3)
        corners = scene.vertices[scene.faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        self.assertAlmostEqual(area.sum() / 2, 1.5)

    def test_light_in_the_plane_of_a_ceiling_is_moved_below_it(self):
        panel = Light("panel", "AREA", 5.0, position=(1.5, 1.5, 3.0), size=(0.5, 0.5))
        scene = room(lights=[panel], light_collections=[""])
        text = scene_folder.scene_text(scene, {})
        self.assertIn("[1.25, 1.25, 2.999]", text)
        self.assertTrue(any("lies in a face" in note for note in scene.notes))


class Folder(unittest.TestCase):
    def test_program_reads_names_of_all_kinds(self):
        names = ['quo"te', "back\\slash", "new\nline", "star*", "gleich = 1", "Ü" * 200, "", "walls"]
        scene = room()
        scene.lights = [Light(name, "POINT", 1.0, position=(1, 1, 1 + 0.1 * i)) for i, name in enumerate(names)]
        scene.light_collections = ["home"] * len(names)
        folder = scratch(self)
        path = scene_folder.write_scene(scene, folder)
        channels = scene_folder.channel_arguments(scene.emitters, "LIGHT")
        run_program("solve", path, "-o", os.path.join(folder, "s.vtp"), "--rays", "64", "--refine", "off", *channels)
        self.assertEqual(len(channels), 2 * len(names))
        self.assertEqual(len(scene_folder.channel_arguments(scene.emitters, "COLLECTION")), 2 * len(names))

    def test_export_replaces_its_own_files_alone(self):
        folder = scratch(self)
        scene_folder.write_scene(room(files={"pictures/a.png": b"1"}), folder)
        with open(os.path.join(folder, "mine.txt"), "w", encoding="utf-8"):
            pass
        scene_folder.write_scene(room(), folder)
        self.assertEqual(sorted(os.listdir(folder)), ["meshes", "mine.txt", "scene.toml"])
        with open(os.path.join(folder, "scene.toml"), "w", encoding="utf-8") as file:
            file.write("# mine\n")
        with self.assertRaisesRegex(scene_folder.SceneError, "was not written by this add-on"):
            scene_folder.write_scene(room(), folder)

    def test_folders_of_the_project_stay(self):
        for name in ("pictures/mine.png", "meshes/00001.ply", "solution.vtp"):
            folder = scratch(self)
            mine = os.path.join(folder, name)
            os.makedirs(os.path.dirname(mine), exist_ok=True)
            with open(mine, "w", encoding="utf-8") as file:
                file.write("mine")
            if name == "pictures/mine.png":  # no file of that name is exported
                for _ in range(2):
                    scene_folder.write_scene(room(), folder)
            else:
                with self.assertRaisesRegex(scene_folder.SceneError, f"{name} was not written by this add-on"):
                    scene_folder.write_scene(room(), folder)
                self.assertFalse(os.path.exists(os.path.join(folder, "scene.toml")))
            with open(mine, encoding="utf-8") as file:
                self.assertEqual(file.read(), "mine")

    def test_export_tells_the_scene_apart_that_was_solved(self):
        folder = scratch(self)
        scene_folder.write_scene(room(), folder)
        first = scene_folder.digest_of(folder)
        scene_folder.write_scene(room(), folder)
        self.assertEqual(scene_folder.digest_of(folder), first)
        other = room()
        other.surfaces[0].mesh.points[0, 0] = -0.5
        scene_folder.write_scene(other, folder)
        self.assertNotIn(scene_folder.digest_of(folder), ("", first))

    def test_nothing_to_solve(self):
        with self.assertRaisesRegex(scene_folder.SceneError, "nothing shines"):
            scene_folder.check_scene(room(lights=[]))
        with self.assertRaisesRegex(scene_folder.SceneError, "has faces"):
            scene_folder.check_scene(room(surfaces=[]))

    def test_sun_and_sky(self):
        sun = Light("sun", "SUN", 3.0, aim=(0.0, 0.6, -0.8))
        low = Light("low", "SUN", 9.0, aim=(0.0, 0.6, 0.8))
        scene = room(lights=[sun, low], light_collections=["", ""])
        scene.world.radiance = (0.1, 0.1, 0.1)
        found = lw.read(scene_folder.write_scene(scene, scratch(self)))
        self.assertIsNotNone(found)
        said = " ".join(scene.notes)
        self.assertIn("2049 lx across its rays", said)
        self.assertIn("214.6 lx on open ground", said)
        self.assertIn("below the horizon (low)", said)

    def test_lights_that_the_program_would_refuse(self):
        scene = room(
            lights=[
                Light("black", "AREA", 5.0, colour=(0.0, 0.0, 0.0), position=(1, 1, 2), size=(0.1, 0.1)),
                Light("file", "POINT", 5.0, photometry="luminaires/a.ies", factor=0.0, position=(1, 1, 2)),
                Light("wide", "SUN", 3.0, aim=(0.0, 0.6, -0.8), angle=120.0),
                Light("dark sun", "SUN", 0.0, aim=(0.0, 0.6, -0.8)),
            ],
            light_collections=[""] * 4,
        )
        folder = scratch(self)
        path = scene_folder.write_scene(scene, folder)
        channels = scene_folder.channel_arguments(scene.emitters, "LIGHT")
        self.assertEqual(channels, ["--channels", "sun=sun"])
        run_program("solve", path, "-o", os.path.join(folder, "s.vtp"), "--rays", "64", "--refine", "off", *channels)
        said = " ".join(scene.notes)
        self.assertIn("3 lights that give no light (black, file, dark sun)", said)
        self.assertIn("wide has a disc of 10 degrees instead of 120", said)

    def test_too_many_channels(self):
        with self.assertRaisesRegex(scene_folder.SceneError, "at most 256 channels"):
            scene_folder.channel_arguments({f"lamp {i}": "" for i in range(257)}, "LIGHT")

    def test_zip_has_the_same_bytes_again_and_no_earlier_zip(self):
        folder = scratch(self)
        whole = os.path.join(folder, "python", "blender")
        shutil.copytree(os.path.join(SOURCE, "python", "blender"), whole, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(os.path.join(SOURCE, "LICENSE"), folder)
        zips = []
        for _ in range(2):
            subprocess.run([sys.executable, "build_zip.py"], cwd=whole, check=True, capture_output=True)
            path = next(os.path.join(whole, name) for name in os.listdir(whole) if name.endswith(".zip"))
            with open(path, "rb") as file:
                zips.append(file.read())
            for place, _, names in os.walk(whole):
                for name in names:
                    os.utime(os.path.join(place, name), (1e9, 1e9))
        self.assertEqual(zips[0], zips[1])
        with zipfile.ZipFile(path) as packed:
            names = packed.namelist()
        self.assertIn("LICENSE", names)
        self.assertFalse([name for name in names if name.endswith((".zip", ".part")) or "test" in name])

    def test_equal_names_are_numbered_at_once(self):
        names = toml_text.plain_names(["lamp", "lamp 3", *["lamp"] * 20000])
        self.assertEqual([names[k] for k in (2, 3, 20001)], ["lamp 2", "lamp 4", "lamp 20002"])

    def test_text(self):
        self.assertEqual(toml_text.value_text({"a": [1, 0.5, True]}), "{ a = [1, 0.5, true] }")
        self.assertEqual(toml_text.plain_names(["a", "a", "a 2"]), {0: "a", 1: "a 2", 2: "a 2 2"})


if __name__ == "__main__":
    unittest.main()
