"""Scenes for the tests of the add-on, made in Blender."""

import os
import sys
import tempfile
import unittest
from typing import Sequence, Tuple

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

import blender as addon  # noqa: E402

PROGRAM = os.environ.get("LIGHTWELL_PROGRAM", "lightwell")
Place = Tuple[float, float, float]


def empty_scene() -> bpy.types.Scene:
    """A scene without anything, with a black world."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    return scene


def matt(name: str, colour: Place) -> bpy.types.Material:
    """A diffuse material."""
    found = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        found.use_nodes = True
    shader = found.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Specular IOR Level"].default_value = 0.0
    return found


def add_mesh(name: str, points: Sequence[Place], faces, material=None) -> bpy.types.Object:
    """An object of a mesh."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    if material:
        mesh.materials.append(material)
    found = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(found)
    return found


BOX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def add_box(name: str, low: Place, high: Place, material=None) -> bpy.types.Object:
    """A box whose fronts are outside."""
    points = [tuple((low, high)[i >> k & 1][k] for k in range(3)) for i in range(8)]
    return add_mesh(name, points, BOX_FACES, material)


def add_light(name: str, kind: str, place: Place, watts: float, **values: object) -> bpy.types.Object:
    """A light that shines down. Skips the test, by name, if this version of Blender lacks one of the values."""
    data = bpy.data.lights.new(name, kind)
    data.energy = watts
    for key, value in values.items():
        if not hasattr(data, key):
            raise unittest.SkipTest(f"Blender {bpy.app.version_string} has no {key} of lights")
        setattr(data, key, value)
    found = bpy.data.objects.new(name, data)
    found.location = place
    bpy.context.scene.collection.objects.link(found)
    return found


def cube_room() -> bpy.types.Scene:
    """Blender's cube of 2 m, of a reflectance of 0.5, with an area light below its ceiling."""
    scene = empty_scene()
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, 1))
    bpy.context.object.data.materials.append(matt("walls", (0.5, 0.5, 0.5)))
    add_light("Area", "AREA", (0, 0, 1.75), 10.0, size=0.5)
    return scene


def three_rooms() -> bpy.types.Scene:
    """Three rooms in a row, 4 m x 4 m x 2.75 m, with doors cut out of the walls between, furniture and lights."""
    scene = empty_scene()
    wall, floor = matt("paint", (0.75, 0.74, 0.7)), matt("oak", (0.4, 0.28, 0.17))
    add_box("floor", (-0.2, -0.2, -0.2), (12.6, 4.2, 0), floor)
    add_box("ceiling", (-0.2, -0.2, 2.75), (12.6, 4.2, 2.95), wall)
    add_box("south", (-0.2, -0.2, 0), (12.6, 0, 2.75), wall)
    add_box("north", (-0.2, 4, 0), (12.6, 4.2, 2.75), wall)
    add_box("west", (-0.2, 0, 0), (0, 4, 2.75), wall)
    add_box("east", (12.4, 0, 0), (12.6, 4, 2.75), wall)
    for number, x in enumerate((4.0, 8.2)):
        between = add_box(f"wall {number + 1}", (x, 0, 0), (x + 0.2, 4, 2.75), wall)
        door = add_box(f"door cut {number + 1}", (x - 0.1, 1.5, -0.1), (x + 0.3, 2.4, 2.1))
        door.hide_render = True
        door.display_type = "WIRE"
        cut = between.modifiers.new("door", "BOOLEAN")
        cut.operation, cut.object = "DIFFERENCE", door
    for number, x in enumerate((2.0, 6.2, 10.4)):
        add_box(f"table {number + 1}", (x - 0.6, 2.9, 0.70), (x + 0.6, 3.7, 0.74), floor)
        add_light(f"lamp {number + 1}", "AREA", (x, 2, 2.7), (4.0, 2.0, 6.0)[number], size=0.6)
    add_light("spot", "SPOT", (2.0, 3.3, 2.6), 20.0, spot_size=0.9, spot_blend=0.3)
    return scene


def solve(scene):
    """Solves in place; returns the message, or that of the error."""
    try:
        bpy.ops.lightwell.solve()
    except RuntimeError as error:
        return str(error)
    return scene.lightwell.message


def lux_at(scene, place):
    """Lux on the first front below a place."""
    reader = addon.overlay.Reader(addon.show.light_object(scene))
    return reader.at(Vector(place), Vector((0, 0, -1))).lux


def notes():
    return bpy.data.texts[addon.solve.NOTES].as_string()


class InFolder(unittest.TestCase):
    """Tests with a folder of their own, for the .blend file."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def save(self):
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(self.folder, "room.blend"))
