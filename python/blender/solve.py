"""Export and solve: operators that run the program beside Blender and take its light back.

A timer looks at the program, not a modal operator, which would hold up Blender's autosave.
"""

import os
import re
import shutil
import time
from typing import List, Optional

import bpy

from . import overlay, properties, show
from .logic.program import Job, ProgramError
from .logic.scene_folder import (
    SCENE_FILE,
    SOLUTION_FILE,
    SceneError,
    channel_arguments,
    digest_of,
    put_in_place,
    stage_scene,
    write_scene,
)
from .logic.solution import SolutionError, read_solution
from .read_scene import read_scene

NOTES = "Lightwell notes"
INTERVAL = 0.2  # seconds between two looks at the program


class Run:
    """The run that is under way: the job, the scene that it belongs to, and what to do at its end.

    Folders are those of the run's begin: meanwhile the file may be saved under another name.
    """

    current: Optional["Run"] = None

    def __init__(self, job: Job, scene: bpy.types.Scene, folder: str, finish, scratch: str = ""):
        self.job = job
        self.scene_uid = scene.session_uid  # scenes may be renamed
        self.folder = folder
        self.finish = finish
        self.scratch = scratch
        """A folder that goes when the run ends."""
        self.begin = time.monotonic()

    def scene(self) -> Optional[bpy.types.Scene]:
        """The scene of the run; None if it was removed."""
        return next((scene for scene in bpy.data.scenes if scene.session_uid == self.scene_uid), None)

    def clean(self) -> None:
        """Removes what the run leaves besides its result."""
        if self.scratch:
            shutil.rmtree(self.scratch, ignore_errors=True)

    def words(self) -> str:
        seconds = time.monotonic() - self.begin
        return f"{self.job.phase}, {seconds:.0f} s"


def folder_of(scene: bpy.types.Scene) -> str:
    """The folder of the scene's files: the one given, or one beside the .blend file, or a temporary one."""
    given = scene.lightwell.folder
    if given and (bpy.data.filepath or not given.startswith("//")):
        return os.path.normpath(bpy.path.abspath(given))
    plain = re.sub(r"[^\w-]", "_", scene.name)
    if bpy.data.filepath:
        stem = os.path.splitext(bpy.data.filepath)[0]
        return f"{stem}-lightwell" if len(bpy.data.scenes) == 1 else f"{stem}-lightwell-{plain}"
    return os.path.join(bpy.app.tempdir, f"lightwell-{plain}")


def export(context: bpy.types.Context, write=write_scene):
    """Writes the scene; returns it, its folder, and what `write` returns of it. Raises SceneError."""
    scene = read_scene(context)
    folder = folder_of(context.scene)
    if not bpy.data.filepath:
        scene.notes.append(
            "the .blend file is not saved: the scene and its light lie in a temporary folder and go when "
            "Blender ends"
        )
    try:
        written = write(scene, folder)
    except OSError as error:
        raise SceneError(f"{folder} cannot be written ({error.strerror}); choose another folder") from error
    write_notes(scene.notes)
    return scene, folder, written


def write_notes(notes: List[str], append: bool = False) -> None:
    """Puts the notes into a text of the file."""
    text = bpy.data.texts.get(NOTES) or bpy.data.texts.new(NOTES)
    if not append:
        text.clear()
    for note in notes:
        text.write(note + "\n")


def solve_arguments(program: str, settings, folder: str, emitters) -> List[str]:
    """The command that solves the exported scene."""
    arguments = [program, "solve", os.path.join(folder, SCENE_FILE), "-o", os.path.join(folder, SOLUTION_FILE)]
    if settings.effort == "ACCURACY":
        arguments += ["--accuracy", f"{settings.accuracy:.6g}%"]
    if settings.effort == "TIME":
        arguments += ["--time", f"{settings.seconds}s"]
    return arguments + channel_arguments(emitters, settings.group)


def start(run: Run) -> None:
    """Lets a timer watch the run's job; in background mode waits for its end."""
    Run.current = run
    if bpy.app.background:
        run.job.wait()
        _look()
    elif not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=INTERVAL)


def _look() -> Optional[float]:
    """Of the timer: notes progress and finishes a run that is over."""
    run = Run.current
    if run is None:
        return None
    code = run.job.poll()
    _redraw()
    if code is None:
        return INTERVAL
    Run.current = None
    try:
        _end(run, code)
    finally:
        run.clean()
    _redraw()
    return INTERVAL if Run.current else None  # a run may begin another one


