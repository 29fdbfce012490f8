"""The legend of the false colours in the 3D view, and lux under the cursor."""

from dataclasses import dataclass
from typing import List, Optional, Tuple

import blf
import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from . import show
from .logic.colours import Scale, bilinear, false_colours, lux_text
from .properties import undo_step

WIDTH, HEIGHT, MARGIN = 18, 220, 28  # of the legend, in pixels at the usual size of the interface

_handle: Optional[object] = None
_reading: Optional[Tuple[Tuple[int, int], str]] = None  # beside the cursor: where, and what


@dataclass(frozen=True)
class Reading:
    """Lux at a place, and the vertices of the light's object that it lies between."""

    lux: float
    place: Vector
    normal: Vector
    corners: Tuple[int, ...]
    weights: Tuple[float, ...]


class Reader:
    """Lux at places of the light that is shown."""

    def __init__(self, found: bpy.types.Object):
        mesh = found.data
        self.points = [vertex.co.copy() for vertex in mesh.vertices]
        self.elements = [tuple(polygon.vertices) for polygon in mesh.polygons]
        self.tree = BVHTree.FromPolygons(self.points, self.elements)
        self.mesh = mesh

    def at(self, origin: Vector, direction: Vector) -> Optional[Reading]:
        """The first front that a ray meets; None if it meets none."""
        way = direction.normalized()
        for _ in range(1000):
            place, normal, element, _ = self.tree.ray_cast(origin, way)
            if place is None:
                return None
            if normal.dot(way) < 0.0:
                return self._reading(element, place, normal)
            origin = place + 1e-5 * way  # backs are not drawn
        return None

    def _reading(self, element: int, place: Vector, normal: Vector) -> Reading:
        corners = self.elements[element]
        values = self.mesh.attributes[show.LUX].data
        weights = bilinear(np.array([self.points[c] for c in corners], float), np.array(place, float))
        lux = float(sum(w * values[c].value for w, c in zip(weights, corners)))
        return Reading(lux, place, normal, corners, tuple(float(w) for w in weights))


def draw() -> None:
    """Draws the legend, the kept readings, and the reading at the cursor into a 3D view."""
    context = bpy.context
    scene = context.scene
    found = show.light_object(scene)
    if found is None or not found.visible_get():
        return
    size = context.preferences.system.ui_scale
    if scene.lightwell.view == "LUX":
        draw_legend(show.scale(scene), size)
    for label, place in kept_readings(scene):
        flat = view3d_utils.location_3d_to_region_2d(context.region, context.region_data, place)
        if flat is not None:
            draw_text(label, (int(flat.x) + 6, int(flat.y) + 6), size)
    if _reading is not None:
        place, said = _reading
        draw_text(said, (place[0] + 16, place[1] + 10), size)


def kept_readings(scene: bpy.types.Scene) -> List[Tuple[str, Vector]]:
    """Readings that a click has kept: empties with their lux."""
    return [(found[show.MARK], found.matrix_world.translation) for found in scene.objects if show.MARK in found]


def legend_triangles(scale: Scale, size: float) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (pixels), colours and triangles of the legend's bar."""
    rows = 33
    heights = np.linspace(0.0, 1.0, rows)
    low = scale.low if scale.low > 0 else 0.0
    lux = scale.high * heights if low == 0.0 else low * (scale.high / low) ** heights
    colours = np.repeat(np.column_stack([false_colours(lux, scale), np.ones(rows)]), 2, axis=0)
    left = MARGIN * size
    points = np.empty((2 * rows, 2))
    points[:, 0] = np.tile([left, left + WIDTH * size], rows)
    points[:, 1] = np.repeat(2 * MARGIN * size + HEIGHT * size * heights, 2)
    k = 2 * np.arange(rows - 1)[:, None]
    return points, colours, np.concatenate([k + [0, 1, 3], k + [0, 3, 2]])


def draw_legend(scale: Scale, size: float) -> None:
    """Draws the bar of colours with its lux."""
    points, colours, triangles = legend_triangles(scale, size)
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    values = {"pos": points.tolist(), "color": colours.tolist()}
    batch_for_shader(shader, "TRIS", values, indices=triangles.tolist()).draw(shader)
    for value in scale.steps():
        height = 2 * MARGIN * size + HEIGHT * size * float(scale.place(np.array(value)))
        draw_text(f"{value:g}", (int((MARGIN + WIDTH + 6) * size), int(height - 4 * size)), size)
    draw_text("lx", (int(MARGIN * size), int((2 * MARGIN + HEIGHT + 8) * size)), size)


