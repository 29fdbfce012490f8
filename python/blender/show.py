"""The light as an object: the elements of the solve, with lux and colours at their vertices."""

import os
from typing import Dict, Optional

import bpy
import numpy as np

from . import properties
from .logic.cameras import metres_per_unit
from .logic.colours import Scale, false_colours, light_colours, linear, lux_text, scale_of
from .logic.solution import Solution, SolutionError, read_solution
from .read_scene import OWN

NAME = "Lightwell light"
MARK, CORNERS, WEIGHTS = "lightwell_reading", "lightwell_corners", "lightwell_weights"
"""Custom properties of a kept reading: its words, the vertices that it lies between, and their weights."""
ENDS = "lightwell_scale"
"""Custom property of the light's object: the ends of the scale that was chosen by the light."""
LUX, LIGHT_COLOURS, LUX_COLOURS = "lux", "light", "false colours"

_solutions: Dict[str, Solution] = {}  # by path; what is shown, for dimming; one at most


def collection_of(scene: bpy.types.Scene, name: str) -> bpy.types.Collection:
    """The scene's collection that the add-on made under that name, or one that has the very name."""
    children = list(scene.collection.children)
    own = [c for c in children if c.get(OWN) == name] + [c for c in children if c.name == name]
    found = own[0] if own else None
    if found is None:
        found = bpy.data.collections.new(name)
        found[OWN] = name  # Blender numbers equal names, as in a second scene
        scene.collection.children.link(found)
    return found


def light_object(scene: bpy.types.Scene) -> Optional[bpy.types.Object]:
    """The object that shows the light."""
    return next((found for found in scene.objects if found.get(OWN) == NAME), None)


def path_of(settings) -> str:
    """The file of the solution that is shown; empty if none is."""
    return os.path.normpath(bpy.path.abspath(settings.solution)) if settings.solution else ""


def solution_of(scene: bpy.types.Scene) -> Optional[Solution]:
    """The solution that is shown, read again after the .blend file was opened; None if it is gone."""
    path = path_of(scene.lightwell)
    if not path:
        return None
    if path not in _solutions:
        try:
            solution = read_solution(path)
        except SolutionError as error:
            scene.lightwell.message = str(error)[:400]
            return None
        _solutions.clear()
        _solutions[path] = solution
    return _solutions[path]


def show(scene: bpy.types.Scene, path: str, solution: Solution) -> None:
    """Puts a solution into the scene; levels of channels that were there before stay."""
    _solutions.clear()
    _solutions[path] = solution
    settings = scene.lightwell
    before = {channel.name: channel.level for channel in settings.channels}
    # Without a solution the levels below change no colours.
    settings.solution = ""
    settings.channels.clear()
    for name, lumens in zip(solution.channels, solution.flux):
        channel = settings.channels.add()
        channel.name = name
        channel.lumens = lumens
        channel.level = before.get(name, 1.0)
    settings.solution = bpy.path.relpath(path) if bpy.data.filepath else path
    # Readings lie between vertices of the mesh that goes.
    for mark in scene.objects:
        if MARK in mark:
            mark[CORNERS] = [2**31 - 1]
    _make_object(scene, solution)
    recolour(scene)
    look(bpy.context)


def _make_object(scene: bpy.types.Scene, solution: Solution) -> None:
    mesh = bpy.data.meshes.new(NAME)
    metres = metres_of(scene)
    count = len(solution.first) - 1
    mesh.vertices.add(len(solution.points))
    mesh.vertices.foreach_set("co", (solution.points / metres).astype(np.float32).ravel())
    mesh.loops.add(len(solution.corners))
    mesh.loops.foreach_set("vertex_index", solution.corners.astype(np.int32))
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", solution.first[:-1].astype(np.int32))
    mesh.update(calc_edges=True)
    mesh.attributes.new(LUX, "FLOAT", "POINT")
    for name in (LIGHT_COLOURS, LUX_COLOURS):
        mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    mesh.materials.append(_material())
    found = light_object(scene)
    if found is None:
        found = bpy.data.objects.new(NAME, mesh)
        found[OWN] = NAME
        found.hide_render = True
        found.show_in_front = True  # the scene's own faces lie in the same places
        collection_of(scene, "Lightwell").objects.link(found)
    else:
        old, found.data = found.data, mesh
        bpy.data.meshes.remove(old)