def _end(run: Run, code: int) -> None:
    scene = run.scene()
    if scene is None:
        write_notes(["the light was not taken: its scene was removed during the solve"], append=True)
        return
    if run.scratch:  # the folder goes, and its name says nothing
        run.job.notes = [note.replace(run.scratch + os.sep, "") for note in run.job.notes]
    failure = run.job.failure(code)
    scene.lightwell.message = failure[:400]
    if failure:
        print(f"Lightwell: {failure}")
    else:
        try:
            run.finish(scene, run, code)
        except (SceneError, ProgramError, OSError) as error:
            scene.lightwell.message = str(error)[:400]
            print(f"Lightwell: {error}")
    write_notes(run.job.notes, append=True)


def _redraw() -> None:
    for window in bpy.context.window_manager.windows if bpy.context.window_manager else []:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def take_light(scene: bpy.types.Scene, run: Run, code: int) -> None:
    """Shows the light of a finished solve."""
    path = os.path.join(run.folder, SOLUTION_FILE)
    try:
        solution = read_solution(os.path.join(run.scratch, SOLUTION_FILE))
    except SolutionError as error:
        scene.lightwell.message = str(error)[:400]
        return
    put_in_place(run.scratch, run.folder)
    scene.lightwell.solved = digest_of(run.folder)
    show.show(scene, path, solution)
    overlay.refresh_readings(scene)
    seconds = time.monotonic() - run.begin
    said = f"{len(solution.first) - 1} elements in {seconds:.1f} s"
    if solution.error > 0.0:
        said += f", estimated error {100 * solution.error:.2g} %"
    if code == 4 and scene.lightwell.effort == "ACCURACY":
        said += "; short of the accuracy that was asked for"
    scene.lightwell.message = said
    properties.undo_step("Lightwell Solve")


class LIGHTWELL_OT_export(bpy.types.Operator):
    """Write the scene as a folder that the command line reads"""

    bl_idname = "lightwell.export"
    bl_label = "Export Scene"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return Run.current is None

    def execute(self, context: bpy.types.Context):
        try:
            scene, folder, _ = export(context)
        except SceneError as error:
            self.report({"ERROR"}, f"Lightwell: {error}")
            return {"CANCELLED"}
        context.scene.lightwell.message = f"{folder}: {len(scene.surfaces)} surfaces, {len(scene.lights)} lights"
        self.report({"INFO"}, f"Lightwell: {context.scene.lightwell.message}")
        return {"FINISHED"}


class LIGHTWELL_OT_solve(bpy.types.Operator):
    """Solve the light of all surfaces; Blender stays responsive meanwhile"""

    bl_idname = "lightwell.solve"
    bl_label = "Solve"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return Run.current is None

    def execute(self, context: bpy.types.Context):
        settings = context.scene.lightwell
        try:
            begin_solve(context)
        except (SceneError, ProgramError) as error:
            settings.message = str(error)[:400]
            self.report({"ERROR"}, f"Lightwell: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


def begin_solve(context: bpy.types.Context) -> Run:
    """Exports the scene beside the earlier one, which it replaces together with its light, and solves it.

    Raises SceneError and ProgramError.
    """
    program = properties.program(context)
    scene, folder, scratch = export(context, stage_scene)
    try:
        arguments = solve_arguments(program, context.scene.lightwell, scratch, scene.emitters)
        run = Run(Job(arguments, scratch), context.scene, folder, take_light, scratch)
    except (SceneError, ProgramError):
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    start(run)
    return run


class LIGHTWELL_OT_cancel(bpy.types.Operator):
    """Stop the run; earlier light stays"""

    bl_idname = "lightwell.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return Run.current is not None

    def execute(self, context: bpy.types.Context):
        Run.current.job.cancel()
        return {"FINISHED"}


CLASSES = (LIGHTWELL_OT_export, LIGHTWELL_OT_solve, LIGHTWELL_OT_cancel)


@bpy.app.handlers.persistent
def _end_run(*_: object) -> None:
    if Run.current is not None:
        Run.current.job.kill()
        Run.current.clean()
        Run.current = None


def attach() -> None:
    bpy.app.handlers.load_pre.append(_end_run)


def detach() -> None:
    _end_run()
    if _end_run in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(_end_run)
