"""The add-on in Blender without a window: the same lux as a scene by hand, and sentences for bad input."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from types import SimpleNamespace

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Matrix  # noqa: E402
from rooms import (  # noqa: E402
    PROGRAM,
    InFolder,
    add_box,
    add_light,
    add_mesh,
    addon,
    cube_room,
    empty_scene,
    lux_at,
    matt,
    notes,
    solve,
    three_rooms,
)

# The cube of cube_room() with Blender's order of corners, and its light as a panel that shines down.
CUBE_BY_HAND = """
[materials.walls]
reflectance = 0.5
[materials.panel]
reflectance = 0
power = [10, 10, 10]
sides = "one"
[[surfaces]]
name = "Cube"
material = "walls"
polygons = [
  [[-1, -1, 0], [-1, -1, 2], [-1, 1, 2], [-1, 1, 0]],
  [[-1, 1, 0], [-1, 1, 2], [1, 1, 2], [1, 1, 0]],
  [[1, 1, 0], [1, 1, 2], [1, -1, 2], [1, -1, 0]],
  [[1, -1, 0], [1, -1, 2], [-1, -1, 2], [-1, -1, 0]],
  [[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]],
  [[1, 1, 2], [-1, 1, 2], [-1, -1, 2], [1, -1, 2]],
]
[[surfaces]]
name = "Area"
material = "panel"
polygon = [[-0.25, -0.25, 1.75], [-0.25, 0.25, 1.75], [0.25, 0.25, 1.75], [0.25, -0.25, 1.75]]
"""


class Room(InFolder):
    """The lux and the words of rooms."""

    def test_cube_has_the_lux_of_the_room_written_by_hand(self):
        scene = cube_room()
        self.save()
        self.assertRegex(solve(scene), r"^\d+ elements in")
        by_hand = os.path.join(self.folder, "by-hand.toml")
        with open(by_hand, "w", encoding="utf-8") as file:
            file.write(CUBE_BY_HAND)
        solution = os.path.join(self.folder, "by-hand.vtp")
        arguments = [PROGRAM, "solve", by_hand, "-o", solution, "--channels", "Area=Area"]
        subprocess.run(arguments, check=True, capture_output=True)
        ours = addon.show.solution_of(scene)
        theirs = addon.show.read_solution(solution)
        # The light's corners are float32 in Blender: exact, as all numbers of this room are.
        np.testing.assert_array_equal(ours.points, theirs.points)
        np.testing.assert_allclose(ours.lux([1.0]), theirs.lux([1.0]), rtol=1e-6)
        self.assertAlmostEqual(ours.flux[0], 6830.0, delta=6830 * 1e-6)

    def test_dimming_is_linear_and_a_reading_is_that_of_the_program(self):
        scene = cube_room()
        add_light("Point", "POINT", (0.5, 0.5, 1.0), 3.0, shadow_soft_size=0.0)
        self.save()
        solve(scene)
        place = (0.31, -0.17, 1.0)
        both = lux_at(scene, place)
        points = os.path.join(self.folder, "points.csv")
        with open(points, "w", encoding="utf-8") as file:
            file.write(f"x,y,z,nx,ny,nz\n{place[0]},{place[1]},0,0,0,1\n")
        folder = os.path.join(self.folder, "room-lightwell")
        out = os.path.join(self.folder, "lux.csv")
        files = [os.path.join(folder, name) for name in ("scene.toml", "solution.vtp")]
        command = [PROGRAM, "probe", *files, "--points", points, "-o", out, "--interpolate"]
        subprocess.run(command, check=True, capture_output=True)
        with open(out, encoding="utf-8") as file:
            head, row = (line.split(",") for line in file.read().splitlines()[:2])
        # Weights and values are floats of 24 bits in Blender; a sum of four keeps 1e-6.
        self.assertAlmostEqual(both / float(row[head.index("lux")]), 1.0, delta=1e-5)
        scene.lightwell.channels["Point"].level = 0.0
        area = lux_at(scene, place)
        scene.lightwell.channels["Point"].level = 0.5
        self.assertAlmostEqual(lux_at(scene, place) / (0.5 * (area + both)), 1.0, delta=1e-5)

    def test_three_rooms_with_doors_are_solved_and_shown(self):
        scene = three_rooms()
        self.save()
        self.assertRegex(solve(scene), r"^\d+ elements in")
        # A wall keeps the lamp of its room out of the next but one: only light through two doors arrives.
        for channel in scene.lightwell.channels:
            channel.level = 1.0 if channel.name == "lamp 3" else 0.0
        self.assertGreater(lux_at(scene, (10.4, 2, 1)), 100 * lux_at(scene, (2, 2, 1)))
        self.assertGreater(lux_at(scene, (2, 2, 1)), 0.0)
        self.assertIn("2 objects hidden in renders", notes())

    def test_feet_are_metres_in_the_scene_and_feet_in_the_view(self):
        scene = cube_room()
        self.save()
        solve(scene)
        metres = lux_at(scene, (0.3, 0.2, 1.0))
        scene.unit_settings.system = "IMPERIAL"
        scene.unit_settings.scale_length = 0.3048
        solve(scene)
        feet = lux_at(scene, (0.3, 0.2, 1.0))
        # The same watts in a room 0.3048 times as large; the room's own noise of rays is scaled alike,
        # and rounds otherwise.
        self.assertAlmostEqual(feet * 0.3048**2 / metres, 1.0, delta=1e-3)
        self.assertIn("0.3048 m", notes())

    def test_all_that_is_visible_is_exported_once(self):
        scene = empty_scene()
        bpy.ops.object.text_add()
        bpy.context.object.data.materials.append(matt("ink", (0.1, 0.1, 0.1)))
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.1
        bpy.ops.object.metaball_add()
        add_light("lamp", "POINT", (0, 0, 3), 5.0)
        library = bpy.data.collections.new("library")
        box = add_box("box", (0, 0, 0), (1, 1, 1))
        box.modifiers.new("fine", "SUBSURF").levels = 1
        scene.collection.objects.unlink(box)
        library.objects.link(box)
        for number in range(2):
            place = bpy.data.objects.new("place", None)
            place.instance_type, place.instance_collection = "COLLECTION", library
            place.location = (5 * number, 0, 0)
            place.scale = (1, 2, -1)
            scene.collection.objects.link(place)
        bpy.context.view_layer.update()
        exported = addon.read_scene.read_scene(bpy.context)
        names = sorted(surface.name for surface in exported.surfaces)
        self.assertEqual(names, ["BézierCircle", "Mball", "Text", "box", "box"])
        self.assertEqual({s.name: s.material for s in exported.surfaces}["Text"], "ink")
        boxes = [s.mesh for s in exported.surfaces if s.name == "box"]
        self.assertEqual([len(mesh) for mesh in boxes], [24, 24])
        # A mirrored body keeps its fronts outside.
        self.assertTrue(all(addon.read_scene.is_closed(mesh) for mesh in boxes))

    def test_what_collections_hide_in_renders_is_left_out(self):
        scene = empty_scene()
        add_light("lamp", "POINT", (0, 0, 3), 5.0)
        kinds = {}
        for name in ("hidden", "parent", "child", "shown", "library", "cutters"):
            kinds[name] = bpy.data.collections.new(name)
        for home, names in ((scene.collection, ("hidden", "parent", "shown")), (kinds["parent"], ("child",))):
            for name in names:
                home.children.link(kinds[name])
        kinds["library"].children.link(kinds["cutters"])
        for name in ("hidden", "parent", "cutters"):
            kinds[name].hide_render = True
        for name, homes in (
            ("cutter", ("hidden",)),
            ("deep", ("child",)),
            ("twice", ("hidden", "shown")),
            ("instanced", ("library",)),
            ("cutter of the library", ("cutters",)),
        ):
            box = add_box(name, (0, 0, 0), (1, 1, 1))
            scene.collection.objects.unlink(box)
            for home in homes:
                kinds[home].objects.link(box)
        for name, home in (("place", "shown"), ("hidden place", "hidden")):
            place = bpy.data.objects.new(name, None)
            place.instance_type, place.instance_collection = "COLLECTION", kinds["library"]
            kinds[home].objects.link(place)
        bpy.context.view_layer.update()
        exported = addon.read_scene.read_scene(bpy.context)
        self.assertEqual(sorted(surface.name for surface in exported.surfaces), ["instanced", "twice"])
        self.assertIn("hidden in renders", " ".join(exported.notes))

    def test_pictures_of_half_floats_are_converted_but_for_light(self):
        scene = cube_room()
        pixels = np.full((4, 4, 4), 1.0, np.float32)
        pixels[:, :, :3] = 0.25
        images = []
        for name, factor in (("walls", 1.0), ("black", 0.0)):
            image = bpy.data.images.new(name, 4, 4, float_buffer=True)
            image.pixels.foreach_set((pixels * [factor, factor, factor, 1.0]).astype(np.float32).ravel())
            image.filepath_raw, image.file_format = os.path.join(self.folder, f"{name}.exr"), "OPEN_EXR"
            image.save()
            images.append(bpy.data.images.load(image.filepath_raw))
        cube = scene.objects["Cube"]
        cube.data.materials[0] = matt("pictures", (1, 1, 1))
        panel = add_mesh("panel", [(-1, -1, 0.5), (1, -1, 0.5), (0, 0, 0.5)], [(0, 1, 2)], matt("glow", (0, 0, 0)))
        uv = panel.data.uv_layers.new()
        uv.data.foreach_set("uv", [0.0, 0.0, 1.0, 0.0, 0.0, 1.0])
        dark = add_mesh("dark", [(-1, -1, 0.6), (1, -1, 0.6), (0, 0, 0.6)], [(0, 1, 2)], matt("dark", (0, 0, 0)))
        dark.data.uv_layers.new()
        sockets = (("pictures", 0, "Base Color"), ("glow", 0, "Emission Color"), ("dark", 1, "Emission Color"))
        for material, image, socket in sockets:
            tree = bpy.data.materials[material].node_tree
            node = tree.nodes.new("ShaderNodeTexImage")
            node.image = images[image]
            tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs[socket])
            if socket == "Emission Color":
                tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = 1.0
        self.assertRegex(solve(scene), r"^\d+ elements in")
        exported = addon.read_scene.read_scene(bpy.context)
        endings = {name: os.path.splitext(name)[1] for name in exported.files}
        self.assertEqual(sorted(endings.values()), [".exr", ".exr", ".png"])
        self.assertEqual([c.name for c in scene.lightwell.channels], ["panel", "Area"])
        png = next(name for name in endings if name.endswith(".png"))
        path = os.path.join(self.folder, "again.png")
        with open(path, "wb") as file:
            file.write(exported.files[png])
        again = bpy.data.images.load(path)
        # sRGB of 0.25 in eight bits: half a step of 1 / 255.
        self.assertAlmostEqual(again.pixels[0], 1.055 * 0.25 ** (1 / 2.4) - 0.055, delta=0.5 / 255 + 1e-6)

    def test_what_is_left_out_of_nodes_and_visibility_is_said(self):
        scene = cube_room()
        tree = bpy.data.materials["walls"].node_tree
        shader, output = tree.nodes["Principled BSDF"], tree.get_output_node("ALL")
        shader.inputs["Specular Tint"].default_value = (1, 0.5, 0.5, 1)
        for kind, socket in (("ShaderNodeVolumeScatter", "Volume"), ("ShaderNodeDisplacement", "Displacement")):
            tree.links.new(tree.nodes.new(kind).outputs[0], output.inputs[socket])
        scene.objects["Cube"].visible_glossy = False
        scene.objects["Area"].data.use_shadow = False
        scene.objects["Area"].light_linking.receiver_collection = bpy.data.collections.new("lit")
        world = scene.world.node_tree
        world.links.new(world.nodes.new("ShaderNodeValue").outputs[0], world.nodes["Background"].inputs["Strength"])
        bpy.context.view_layer.update()
        self.assertRegex(solve(scene), r"^\d+ elements in")
        said = notes()
        for words in ("specular tint", "a volume", "displacement", "glossy rays", "casts shadows", "light linking"):
            self.assertIn(words, said)
        self.assertIn("linked to the world's strength", said)

    def test_properties_that_are_no_numbers_and_cameras_of_scale_0(self):
        scene = cube_room()
        data = scene.objects["Area"].data
        file = os.path.join(os.path.dirname(__file__), *[".."] * 3, "docs", "luminaires", "downlight.ies")
        data["lightwell_ies"], data["lightwell_factor"] = file, "a half"
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        camera.location, camera.scale = (0, 0, 5), (2, 2, 2)
        camera.data.dof.use_dof, camera.data.dof.focus_object = True, scene.objects["Cube"]
        flat = bpy.data.objects.new("flat", camera.data)
        flat.scale = (1, 1, 0)
        for found in (camera, flat):
            scene.collection.objects.link(found)
        bpy.context.view_layer.update()
        exported = addon.read_scene.read_scene(bpy.context)
        self.assertAlmostEqual({c.name: c.focus for c in exported.cameras}["camera"], 4.0, places=6)
        self.assertIn("is no number from 0 on (a half)", " ".join(exported.notes))

    def test_photometric_files_give_their_own_lumens(self):
        file = os.path.join(os.path.dirname(__file__), *[".."] * 3, "docs", "luminaires", "downlight.ies")
        info = subprocess.run([PROGRAM, "info", file, "--json"], check=True, capture_output=True, text=True)
        lumens = json.loads(info.stdout)["lumens"]
        scene = cube_room()
        scene.objects["Area"].data["lightwell_ies"] = file
        scene.objects["Area"].data["lightwell_factor"] = 0.5
        text = bpy.data.texts.new("lamp.ies")
        with open(file, encoding="latin-1") as source:
            text.write(source.read())
        data = add_light("nodes", "POINT", (0.4, 0, 1.5), 10.0).data
        data.use_nodes = True
        node = data.node_tree.nodes.new("ShaderNodeTexIES")
        node.ies = text
        solve(scene)
        found = {channel.name: channel.lumens for channel in scene.lightwell.channels}
        # Fluxes are sums of floats over the bands.
        self.assertAlmostEqual(found["Area"] / lumens, 0.5, delta=1e-5)
        self.assertAlmostEqual(found["nodes"] / lumens, 1.0, delta=1e-5)
        self.assertIn("its watts do not count", notes())


class Interface(unittest.TestCase):
    """What the mouse and the panel call, without a window."""

    def test_cursor_reads_and_keeps_lux(self):
        scene = cube_room()
        solve(scene)
        found = addon.show.light_object(scene)
        region = SimpleNamespace(type="WINDOW", x=100, y=50, width=400, height=400)
        # From 1.5 m above the floor, half a metre to each side.
        matrix = Matrix.Translation((0, 0, -1.5))
        view = SimpleNamespace(
            view_matrix=matrix,
            perspective_matrix=Matrix.Diagonal((2, 2, -0.1, 1)) @ matrix,
            is_perspective=False,
            view_perspective="ORTHO",
        )
        space = SimpleNamespace(region_3d=view)
        seen = SimpleNamespace(type="VIEW_3D", regions=[region], spaces=SimpleNamespace(active=space), tag_redraw=int)
        window = SimpleNamespace(cursor_modal_restore=lambda: None)
        context = SimpleNamespace(scene=scene, screen=SimpleNamespace(areas=[seen]), window=window)
        operator = SimpleNamespace(reader=addon.overlay.Reader(found))
        kind = addon.overlay.LIGHTWELL_OT_read
        operator._look = lambda *args: kind._look(operator, *args)
        event = SimpleNamespace(type="LEFTMOUSE", value="PRESS", mouse_x=300, mouse_y=250)
        self.assertEqual(kind.modal(operator, context, event), {"RUNNING_MODAL"})
        words = addon.overlay.kept_readings(scene)
        self.assertEqual(len(words), 1)
        lux = lux_at(scene, (words[0][1].x, words[0][1].y, 1.0))
        self.assertEqual(words[0][0], addon.show.lux_text(lux))
        scene.lightwell.channels[0].level = 0.5
        self.assertEqual(addon.overlay.kept_readings(scene)[0][0], addon.show.lux_text(lux / 2))
        scene.lightwell.effort, scene.lightwell.accuracy = "ACCURACY", 20.0
        solve(scene)
        again = float(addon.overlay.kept_readings(scene)[0][0].split()[0])
        self.assertAlmostEqual(again / (lux / 2), 1.0, delta=0.4)  # errors of 20 % each
        escape = SimpleNamespace(type="ESC", value="PRESS", mouse_x=300, mouse_y=250)
        self.assertEqual(kind.modal(operator, context, escape), {"CANCELLED"})

    def test_panel_names_what_there_is(self):
        scene = cube_room()
        solve(scene)
        bpy.context.view_layer.objects.active = scene.objects["Area"]
        layout = Layout(self)
        for panel in addon.panel.CLASSES:
            if getattr(panel, "poll", lambda _: True)(bpy.context):
                panel.draw(SimpleNamespace(layout=layout), bpy.context)
        for name in ("solve", "read", "lightmaps", "export"):
            self.assertIn(f"lightwell.{name}", layout.said)
        self.assertIn("Area: 10 W radiant, 6830 lm", layout.said)
        self.assertIn("Area  6830 lm", layout.said)


class Layout:
    """Stands for a panel's layout: holds that properties and operators exist, and keeps the words."""

    def __init__(self, test):
        self.test = test
        self.said = []

    def row(self, **_):
        return self

    column = row

    def prop(self, data, name, text="", **_):
        self.test.assertIn(name, data.bl_rna.properties)
        self.said.append(text)

    def operator(self, name, **_):
        room, short = name.split(".")
        self.test.assertTrue(hasattr(bpy.types, f"{room.upper()}_OT_{short}"))
        self.said.append(name)

    def label(self, text):
        self.said.append(text)


