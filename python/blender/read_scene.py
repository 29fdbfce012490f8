"""Reads the visible scene of Blender, with modifiers applied and instances in their places."""

from typing import Dict, List, Optional, Set, Tuple

import bpy
import numpy as np
from mathutils import Matrix

from .logic.cameras import metres_per_unit
from .logic.materials import depends_on_closure
from .logic.meshes import Polygons, is_closed, part_of, turned_over
from .logic.scene_folder import Scene, Surface, counted
from .read_lights import read_camera, read_light, read_world
from .read_materials import Pictures, read_material

WITH_FACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
AS_INSTANCES = WITH_FACES - {"MESH"}
"""Kinds whose faces come as instances of the kind MESH, besides the object itself."""
RAYS = {
    "visible_diffuse": "diffuse rays",
    "visible_glossy": "glossy rays",
    "visible_transmission": "rays through glass",
    "visible_shadow": "shadow rays",
}
"""Switches of an object's visibility to rays in Cycles, and the words for them. That of cameras changes no lux."""
WITHOUT_LIGHT = {"EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}

OWN = "lightwell_light"
"""Custom property of objects that show the light of a solve; they are no part of the scene."""


def read_scene(context: bpy.types.Context) -> Scene:
    """The scene of the context's view layer, in metres."""
    source = context.scene
    depsgraph = context.evaluated_depsgraph_get()
    reader = _Reader(source, depsgraph)
    for instance in depsgraph.object_instances:
        reader.take(instance)
    reader.say_left_out()
    scene = reader.scene
    scene.world = read_world(source.world, reader.pictures, scene.notes)
    scene.lumens_per_watt = source.lightwell.lumens_per_watt
    scene.cameras.sort(key=lambda camera: not (source.camera and camera.name == source.camera.name))
    return scene


class _Reader:
    def __init__(self, source: bpy.types.Scene, depsgraph: bpy.types.Depsgraph):
        self.source = source
        self.depsgraph = depsgraph
        self.scene = Scene(title=bpy.path.display_name_from_filepath(bpy.data.filepath) or source.name)
        self.pictures = Pictures(self.scene.files)
        self.left_out: Dict[str, List[str]] = {}
        self.ignored: Dict[str, List[str]] = {}
        self.seen: Set[str] = set()
        self.rendered = rendered_objects(depsgraph.view_layer.layer_collection)
        self.rendered_within: Dict[str, Set[str]] = {}
        settings = source.unit_settings
        self.metres = metres_per_unit(settings.system, settings.scale_length)
        if self.metres != 1.0:
            self.scene.notes.append(f"units: 1 unit of Blender is {self.metres:g} m here; watts stay watts")

    def take(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        found = instance.object
        parent = instance.parent if instance.is_instance else None
        if not instance.show_self or found.original.get(OWN) or (parent and parent.original.get(OWN)):
            return
        self.seen.add(found.name)
        if self._is_hidden(found.original, parent.original if parent else None):
            self._leave_out("objects hidden in renders", found.name)
            return
        self._say_ignored(found)
        if found.type == "LIGHT":
            self._take_light(instance)
        elif found.type == "CAMERA":
            self._take_camera(instance)
        elif found.type == "MESH":
            self._take_faces(instance)
        elif found.type not in WITHOUT_LIGHT | AS_INSTANCES:
            self._leave_out(f"objects of the kind {found.type.lower()}", found.name)

    def _say_ignored(self, found: bpy.types.Object) -> None:
        """Notes what Cycles does with some rays or some lights alone; light here is the same for all."""
        if found.type not in WITH_FACES | {"LIGHT"}:
            return
        hidden = [said for name, said in RAYS.items() if not getattr(found, name, True)]
        for said in hidden:
            self.ignored.setdefault(f"objects that {said} do not see; all light meets them here", []).append(found.name)
        linking = getattr(found, "light_linking", None)
        if linking and (linking.receiver_collection or linking.blocker_collection):
            self.ignored.setdefault("light linking; light reaches all objects here", []).append(found.name)

    def _is_hidden(self, found: bpy.types.Object, parent: Optional[bpy.types.Object]) -> bool:
        """True if renders hide the object, or what it is an instance of."""
        if found.hide_render or parent and parent.hide_render:
            return True
        if (parent or found).name_full not in self.rendered:
            return True
        library = parent.instance_collection if parent and parent.instance_type == "COLLECTION" else None
        if library is None:
            return False
        if library.name_full not in self.rendered_within:
            self.rendered_within[library.name_full] = rendered_in(library)
        return found.name_full not in self.rendered_within[library.name_full]

    def say_left_out(self) -> None:
        for found in self.source.objects:
            if not found.get(OWN) and found.name not in self.seen:
                if found.type in WITH_FACES or found.type == "LIGHT":
                    self._leave_out("objects hidden in the viewport", found.name)
        for said, names in self.left_out.items():
            self.scene.notes.append(counted(f"left out: {len(names)} {said}", names))
        for said, names in self.ignored.items():
            self.scene.notes.append(counted(f"approximated: {said}", names))

    def _leave_out(self, said: str, name: str) -> None:
        self.left_out.setdefault(said, []).append(name)

    def _take_light(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        found = instance.object
        scene = self.scene
        light = read_light(
            found.data, found.name, instance.matrix_world, self.metres, scene.files, scene.notes
        )
        if light is None:
            return
        scene.lights.append(light)
        scene.light_collections.append(_collection(found.original))

    def _take_camera(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        found = instance.object
        if found.data.type == "PANO":
            self._leave_out("panoramic cameras", found.name)
            return
        camera = read_camera(found.data, found.name, instance.matrix_world, self.metres, self.source.render)
        self.scene.cameras.append(camera)

    def _take_faces(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        found = instance.object
        mesh = found.to_mesh()
        try:
            if mesh is None or len(mesh.polygons) == 0:
                self._leave_out("objects without faces", found.name)
                return
            polygons = read_polygons(mesh, instance.matrix_world, self.metres)
            if not np.isfinite(polygons.points).all():
                self._leave_out("objects with coordinates that are not finite", found.name)
                return
            self._add_parts(found, mesh, polygons)
        finally:
            found.to_mesh_clear()

    def _add_parts(self, found: bpy.types.Object, mesh: bpy.types.Mesh, polygons: Polygons) -> None:
        of_polygon = np.zeros(len(polygons), np.int32)
        mesh.polygons.foreach_get("material_index", of_polygon)
        slots = [slot.material for slot in found.material_slots] or [None]
        of_polygon = np.clip(of_polygon, 0, len(slots) - 1)
        parts = np.unique(of_polygon)
        keys = {k: self._material(slots[k].original if slots[k] else None) for k in parts}
        needs_closure = any(depends_on_closure(self.scene.materials[key]) for key in keys.values())
        closed = needs_closure and is_closed(polygons)
        for k in parts:
            material = slots[k]
            name = found.name if len(parts) == 1 else f"{found.name}/{material.name if material else 'none'}"
            part = polygons if len(parts) == 1 else part_of(polygons, of_polygon == k)
            key = keys[k]
            shader = self.scene.materials[key]
            if not (shader.base_picture or shader.mask or shader.emission_picture):
                part.uv = None  # polygons that coordinates bend are cut into triangles
            self.scene.surfaces.append(Surface(name, key, part, _collection(found.original), closed))

    def _material(self, material: Optional[bpy.types.Material]) -> str:
        name = material.name_full if material else "no material"
        if name not in self.scene.materials:
            self.scene.materials[name] = read_material(material, self.pictures)
        return name


def rendered_objects(layer: bpy.types.LayerCollection) -> Set[str]:
    """Names of the objects to which a path of collections leads that are not excluded or hidden in renders."""
    if layer.collection.hide_render:
        return set()
    found = set() if layer.exclude else {one.name_full for one in layer.collection.objects}
    return found.union(*(rendered_objects(child) for child in layer.children))


def rendered_in(collection: bpy.types.Collection, depth: int = 8) -> Set[str]:
    """Names of the objects of a collection that its instances render, those of instances within it included."""
    if collection.hide_render or depth == 0:  # Blender follows instances no deeper, so loops end
        return set()
    found = {one.name_full for one in collection.objects}
    within = [
        one.instance_collection
        for one in collection.objects
        if one.instance_type == "COLLECTION" and one.instance_collection and not one.hide_render
    ]
    nested = (rendered_in(child, depth) for child in collection.children)
    return found.union(*nested, *(rendered_in(child, depth - 1) for child in within))


def _collection(found: bpy.types.Object) -> str:
    homes = found.users_collection
    return homes[0].name if homes else "Scene"


def read_polygons(mesh: bpy.types.Mesh, matrix: Matrix, metres: float) -> Polygons:
    """The polygons of a mesh in the world, in metres; behind a mirror their fronts stay outside."""
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    to_world = np.array(matrix, float)
    world = points.reshape(-1, 3).astype(float) @ to_world[:3, :3].T + to_world[:3, 3]
    first = np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)])
    polygons = Polygons(metres * world, corners.astype(np.int64), first, *_corner_values(mesh, to_world))
    return turned_over(polygons) if np.linalg.det(to_world[:3, :3]) < 0.0 else polygons


def _corner_values(
    mesh: bpy.types.Mesh, to_world: np.ndarray
) -> Tuple[Optional[np.ndarray], Optional[np.ndarray]]:
    """Coordinates of the pictures, and normals if some polygon is smooth."""
    uv = normals = None
    layer = mesh.uv_layers.active
    if layer:
        flat = np.empty(2 * len(mesh.loops), np.float32)
        layer.uv.foreach_get("vector", flat)
        uv = flat.reshape(-1, 2).astype(float)
    smooth = np.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("use_smooth", smooth)
    if smooth.any() and abs(np.linalg.det(to_world[:3, :3])) > 0.0:
        flat = np.empty(3 * len(mesh.loops), np.float32)
        mesh.corner_normals.foreach_get("vector", flat)
        turned = flat.reshape(-1, 3).astype(float) @ np.linalg.inv(to_world[:3, :3])
        length = np.linalg.norm(turned, axis=1, keepdims=True)
        normals = turned / np.maximum(length, 1e-30)
    return uv, normals
