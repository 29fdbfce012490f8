"""A folder with a scene file that the command line reads: scene.toml, meshes, pictures, luminaires."""

import hashlib
import os
import re
import shutil
import tempfile
from dataclasses import dataclass, field, replace
from typing import Dict, List, Optional, Set, Tuple

import numpy as np

from .cameras import Camera, camera_table
from .lights import Light, is_surface, lamp_table, luminous, outline, shines, spoken, watts
from .materials import Shader, depends_on_closure, emits, material_table
from .meshes import Polygons, lies_in_plane, ply_bytes
from .toml_text import channel_name, plain_names, quoted, table_text

SCENE_FILE = "scene.toml"
SOLUTION_FILE = "solution.vtp"
FIRST_LINE = "# Written by the Lightwell add-on for Blender, which replaces this file with each export."
DIGEST = "# Scene "
PARTS = ("meshes", "pictures", "luminaires")
MOST_CHANNELS = 256
WIDEST_SUN = 10.0  # degrees; the most that scene files allow
CLEARANCE = 0.001  # metres between an area light and a face in whose plane it lay


class SceneError(Exception):
    """A scene that cannot be exported; the message is a sentence with the remedy."""


@dataclass
class Surface:
    """Polygons of one object and one material."""

    name: str
    material: str
    mesh: Polygons
    collection: str = ""
    closed: bool = False
    """The object, all its materials together, is a body with its fronts outside."""


@dataclass
class World:
    """Light around the scene."""

    radiance: Tuple[float, float, float] = (0.0, 0.0, 0.0)
    """W/(m^2 sr) in all directions; the factor of a map."""
    map: Optional[str] = None
    """A picture in longitude and latitude, below the scene's folder."""
    turn: float = 0.0
    """Degrees about z by which Blender turns directions before they look the map up."""


@dataclass
class Scene:
    """All that is exported, in metres, with z upwards."""

    title: str = ""
    surfaces: List[Surface] = field(default_factory=list)
    materials: Dict[str, Shader] = field(default_factory=dict)
    lights: List[Light] = field(default_factory=list)
    light_collections: List[str] = field(default_factory=list)
    cameras: List[Camera] = field(default_factory=list)
    world: World = field(default_factory=World)
    lumens_per_watt: float = 683.0
    files: Dict[str, bytes] = field(default_factory=dict)
    """Pictures and photometric files, by their path below the folder."""
    notes: List[str] = field(default_factory=list)
    emitters: Dict[str, str] = field(default_factory=dict)
    """Set by `scene_text`: the collection of each emitter, by its name in the file."""


def write_scene(scene: Scene, folder: str) -> str:
    """Writes the scene and returns the path of its file. The folder's other files stay.

    Raises SceneError if there is nothing to solve, or if files of somebody else would be replaced.
    """
    scratch = stage_scene(scene, folder)
    try:
        put_in_place(scratch, folder)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return os.path.join(folder, SCENE_FILE)


def stage_scene(scene: Scene, folder: str) -> str:
    """Writes the scene into a folder of its own within `folder`, and returns its path, for `put_in_place`.

    Raises SceneError as `write_scene` does.
    """
    check_scene(scene)
    files = dict(scene.files)
    text = scene_text(scene, files)
    named = files_of(text)
    _check_replaced(folder, [*named, SOLUTION_FILE])
    os.makedirs(folder, exist_ok=True)
    scratch = tempfile.mkdtemp(prefix=".export-", dir=folder)
    whole = {name: files[name] for name in named}
    whole[SCENE_FILE] = text.replace("\n", f"\n{DIGEST}{_digest(text, whole)}\n", 1).encode("utf-8")
    try:
        for name, data in whole.items():
            target = os.path.join(scratch, name)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            with open(target, "wb") as file:
                file.write(data)
    except BaseException:
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    return scratch


