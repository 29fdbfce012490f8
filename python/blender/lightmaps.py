"""Lightmaps: the program bakes the solution, and Blender imports the model with its textures."""

import os
from typing import List, Optional

import bmesh
import bpy
import numpy as np

from . import properties, show, solve
from .logic.program import Job, ProgramError
from .logic.scene_folder import SCENE_FILE, SOLUTION_FILE, SceneError, digest_of
from .logic.solution import dark_limit
from .read_scene import OWN

NAME = "Lightwell lightmaps"
LUX = "_ILLUMINANCE"  # of the vertices of the model
MODEL, RELIT = "lightmaps.glb", "relit.vtp"


def relight_arguments(program: str, settings, folder: str) -> Optional[List[str]]:
    """The command that dims the channels as the panel does; None if all are as solved."""
    dimmed = [channel for channel in settings.channels if channel.level != 1.0]
    if not dimmed:
        return None
    arguments = [program, "relight", os.path.join(folder, SOLUTION_FILE), "-o", os.path.join(folder, RELIT)]
    for channel in dimmed:
        arguments += ["--channel", f"{channel.name}={channel.level:.6g}"]
    return arguments


def bake_arguments(program: str, folder: str, solution: str, size: int) -> List[str]:
    """The command that bakes a solution into textures."""
    return [
        program,
        "export",
        os.path.join(folder, solution),
        "--scene",
        os.path.join(folder, SCENE_FILE),
        "-o",
        os.path.join(folder, MODEL),
        "--lightmap",
        "--lightmap-size",
        str(size),
    ]


def take_model(scene: bpy.types.Scene, run: solve.Run, code: int) -> None:
    """Imports the baked model into a collection of its own, hidden in renders of the scene."""
    path = os.path.join(run.folder, MODEL)
    home = show.collection_of(scene, NAME)
    remove_models(home)
    before = set(bpy.data.objects)
    try:
        _import(scene, path)
    except (RuntimeError, AttributeError) as error:
        scene.lightwell.message = f"{path} was written, but Blender's glTF import failed ({error})"[:400]
        return
    imported = set(bpy.data.objects) - before
    drop_dark([found.data for found in imported if found.type == "MESH"])
    metres = show.metres_of(scene)
    for found in imported:
        for other in list(found.users_collection):
            other.objects.unlink(found)
        if found.type not in ("MESH", "EMPTY"):
            bpy.data.objects.remove(found)
            continue
        home.objects.link(found)
        found[OWN] = NAME
        found.hide_render = True
        if found.parent is None and metres != 1.0:
            found.scale = [c / metres for c in found.scale]
            found.location = found.location / metres
    scene.lightwell.message = f"{path}: lightmaps in the collection '{NAME}', and as .exr files beside it"[:400]
    properties.undo_step("Lightwell Lightmaps")


def _import(scene: bpy.types.Scene, path: str) -> None:
    """Imports a model into the scene, from a timer too, where no window is the active one."""
    windows = bpy.context.window_manager.windows
    window = next((w for w in windows if w.scene == scene), windows[0] if len(windows) else None)
    if window is None:
        bpy.ops.import_scene.gltf(filepath=path)
        return
    # The importer's own operators take the scene of the window.
    shown, window.scene = window.scene, scene
    try:
        with bpy.context.temp_override(window=window):
            bpy.ops.import_scene.gltf(filepath=path)
    finally:
        window.scene = shown


def remove_models(home: bpy.types.Collection) -> None:
    """Removes the models of earlier runs with their meshes, materials and pictures; other objects stay."""
    own = [found for found in home.objects if found.get(OWN) == NAME]
    meshes = {found.data for found in own if found.type == "MESH"}
    materials = {slot for mesh in meshes for slot in mesh.materials if slot}
    nodes = [node for material in materials if material.node_tree for node in material.node_tree.nodes]
    images = {node.image for node in nodes if node.type == "TEX_IMAGE" and node.image}
    for found in own:
        bpy.data.objects.remove(found)
    for room, unused in ((bpy.data.meshes, meshes), (bpy.data.materials, materials), (bpy.data.images, images)):
        for item in unused:
            if item.users == 0:
                room.remove(item)


def drop_dark(meshes: List[bpy.types.Mesh]) -> None:
    """Removes faces without light, such as the outsides of walls, so that one can look into rooms."""
    meshes = [mesh for mesh in meshes if LUX in mesh.attributes and len(mesh.polygons)]
    lux, areas = [], []
    for mesh in meshes:
        values = np.empty(len(mesh.vertices), np.float32)
        mesh.attributes[LUX].data.foreach_get("value", values)
        lux.append(np.array([max(values[v] for v in face.vertices) for face in mesh.polygons]))
        areas.append(np.array([face.area for face in mesh.polygons]))
    limit = dark_limit(np.concatenate(lux), np.concatenate(areas)) if lux else 0.0
    for mesh, values in zip(meshes, lux):
        edited = bmesh.new()
        edited.from_mesh(mesh)
        dark = [face for face, value in zip(edited.faces, values) if value <= limit]
        bmesh.ops.delete(edited, geom=dark, context="FACES")
        edited.to_mesh(mesh)
        edited.free()


class LIGHTWELL_OT_lightmaps(bpy.types.Operator):
    """Bake the light, as it is dimmed, into textures and import the model that they lie on"""

    bl_idname = "lightwell.lightmaps"
    bl_label = "Bake Lightmaps"

    size: bpy.props.IntProperty(name="Texels", description="Along an edge", default=2048, min=64, max=8192)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return solve.Run.current is None and bool(context.scene.lightwell.solution)

    def execute(self, context: bpy.types.Context):
        settings = context.scene.lightwell
        folder = os.path.dirname(show.path_of(settings))
        try:
            if not settings.solved or digest_of(folder) != settings.solved:
                raise SceneError(f"the scene in {folder} is not the one that was solved; solve again")
            program = properties.program(context)
            relight = relight_arguments(program, settings, folder)
            bake = bake_arguments(program, folder, RELIT if relight else SOLUTION_FILE, self.size)
            if relight is None:
                _bake(context.scene, bake, folder)
            else:
                job = Job(relight, folder)
                solve.start(solve.Run(job, context.scene, folder, lambda scene, *_: _bake(scene, bake, folder)))
        except (SceneError, ProgramError) as error:
            settings.message = str(error)[:400]
            self.report({"ERROR"}, f"Lightwell: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


def _bake(scene: bpy.types.Scene, arguments: List[str], folder: str) -> None:
    solve.start(solve.Run(Job(arguments, folder), scene, folder, take_model))


CLASSES = (LIGHTWELL_OT_lightmaps,)
