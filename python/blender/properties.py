"""Settings of the add-on in a scene, and in Blender's preferences."""

import os
from typing import List

import bpy
from bpy.props import (
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .logic.program import find_program


class LightwellPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program",
        description="The program lightwell; empty: the one on PATH",
        subtype="FILE_PATH",
    )

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.prop(self, "program")


def program(context: bpy.types.Context) -> str:
    """The path of the program. Raises ProgramError."""
    found = context.preferences.addons.get(__package__)
    # Blender may keep the path of a file relative to the .blend file, with // in front.
    given = bpy.path.abspath(found.preferences.program) if found else os.environ.get("LIGHTWELL_PROGRAM", "")
    return find_program(given)


def _dim(self: "LightwellChannel", context: bpy.types.Context) -> None:
    from . import show

    show.recolour(context.scene)


def _show(self: "LightwellSettings", context: bpy.types.Context) -> None:
    from . import show

    show.recolour(context.scene)
    show.look(context)


class LightwellChannel(bpy.types.PropertyGroup):
    """A group of lights that is dimmed as one."""

    level: FloatProperty(
        name="Level",
        description="Factor on the light as it was solved",
        default=1.0,
        min=0.0,
        soft_max=2.0,
        update=_dim,
    )
    lumens: FloatProperty(name="Lumens", description="Luminous flux as it was solved")


class LightwellSettings(bpy.types.PropertyGroup):
    """What the panel shows."""

    effort: EnumProperty(
        name="Effort",
        description="When the solve ends; its message has the estimated error in every case",
        items=[
            ("USUAL", "Usual", "As the program chooses: an error of about a percent in a plain room"),
            ("ACCURACY", "Accuracy", "Once the estimated error is small enough"),
            ("TIME", "Time", "With the best light within a time"),
        ],
        default="USUAL",
    )
    accuracy: FloatProperty(
        name="Error",
        description="Estimated RMS error of illuminance at which the solve ends, in percent of the mean",
        default=2.0,
        min=0.1,
        max=50.0,
        subtype="PERCENTAGE",
    )
    seconds: IntProperty(
        name="Seconds",
        description="Seconds after which the solve ends with the best light so far",
        default=10,
        min=1,
        soft_max=3600,
    )
    lumens_per_watt: FloatProperty(
        name="lm/W",
        description="Lumens in one watt of white light. 683: a watt of 555 nm, as Blender's glTF export counts",
        default=683.0,
        min=1.0,
        max=683.0,
    )
    group: EnumProperty(
        name="Channels",
        description="Light that can be dimmed by itself after the solve",
        items=[
            ("LIGHT", "Lights", "A channel for each light and each object that shines"),
            ("COLLECTION", "Collections", "A channel for the lights of each collection"),
            ("NONE", "One", "All light together"),
        ],
        default="LIGHT",
    )
    folder: StringProperty(
        name="Folder",
        description="Of the scene file and the light; empty: beside the .blend file",
        subtype="DIR_PATH",
    )
    view: EnumProperty(
        name="Show",
        items=[
            ("LIGHT", "Light", "The light that leaves the surfaces"),
            ("LUX", "False Colours", "Illuminance in lux"),
        ],
        default="LUX",
        update=_show,
    )
    low: FloatProperty(
        name="From",
        description="Lux of the first colour; 0: a linear scale, otherwise a logarithmic one",
        min=0.0,
        update=_show,
    )
    high: FloatProperty(
        name="To", description="Lux of the last colour; 0: chosen by the light", min=0.0, update=_show
    )
    solution: StringProperty(name="Solution", description="Its file, relative to the .blend file")
    solved: StringProperty(name="Solved", description="Identifies the exported scene that was solved")
    message: StringProperty(name="Message")
    channels: CollectionProperty(type=LightwellChannel)


def undo_step(message: str) -> None:
    """Makes what a timer or a click has changed a step of its own, so that undoing keeps to steps of the user."""
    windows = bpy.context.window_manager.windows
    if not bpy.app.background and len(windows):
        with bpy.context.temp_override(window=bpy.context.window or windows[0]):
            bpy.ops.ed.undo_push(message=message)


def levels(settings: LightwellSettings) -> List[float]:
    """The levels of the channels in their order."""
    return [channel.level for channel in settings.channels]


CLASSES = (LightwellPreferences, LightwellChannel, LightwellSettings)


def attach() -> None:
    bpy.types.Scene.lightwell = PointerProperty(type=LightwellSettings)


def detach() -> None:
    del bpy.types.Scene.lightwell