def metres_of(scene: bpy.types.Scene) -> float:
    """Metres in a unit of the scene."""
    return metres_per_unit(scene.unit_settings.system, scene.unit_settings.scale_length)


def _material() -> bpy.types.Material:
    """Shines in the colours at the vertices, for the view with materials and for renders."""
    found = bpy.data.materials.get(NAME)
    if found is not None:
        return found
    found = bpy.data.materials.new(NAME)
    if bpy.app.version < (5, 0, 0):
        found.use_nodes = True
    found.use_backface_culling = True
    nodes, links = found.node_tree.nodes, found.node_tree.links
    nodes.clear()
    colours = nodes.new("ShaderNodeVertexColor")
    shine = nodes.new("ShaderNodeEmission")
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(colours.outputs["Color"], shine.inputs["Color"])
    links.new(shine.outputs["Emission"], output.inputs["Surface"])
    return found


def scale(scene: bpy.types.Scene) -> Scale:
    """The scale of the false colours: the one given, or one for the light."""
    settings = scene.lightwell
    if settings.high > settings.low:
        return Scale(settings.low, settings.high)
    found = light_object(scene)
    if found is None:
        return Scale(0.0, 1.0)
    # Every redraw asks for the scale, and finding it takes a sort of all vertices.
    return Scale(*found[ENDS]) if ENDS in found else scale_of(vertex_lux(found.data))


def vertex_lux(mesh: bpy.types.Mesh) -> np.ndarray:
    """Lux at the vertices as shown."""
    values = np.empty(len(mesh.vertices), np.float32)
    mesh.attributes[LUX].data.foreach_get("value", values)
    return values


def recolour(scene: bpy.types.Scene) -> None:
    """Lux and colours at the levels of the channels; nothing where no light is shown."""
    found = light_object(scene)
    solution = solution_of(scene) if found else None
    if found is None or solution is None or len(solution.points) != len(found.data.vertices):
        return
    settings = scene.lightwell
    levels = properties.levels(settings)
    if len(levels) != len(solution.channels):
        return
    lux = solution.lux(levels)
    mesh = found.data
    mesh.attributes[LUX].data.foreach_set("value", lux.astype(np.float32))
    _set_colours(mesh, LIGHT_COLOURS, light_colours(solution.light(levels)))
    chosen = scale_of(lux)
    found[ENDS] = [chosen.low, chosen.high]
    _set_colours(mesh, LUX_COLOURS, linear(false_colours(lux, scale(scene))))
    mesh.attributes.active_color_name = LUX_COLOURS if settings.view == "LUX" else LIGHT_COLOURS
    mesh.attributes.render_color_index = mesh.color_attributes.find(mesh.attributes.active_color_name)
    mesh.update()
    update_readings(scene, lux)


def update_readings(scene: bpy.types.Scene, lux: np.ndarray) -> None:
    """The readings that clicks have kept, in other light on the same elements."""
    for mark in scene.objects:
        if MARK in mark and CORNERS in mark and max(mark[CORNERS]) < len(lux):
            mark[MARK] = lux_text(float(np.dot(mark[WEIGHTS], lux[list(mark[CORNERS])])))


def _set_colours(mesh: bpy.types.Mesh, name: str, colours: np.ndarray) -> None:
    rgba = np.ones((len(colours), 4), np.float32)
    rgba[:, :3] = colours
    mesh.color_attributes[name].data.foreach_set("color", rgba.ravel())


def look(context: bpy.types.Context) -> None:
    """Sets the 3D views to solid objects in the colours at their vertices, without shading."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                shading = area.spaces.active.shading
                shading.type = "SOLID"
                shading.light = "FLAT"
                shading.color_type = "VERTEX"
                shading.show_backface_culling = True


CLASSES = ()