def put_in_place(scratch: str, folder: str) -> None:
    """Moves a staged scene, and its solution if there is one, into the folder, in place of an earlier one.

    Raises SceneError if files of somebody else would be replaced.
    """
    with open(os.path.join(scratch, SCENE_FILE), encoding="utf-8") as file:
        named = files_of(file.read())
    moved = [SOLUTION_FILE] if os.path.exists(os.path.join(scratch, SOLUTION_FILE)) else []
    own = _check_replaced(folder, [*named, *moved])
    for name in own - set(named):
        if os.path.isfile(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))
    for name in [*named, *moved, SCENE_FILE]:
        target = os.path.join(folder, name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.replace(os.path.join(scratch, name), target)
    for part in PARTS:
        if os.path.isdir(os.path.join(folder, part)) and not os.listdir(os.path.join(folder, part)):
            os.rmdir(os.path.join(folder, part))


def files_of(text: str) -> List[str]:
    """Files below the folder that the text of a scene file names, each once."""
    return list(dict.fromkeys(re.findall(rf'\b(?:file|mesh) = "((?:{"|".join(PARTS)})/[^"\\]+)"', text)))


def digest_of(folder: str) -> str:
    """Identifies the folder's exported scene with all its files; empty if there is none."""
    try:
        with open(os.path.join(folder, SCENE_FILE), encoding="utf-8", errors="replace") as file:
            lines = [file.readline().rstrip("\n") for _ in range(2)]
    except OSError:
        return ""
    is_ours = lines[0] == FIRST_LINE and lines[1].startswith(DIGEST)
    return lines[1][len(DIGEST) :] if is_ours else ""


def _digest(text: str, files: Dict[str, bytes]) -> str:
    found = hashlib.sha256(text.encode("utf-8"))
    for data in files.values():
        found.update(data)
    return found.hexdigest()[:32]


def _check_replaced(folder: str, names: List[str]) -> Set[str]:
    """Files of the folder's earlier export. Raises SceneError if one of `names` is there and not among them."""
    path = os.path.join(folder, SCENE_FILE)
    own: Set[str] = set()
    if os.path.exists(path):
        with open(path, encoding="utf-8", errors="replace") as file:
            text = file.read()
        if text.split("\n", 1)[0] != FIRST_LINE:
            raise SceneError(
                f"{path} was not written by this add-on and would be lost; choose another folder"
            )
        own = {*files_of(text), SOLUTION_FILE}
    for name in names:
        if name not in own and os.path.lexists(os.path.join(folder, name)):
            raise SceneError(
                f"{os.path.join(folder, name)} was not written by this add-on and would be lost; move it "
                "elsewhere, or choose another folder"
            )
    return own - {SOLUTION_FILE}


def check_scene(scene: Scene) -> None:
    """Raises SceneError for a scene without faces or without light."""
    if not any(len(surface.mesh) for surface in scene.surfaces):
        raise SceneError(
            "no visible object has faces; show or make an object with faces, and mind objects that are "
            "hidden in the viewport or in renders"
        )
    shining = any(emits(scene.materials[surface.material]) for surface in scene.surfaces)
    lit = any(shines(light) for light in scene.lights)
    if not (shining or lit or scene.world.map or luminous(scene.world.radiance) > 0.0):
        raise SceneError(
            "nothing shines in the scene; add a light, a material with emission, or a world background"
        )


def scene_text(scene: Scene, files: Dict[str, bytes]) -> str:
    """The text of the scene file; adds its meshes and photometric files to `files`, what was
    approximated to the scene's notes, and fills in `emitters`."""
    dark = [light.name for light in scene.lights if not shines(light)]
    if dark:
        scene.notes.append(counted(f"left out: {len(dark)} lights that give no light", dark))
    lights = [light for light in scene.lights if light.kind != "SUN" and shines(light)]
    names = plain_names([s.name for s in scene.surfaces] + [light.name for light in lights])
    parts = [FIRST_LINE + "\n", f"title = {quoted(scene.title)}\n" + 'unit = "m"\n']
    parts.append(table_text("[bands]", {"kind": "rgb", "lumens_per_watt": scene.lumens_per_watt}))
    parts += _surfaces(scene, names, files)
    parts += _lights(scene, lights, names, files)
    parts += _sky(scene)
    cameras = plain_names([camera.name for camera in scene.cameras])
    for i, camera in enumerate(scene.cameras):
        parts.append(table_text("[[cameras]]", {**camera_table(camera), "name": cameras[i]}))
    return "\n".join(parts)


def _surfaces(scene: Scene, names: Dict[int, str], files: Dict[str, bytes]) -> List[str]:
    variants: Dict[Tuple[str, bool], str] = {}
    order: List[Tuple[str, bool]] = []
    parts: List[str] = []
    for i, surface in enumerate(scene.surfaces):
        shader = scene.materials[surface.material]
        key = (surface.material, surface.closed and depends_on_closure(shader))
        if key not in variants:
            variants[key] = ""
            order.append(key)
        if emits(shader):
            scene.emitters[names[i]] = surface.collection
    # Patterns of channels match names of materials as well, so no material is called as an emitter.
    plain = plain_names(
        list(names.values()) + [f"{name} (body)" if closed else name for name, closed in order]
    )
    for k, key in enumerate(order):
        variants[key] = plain[len(names) + k]
    remarks: Dict[str, List[str]] = {}
    for name, closed in order:
        table, said = material_table(scene.materials[name], closed)
        parts.append(table_text(f"[materials.{quoted(variants[name, closed])}]", table))
        for remark in said:
            remarks.setdefault(remark, []).append(name)
    scene.notes += [counted(f"left out or approximated: {remark}", who) for remark, who in remarks.items()]
    for i, surface in enumerate(scene.surfaces):
        shader = scene.materials[surface.material]
        key = (surface.material, surface.closed and depends_on_closure(shader))
        file = f"meshes/{i + 1:05d}.ply"
        files[file] = ply_bytes(surface.mesh)
        table = {"name": names[i], "material": variants[key], "mesh": file}
        parts.append(table_text("[[surfaces]]", table))
    return parts


def _lights(
    scene: Scene, lights: List[Light], names: Dict[int, str], files: Dict[str, bytes]
) -> List[str]:
    parts = []
    for k, light in enumerate(lights):
        name = names[len(scene.surfaces) + k]
        scene.emitters[name] = scene.light_collections[scene.lights.index(light)]
        scene.notes.append(spoken(light, scene.lumens_per_watt))
        if is_surface(light):
            light = _freed(light, scene)
            material = f"light of {name}"
            power = {"power": [float(p) for p in watts(light)], "reflectance": 0.0, "sides": "one"}
            parts.append(table_text(f"[materials.{quoted(material)}]", power))
            corners = [list(corner) for corner in outline(light)]
            table = {"name": name, "material": material, "polygon": corners}
            parts.append(table_text("[[surfaces]]", table))
            continue
        table, text = lamp_table(light, scene.lumens_per_watt)
        table["name"] = name
        if text is not None:
            file = f"luminaires/light-{k + 1:04d}.ies"
            files[file] = text.encode("ascii", "replace")
            table["file"] = file
        parts.append(table_text("[[lamps]]", table))
    return parts


def _freed(light: Light, scene: Scene) -> Light:
    """An area light that lies in the plane of a face, such as a ceiling, moved to where it shines."""
    corners = np.array(outline(light))
    low, high = corners.min(axis=0) - CLEARANCE, corners.max(axis=0) + CLEARANCE
    for surface in scene.surfaces:
        if lies_in_plane(surface.mesh, corners.mean(axis=0), np.array(light.aim), (low, high)):
            scene.notes.append(
                f"moved: {light.name} lies in a face of {surface.name}; it is {1000 * CLEARANCE:g} mm before it here"
            )
            place = tuple(p + CLEARANCE * a for p, a in zip(light.position, light.aim))
            return replace(light, position=place)
    return light


def _sky(scene: Scene) -> List[str]:
    suns = sorted(
        (light for light in scene.lights if light.kind == "SUN" and shines(light)),
        key=lambda sun: -luminous(watts(sun)),
    )
    high = [sun for sun in suns if sun.aim[2] < 0.0]
    low = [sun.name for sun in suns if sun.aim[2] >= 0.0]
    if low:
        scene.notes.append(counted("left out: suns that shine from below the horizon", low))
    if high[1:]:
        scene.notes.append(counted("left out: suns besides the brightest", [sun.name for sun in high[1:]]))
    world = scene.world
    sky: Dict[str, object] = {"kind": "none", "up": [0.0, 0.0, 1.0], "north": [0.0, 1.0, 0.0]}
    if world.map:
        # The middle of Blender's map is towards +x, which is 90 degrees clockwise of north.
        sky.update(kind="map", file=world.map, rotation=90.0 + world.turn, scale=float(max(world.radiance)))
        scene.notes.append(f"world: the picture {os.path.basename(world.map)}, also below the horizon")
    elif luminous(world.radiance) > 0.0:
        radiance = [float(c) for c in world.radiance]
        sky.update(kind="uniform", radiance=radiance, ground_radiance=radiance)
        lux = 3.141592653589793 * scene.lumens_per_watt * luminous(radiance)
        scene.notes.append(f"world: an even sky, {lux:.4g} lx on open ground")
    elif not high:
        return []
    parts = [table_text("[sky]", sky)]
    for sun in high[:1]:
        scene.notes.append(spoken(sun, scene.lumens_per_watt))
        if sun.angle > WIDEST_SUN:
            scene.notes.append(
                f"approximated: {sun.name} has a disc of {WIDEST_SUN:g} degrees instead of {sun.angle:.4g}, with the "
                "same irradiance"
            )
        table = {
            "direction": [-c for c in sun.aim],
            "irradiance": [float(p) for p in watts(sun)],
            "angle": min(max(float(sun.angle), 0.01), WIDEST_SUN),
        }
        parts.append(table_text("[sky.sun]", table))
    for kind, present in (("sky", sky["kind"] != "none"), ("sun", bool(high))):
        if present:
            scene.emitters[kind] = kind
    return parts


def channel_arguments(emitters: Dict[str, str], group: str) -> List[str]:
    """Arguments of `lightwell solve` that keep light apart.

    emitters: the collection of each emitter, by its name.
    group: "LIGHT" (a channel for each emitter), "COLLECTION" or "NONE".

    Raises SceneError if there would be too many channels.
    """
    if group == "NONE":
        return ["--channels", "off"]
    channels = {name: channel_name(name if group == "LIGHT" else home) for name, home in emitters.items()}
    if len(set(channels.values())) > MOST_CHANNELS:
        raise SceneError(
            f"there are {len(set(channels.values()))} lights and at most {MOST_CHANNELS} channels; choose "
            "channels by collection"
        )
    arguments = []
    for name, channel in channels.items():
        arguments += ["--channels", f"{channel}={name}"]
    return arguments


def counted(said: str, names: List[str]) -> str:
    """A sentence about names: up to three of them, and how many more there are."""
    unique = list(dict.fromkeys(names))
    more = f" and {len(unique) - 3} more" if len(unique) > 3 else ""
    return f"{said} ({', '.join(unique[:3])}{more})"
