"""Reads Blender's lights, cameras and world."""

import math
import os
import re
from typing import Dict, List, Optional, Tuple

import bpy
from mathutils import Matrix, Vector

from .logic.cameras import Camera
from .logic.lights import Light
from .logic.scene_folder import World
from .read_materials import Pictures, node_tree, output_of, source_of

PHOTOMETRY = "lightwell_ies"
"""Custom property of a light: a photometric file, .ies or .ldt, with Blender's // for the file's folder."""
FACTOR = "lightwell_factor"
"""Custom property of a light with a photometric file: a factor on its light, for dimming or maintenance."""


def read_light(
    data: bpy.types.Light, name: str, matrix: Matrix, metres: float, files: Dict[str, bytes], notes: List[str]
) -> Optional[Light]:
    """A light in its place; None, with a note, if it cannot give light."""
    if data.energy < 0.0:
        notes.append(f"left out: {name} has negative watts")
        return None
    if getattr(getattr(data, "cycles", None), "is_portal", False) and data.type == "AREA":
        notes.append(f"left out: {name} is a portal, which guides Cycles' rays and gives no light")
        return None
    axes = [Vector(matrix.col[k][:3]) for k in range(3)]
    details = _details(data, axes, metres)
    if data.type == "AREA" and min(details["size"]) == 0.0:
        notes.append(f"left out: {name} has a size or scale of 0")
        return None
    unit = [axis.normalized() for axis in axes]
    if unit[0].cross(unit[1]).dot(unit[2]) < 0.0:
        unit[0] = -unit[0]  # mirrored; Cycles' lights shine along -z of their object all the same
    photometry, factor = _photometry(data, name, files, notes)
    _say_left_out(data, name, axes, notes)
    return Light(
        name=name,
        kind=data.type,
        energy=float(data.energy),
        colour=tuple(a * b for a, b in zip(_colour(data), _node_colour(data, name, notes))),
        position=tuple(metres * c for c in matrix.translation),
        x_axis=tuple(unit[0]),
        y_axis=tuple(unit[1]),
        aim=tuple(-unit[2]),
        exposure=float(getattr(data, "exposure", 0.0)),
        normalized=bool(getattr(data, "normalize", True)),
        photometry=photometry,
        factor=factor,
        **details,
    )


def _details(data: bpy.types.Light, axes: List[Vector], metres: float) -> Dict[str, object]:
    if data.type == "AREA":
        across = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
        size = (metres * data.size * axes[0].length, metres * across * axes[1].length)
        return {"shape": data.shape, "size": size, "spread": math.degrees(data.spread)}
    if data.type == "SUN":
        return {"angle": math.degrees(data.angle)}
    details: Dict[str, object] = {"radius": metres * data.shadow_soft_size}
    if data.type == "SPOT":
        details.update(cone=math.degrees(data.spot_size), blend=float(data.spot_blend))
    return details


def _colour(data: bpy.types.Light) -> Tuple[float, float, float]:
    colour = [float(c) for c in data.color]
    if getattr(data, "use_temperature", False):
        colour = [c * float(t) for c, t in zip(colour, data.temperature_color)]
    return tuple(max(c, 0.0) for c in colour)


def _node_colour(data: bpy.types.Light, name: str, notes: List[str]) -> Tuple[float, float, float]:
    """Strength times colour of the light's emission node, by which Cycles multiplies; 1 without nodes."""
    if not (data.use_nodes and data.node_tree) or _photometry_path(data) or _ies_node(data):
        return (1.0, 1.0, 1.0)
    output = output_of(data.node_tree)
    node = source_of(output.inputs["Surface"]) if output else None
    if node is None:
        notes.append(f"left out: {name} has nodes and nothing at their output, so it gives no light")
        return (0.0, 0.0, 0.0)
    if node.type != "EMISSION":
        return (1.0, 1.0, 1.0)  # named in the notes
    linked = [socket.name for socket in node.inputs if socket.name in ("Color", "Strength") and socket.is_linked]
    if linked:
        notes.append(
            f"approximated: what is linked to {' and '.join(linked)} of the emission of {name} counts as 1"
        )
    strength = 1.0 if "Strength" in linked else float(node.inputs["Strength"].default_value)
    colour = (1.0,) * 3 if "Color" in linked else node.inputs["Color"].default_value[:3]
    return tuple(max(strength * float(c), 0.0) for c in colour)


def _say_left_out(data: bpy.types.Light, name: str, axes: List[Vector], notes: List[str]) -> None:
    lengths = [axis.length for axis in axes]
    if data.type == "SPOT" and max(lengths) - min(lengths) > 1e-3 * max(lengths):
        notes.append(f"approximated: {name} is scaled unevenly; its cone is round here, and an ellipse in Cycles")
    if not getattr(data, "use_shadow", True):
        notes.append(f"approximated: {name} casts shadows here")
    if data.type in ("POINT", "SPOT") and data.shadow_soft_size > 0.0:
        notes.append(f"approximated: {name} is a point, without its radius, so its shadows are sharp")
    if data.use_nodes and data.node_tree and not _ies_node(data):
        plain = {"EMISSION", "OUTPUT_LIGHT", "REROUTE"}
        kinds = {node.bl_label for node in data.node_tree.nodes if node.type not in plain}
        if kinds:
            notes.append(f"left out: nodes of the light {name} ({', '.join(sorted(kinds))})")


def _ies_node(data: bpy.types.Light) -> Optional[bpy.types.Node]:
    if not (data.use_nodes and data.node_tree):
        return None
    return next((node for node in data.node_tree.nodes if node.type == "TEX_IES"), None)


def _photometry_path(data: bpy.types.Light) -> str:
    return str(data.original.get(PHOTOMETRY, ""))  # evaluated copies may have earlier properties


