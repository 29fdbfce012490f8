"""Lightmaps: the program bakes the solution, and Blender imports the model with its textures."""

import os
from typing import List, Optional

import bmesh
import bpy
import numpy as np

from . import properties, show, solve
from .logic.program import Job, ProgramError
from .logic.scene_folder import SCENE_FILE, SOLUTION_FILE
from .logic.solution import DARK
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
    path = os.path.join(solve.folder_of(scene), MODEL)
    home = show.collection_of(scene, NAME)
    for old in list(home.objects):
        bpy.data.objects.remove(old)
    before = set(bpy.data.objects)
    try:
        bpy.ops.import_scene.gltf(filepath=path)
    except (RuntimeError, AttributeError) as error:
        scene.lightwell.message = f"{path} was written, but Blender's glTF import failed ({error})"[:400]
        return
    imported = set(bpy.data.objects) - before
    drop_dark([found.data for found in imported if found.type == "MESH"])
    for found in imported:
        for other in list(found.users_collection):
            other.objects.unlink(found)
        if found.type not in ("MESH", "EMPTY"):
            bpy.data.objects.remove(found)
            continue
        home.objects.link(found)
        found[OWN] = NAME
        found.hide_render = True
        if found.parent is None and show.metres_of(scene) != 1.0:
            found.scale = [c / show.metres_of(scene) for c in found.scale]
            found.location = found.location / show.metres_of(scene)
    scene.lightwell.message = f"{path}: lightmaps in the collection '{NAME}', and as .exr files beside it"[:400]


def drop_dark(meshes: List[bpy.types.Mesh]) -> None:
    """Removes faces without light, such as the outsides of walls, so that one can look into rooms."""
    meshes = [mesh for mesh in meshes if LUX in mesh.attributes]
    lux = []
    for mesh in meshes:
        values = np.empty(len(mesh.vertices), np.float32)
        mesh.attributes[LUX].data.foreach_get("value", values)
        lux.append(values)
    every = np.concatenate(lux) if lux else np.zeros(0)
    lit = every[every > 0.0]
    limit = DARK * float(lit.mean()) if len(lit) else 0.0
    for mesh, values in zip(meshes, lux):
        edited = bmesh.new()
        edited.from_mesh(mesh)
        dark = [face for face in edited.faces if max(values[v.index] for v in face.verts) < limit]
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
        folder = os.path.dirname(bpy.path.abspath(settings.solution))
        try:
            program = properties.program(context)
            relight = relight_arguments(program, settings, folder)
            bake = bake_arguments(program, folder, RELIT if relight else SOLUTION_FILE, self.size)
            if relight is None:
                solve.start(context, Job(bake, folder), take_model)
            else:
                solve.start(context, Job(relight, folder), lambda scene, run, code: _bake(bake, folder))
        except ProgramError as error:
            settings.message = str(error)[:400]
            self.report({"ERROR"}, f"Lightwell: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


def _bake(arguments: List[str], folder: str) -> None:
    solve.start(bpy.context, Job(arguments, folder), take_model)


CLASSES = (LIGHTWELL_OT_lightmaps,)