def draw_text(words: str, place: Tuple[int, int], size: float) -> None:
    """Draws white words with a dark rim."""
    font = 0
    blf.size(font, 12 * size)
    blf.enable(font, blf.SHADOW)
    blf.shadow(font, 3, 0.0, 0.0, 0.0, 0.9)
    blf.color(font, 1.0, 1.0, 1.0, 1.0)
    blf.position(font, place[0], place[1], 0)
    blf.draw(font, words)
    blf.disable(font, blf.SHADOW)


class LIGHTWELL_OT_read(bpy.types.Operator):
    """Lux under the cursor; a click keeps the reading, Escape or right click ends"""

    bl_idname = "lightwell.read"
    bl_label = "Lux under the Cursor"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return show.light_object(context.scene) is not None and context.area is not None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event):
        self.reader = Reader(show.light_object(context.scene))
        context.window_manager.modal_handler_add(self)
        context.window.cursor_modal_set("EYEDROPPER")
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event):
        global _reading
        found = show.light_object(context.scene)
        if found is None or found.data != self.reader.mesh or event.type in {"ESC", "RIGHTMOUSE"}:
            _reading = None
            context.window.cursor_modal_restore()
            _redraw_views(context)
            return {"CANCELLED"}
        region = _view_region(context, event)
        if region is None or event.type not in {"MOUSEMOVE", "LEFTMOUSE"}:
            return {"PASS_THROUGH"}
        hit, place = self._look(*region, event)
        _reading = (place, lux_text(hit.lux)) if hit else None
        _redraw_views(context)
        if event.type == "LEFTMOUSE" and event.value == "PRESS" and hit:
            keep_reading(context.scene, hit)
            undo_step("Keep Reading")
        return {"RUNNING_MODAL"} if event.type == "LEFTMOUSE" else {"PASS_THROUGH"}

    def _look(self, region, space, event):
        place = (event.mouse_x - region.x, event.mouse_y - region.y)
        view = space.region_3d
        origin = view3d_utils.region_2d_to_origin_3d(region, view, place)
        direction = view3d_utils.region_2d_to_vector_3d(region, view, place)
        return self.reader.at(origin, direction), place


def _view_region(context: bpy.types.Context, event: bpy.types.Event):
    """The 3D view under the mouse: its region and space."""
    for area in context.screen.areas:
        if area.type != "VIEW_3D":
            continue
        for region in area.regions:
            inside = 0 <= event.mouse_x - region.x < region.width and 0 <= event.mouse_y - region.y < region.height
            if inside and region.type != "WINDOW":
                return None  # a panel over the view
        for region in area.regions:
            inside = 0 <= event.mouse_x - region.x < region.width and 0 <= event.mouse_y - region.y < region.height
            if inside and region.type == "WINDOW":
                return region, area.spaces.active
    return None


def keep_reading(scene: bpy.types.Scene, reading: Reading) -> bpy.types.Object:
    """Marks a place with its lux."""
    found = bpy.data.objects.new("lux", None)
    found.empty_display_type = "SINGLE_ARROW"
    found.empty_display_size = 0.2 / show.metres_of(scene)
    found.location = reading.place
    found.rotation_mode = "QUATERNION"
    found.rotation_quaternion = reading.normal.to_track_quat("Z", "Y")
    _set_mark(found, reading)
    show.collection_of(scene, "Lightwell").objects.link(found)
    return found


def _set_mark(found: bpy.types.Object, reading: Optional[Reading]) -> None:
    found[show.MARK] = lux_text(reading.lux) if reading else "no light here"
    found[show.CORNERS] = list(reading.corners) if reading else [2**31 - 1]
    found[show.WEIGHTS] = list(reading.weights) if reading else [0.0]


class LIGHTWELL_OT_clear_readings(bpy.types.Operator):
    """Remove the readings that clicks have kept"""

    bl_idname = "lightwell.clear_readings"
    bl_label = "Clear Readings"
    bl_options = {"UNDO"}

    def execute(self, context: bpy.types.Context):
        for found in [found for found in context.scene.objects if show.MARK in found]:
            bpy.data.objects.remove(found)
        return {"FINISHED"}


def refresh_readings(scene: bpy.types.Scene) -> None:
    """Finds kept places again on the elements of another solve."""
    marks = [mark for mark in scene.objects if show.MARK in mark]
    if not marks:
        return
    reader = Reader(show.light_object(scene))
    for mark in marks:
        normal = mark.rotation_quaternion @ Vector((0.0, 0.0, 1.0))
        reach = 0.01 / show.metres_of(scene)
        _set_mark(mark, reader.at(mark.location + reach * normal, -normal))


def _redraw_views(context: bpy.types.Context) -> None:
    for area in context.screen.areas:
        if area.type == "VIEW_3D":
            area.tag_redraw()


CLASSES = (LIGHTWELL_OT_read, LIGHTWELL_OT_clear_readings)


def attach() -> None:
    global _handle
    if not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL")


def detach() -> None:
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