def _factor(data: bpy.types.Light, name: str, notes: List[str]) -> float:
    given = data.original.get(FACTOR, 1.0)
    try:
        factor = float(given)
    except (TypeError, ValueError):
        factor = -1.0
    if math.isfinite(factor) and factor >= 0.0:
        return factor
    notes.append(f"approximated: {FACTOR} of {name} is no number from 0 on ({given}); 1 counts")
    return 1.0


def _photometry(
    data: bpy.types.Light, name: str, files: Dict[str, bytes], notes: List[str]
) -> Tuple[Optional[str], float]:
    """The photometric file that a light names, kept below the scene's folder, and the factor of its light."""
    factor = _factor(data, name, notes)
    node = _ies_node(data)
    path = _photometry_path(data) or (node.filepath if node and node.mode == "EXTERNAL" else "")
    if path:
        full = bpy.path.abspath(path, library=data.library)
        try:
            with open(full, "rb") as file:
                content, kept = file.read(), os.path.basename(full)
        except OSError as error:
            notes.append(
                f"missing: {name} names the photometric file {full} ({error.strerror}); "
                "the light counts by its watts"
            )
            return None, 1.0
    elif node and node.ies:
        content, kept = node.ies.as_string().encode("utf-8"), node.ies.name
    else:
        return None, 1.0
    ending = ".ldt" if kept.lower().endswith(".ldt") else ".ies"
    plain = re.sub(r"[^A-Za-z0-9_-]", "_", os.path.splitext(kept)[0])[:60]
    target = f"luminaires/{plain}{ending}"
    while files.get(target, content) != content:
        plain += "_"
        target = f"luminaires/{plain}{ending}"
    files[target] = content
    return target, factor


def read_camera(
    camera: bpy.types.Camera, name: str, matrix: Matrix, metres: float, render: bpy.types.RenderSettings
) -> Camera:
    """A camera in its place, with the size of the scene's pictures."""
    share = render.resolution_percentage / 100.0
    depth = camera.dof
    focus = depth.focus_distance
    if depth.focus_object:
        # Along the view, whatever the camera's scale.
        way = depth.focus_object.matrix_world.translation - matrix.translation
        focus = abs(way.dot(Vector(matrix.col[2][:3]).normalized()))
    return Camera(
        name=name,
        position=tuple(metres * c for c in matrix.translation),
        direction=tuple(-Vector(matrix.col[2][:3]).normalized()),
        up=tuple(Vector(matrix.col[1][:3]).normalized()),
        is_orthographic=camera.type == "ORTHO",
        lens=camera.lens,
        sensor=(camera.sensor_width, camera.sensor_height),
        fit=camera.sensor_fit,
        shift=(camera.shift_x, camera.shift_y),
        view=metres * camera.ortho_scale,
        pixels=(max(1, int(render.resolution_x * share)), max(1, int(render.resolution_y * share))),
        pixel_aspect=render.pixel_aspect_x / render.pixel_aspect_y,
        near=metres * camera.clip_start,
        far=metres * camera.clip_end,
        f_number=depth.aperture_fstop if depth.use_dof else None,
        focus=metres * focus,
    )


def read_world(world: Optional[bpy.types.World], pictures: Pictures, notes: List[str]) -> World:
    """The world's background: an even colour, or a picture in longitude and latitude."""
    if world is None:
        return World()
    tree = node_tree(world)
    if tree is None:
        return World(radiance=tuple(world.color[:3]))
    node = next((n for n in tree.nodes if n.type == "BACKGROUND"), None)
    output = next((n for n in tree.nodes if n.type == "OUTPUT_WORLD"), None)
    if node is None or output is None or not output.inputs["Surface"].is_linked:
        return World()
    if node.inputs["Strength"].is_linked:
        notes.append("approximated: what is linked to the world's strength; the socket's own number counts")
    if output_of(tree) and source_of(output_of(tree).inputs["Surface"]) != node:
        notes.append("approximated: the world's nodes between its first background and the output are left out")
    strength = float(node.inputs["Strength"].default_value)
    link = node.inputs["Color"]
    if not link.is_linked:
        return World(radiance=tuple(strength * float(c) for c in link.default_value[:3]))
    source = link.links[0].from_node
    if source.type != "TEX_ENVIRONMENT" or source.image is None:
        notes.append(f"left out: the world's node '{source.bl_label}'; use a colour or an environment picture")
        return World()
    file = pictures.file_of(source.image, is_light=True)
    if file is None or not file.endswith((".exr", ".hdr")) or source.projection != "EQUIRECTANGULAR":
        notes.append(
            f"left out: the world's picture {source.image.name}; an OpenEXR or HDR picture in longitude and "
            "latitude is needed"
        )
        return World()
    return World(radiance=(strength,) * 3, map=file, turn=_turn_of(source, notes))


def _turn_of(source: bpy.types.Node, notes: List[str]) -> float:
    vector = source.inputs["Vector"]
    if not vector.is_linked or vector.links[0].from_node.type != "MAPPING":
        return 0.0
    mapping = vector.links[0].from_node.inputs
    if "Location" in mapping and any(abs(c) > 1e-6 for c in mapping["Location"].default_value):
        notes.append("left out: the place of the world's picture in its mapping")
    if any(abs(c - 1.0) > 1e-6 for c in mapping["Scale"].default_value):
        notes.append("left out: the scale of the world's picture in its mapping")
    turn = mapping["Rotation"].default_value
    if abs(turn[0]) > 1e-6 or abs(turn[1]) > 1e-6:
        notes.append("left out: turns of the world's picture about x and y")
    return math.degrees(turn[2])