class BadInput(unittest.TestCase):
    """Each is a sentence, and Blender goes on."""

    def test_no_light(self):
        scene = empty_scene()
        add_box("box", (0, 0, 0), (1, 1, 1))
        self.assertIn("nothing shines in the scene", solve(scene))

    def test_no_faces_and_hidden_objects(self):
        scene = empty_scene()
        add_light("lamp", "POINT", (0, 0, 1), 5.0)
        self.assertIn("no visible object has faces", solve(scene))
        add_box("box", (0, 0, 0), (1, 1, 1)).hide_set(True)
        self.assertIn("no visible object has faces", solve(scene))

    def test_damaged_meshes_and_values(self):
        scene = empty_scene()
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1), (0.5, 0.5, 1)]
        add_mesh("fan", points, [(0, 1, 4), (0, 1, 2, 3), (1, 0, 5), (0, 4, 5)], matt("m", (1.5, 1, 1)))
        add_mesh("star", [(0, 0, 2), (1, 1, 2), (1, 0, 2), (0, 1, 2)], [(0, 1, 2, 3)])
        add_mesh("far", [(math.nan, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        add_light("negative", "POINT", (0, 0, 1), -5.0)
        add_light("lamp", "POINT", (0.2, 0.3, 3), 5.0)
        self.assertRegex(solve(scene), r"^\d+ elements in")
        for said in ("not finite (far)", "negative has negative watts", "not saved", "base colour above 1"):
            self.assertIn(said, notes())

    def test_photometric_file_that_is_missing_or_wrong(self):
        scene = cube_room()
        scene.objects["Area"].data["lightwell_ies"] = "/nowhere/lamp.ies"
        self.assertRegex(solve(scene), r"^\d+ elements in")
        self.assertIn("/nowhere/lamp.ies (No such file or directory)", notes())
        with tempfile.NamedTemporaryFile("w", suffix=".ies") as file:
            file.write("no luminaire")
            file.flush()
            scene.objects["Area"].data["lightwell_ies"] = file.name
            self.assertIn("luminaires/", solve(scene))

    def test_program_of_another_version_or_none(self):
        scene = cube_room()
        with tempfile.TemporaryDirectory() as folder:
            fake = os.path.join(folder, "lightwell")
            with open(fake, "w", encoding="utf-8") as file:
                file.write("#!/bin/sh\necho lightwell 9.3.0\n")
            os.chmod(fake, 0o755)
            for program, said in ((fake, "is Lightwell 9.3"), ("/bin/ls", "is not Lightwell"), ("/no", "no program")):
                os.environ["LIGHTWELL_PROGRAM"] = program
                self.addCleanup(os.environ.__setitem__, "LIGHTWELL_PROGRAM", PROGRAM)
                self.assertIn(said, solve(scene))

    def test_scene_file_of_somebody_else(self):
        scene = cube_room()
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "scene.toml"), "w", encoding="utf-8") as file:
                file.write("# mine\n")
            scene.lightwell.folder = folder
            self.assertIn("was not written by this add-on", solve(scene))


if __name__ == "__main__":
    addon.register()
    unittest.main()
