"""Draws three rooms as the 3D view shows them, with the add-on's own legend and readings.

    LIGHTWELL_PROGRAM=build/release/cli/lightwell xvfb-run python python/blender/tests/picture.py PICTURE.png
"""

import math
import os
import sys

import bpy
import gpu
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from rooms import addon, three_rooms  # noqa: E402

WIDTH, HEIGHT = 1200, 560


def view(scene: bpy.types.Scene) -> bpy.types.Object:
    """A camera above the rooms, and Blender's solid view without shading."""
    data = bpy.data.cameras.new("above")
    data.type = "ORTHO"
    data.ortho_scale = 15.0
    camera = bpy.data.objects.new("above", data)
    camera.location = (5.8, -7.8, 14.4)
    camera.rotation_euler = (math.radians(36), 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.film_transparent = False
    shading = scene.display.shading
    shading.light, shading.color_type, shading.show_backface_culling = "FLAT", "VERTEX", True
    scene.view_settings.view_transform = "Standard"
    return camera


def overlay(scene: bpy.types.Scene, camera: bpy.types.Object) -> np.ndarray:
    """The legend and the readings on black, as rows from below."""
    target = gpu.types.GPUOffScreen(WIDTH, HEIGHT)
    with target.bind():
        buffer = gpu.state.active_framebuffer_get()
        buffer.clear(color=(0.0, 0.0, 0.0, 0.0))
        with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            to_pixels = Matrix.Diagonal((2 / WIDTH, 2 / HEIGHT, 1, 1))
            gpu.matrix.load_projection_matrix(Matrix.Translation((-1, -1, 0)) @ to_pixels)
            addon.overlay.draw_legend(addon.show.scale(scene), 1.3)
            for words, place in addon.overlay.kept_readings(scene):
                flat = world_to_camera_view(scene, camera, place)
                addon.overlay.draw_text(words, (int(flat.x * WIDTH), int(flat.y * HEIGHT)), 1.3)
        pixels = buffer.read_color(0, 0, WIDTH, HEIGHT, 4, 0, "UBYTE")
    return np.array(pixels.to_list(), float).reshape(HEIGHT, WIDTH, 4) / 255


def draw(path: str) -> None:
    """Solves the rooms, and writes their picture."""
    scene = three_rooms()
    bpy.ops.lightwell.solve()
    print(scene.lightwell.message)
    found = addon.show.light_object(scene)
    found.hide_render = False
    reader = addon.overlay.Reader(found)
    for place in ((2.0, 1.2), (4.1, 1.95), (6.2, 1.2), (8.3, 1.95), (10.4, 1.2), (2.0, 3.3)):
        addon.overlay.keep_reading(scene, reader.at(Vector((*place, 1.5)), Vector((0, 0, -1))))
    camera = view(scene)
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(path)
    under = np.array(picture.pixels[:]).reshape(HEIGHT, WIDTH, 4)
    over = overlay(scene, camera)
    under[:, :, :3] = over[:, :, :3] + (1 - over[:, :, 3:]) * under[:, :, :3]
    picture.pixels.foreach_set(under.astype(np.float32).ravel())
    picture.filepath_raw = path
    picture.save()


if __name__ == "__main__":
    addon.register()
    draw(os.path.abspath(sys.argv[1]))
