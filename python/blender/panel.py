"""The panel "Lightwell" in the sidebar of the 3D view."""

import bpy

from . import show, solve
from .logic.lights import spoken
from .read_lights import read_light


class _InSidebar:
    """A panel in the sidebar of the 3D view."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Lightwell"


class LIGHTWELL_PT_panel(_InSidebar, bpy.types.Panel):
    bl_label = "Lightwell"
    bl_idname = "LIGHTWELL_PT_panel"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = context.scene.lightwell
        run = solve.Run.current
        if run is None:
            layout.operator("lightwell.solve", icon="LIGHT")
        else:
            row = layout.row(align=True)
            if run.job.share is None:
                row.label(text=run.words())
            else:
                row.progress(factor=run.job.share, text=run.words())
            row.operator("lightwell.cancel", text="", icon="X")
        column = layout.column(align=True)
        column.prop(settings, "effort")
        if settings.effort != "USUAL":
            column.prop(settings, "accuracy" if settings.effort == "ACCURACY" else "seconds")
        layout.prop(settings, "group")
        _wrapped(layout, settings.message)


class LIGHTWELL_PT_light(_InSidebar, bpy.types.Panel):
    bl_label = "Light"
    bl_parent_id = "LIGHTWELL_PT_panel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return show.light_object(context.scene) is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = context.scene.lightwell
        layout.prop(settings, "view", expand=True)
        row = layout.row(align=True)
        row.prop(settings, "low")
        row.prop(settings, "high")
        layout.prop(show.light_object(context.scene), "hide_viewport", text="Hide", toggle=True)
        row = layout.row(align=True)
        row.operator("lightwell.read", icon="EYEDROPPER")
        row.operator("lightwell.clear_readings", text="", icon="TRASH")
        layout.operator("lightwell.lightmaps", icon="TEXTURE")


class LIGHTWELL_PT_channels(_InSidebar, bpy.types.Panel):
    bl_label = "Channels"
    bl_parent_id = "LIGHTWELL_PT_panel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return len(context.scene.lightwell.channels) > 0

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        for channel in context.scene.lightwell.channels:
            lumens = channel.level * channel.lumens
            column.prop(channel, "level", text=f"{channel.name}  {lumens:.4g} lm", slider=True)


class LIGHTWELL_PT_scene(_InSidebar, bpy.types.Panel):
    bl_label = "Units and Files"
    bl_parent_id = "LIGHTWELL_PT_panel"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = context.scene.lightwell
        layout.prop(settings, "lumens_per_watt")
        found = context.object
        if found is not None and found.type == "LIGHT" and found.data.type != "SUN":
            light = read_light(found.data, found.name, found.matrix_world, show.metres_of(context.scene), {}, [])
            said = spoken(light, settings.lumens_per_watt) if light else f"{found.name}: no light"
            _wrapped(layout, said)
        layout.label(text="Watts here are light, not those on a lamp's box.")
        layout.prop(settings, "folder")
        layout.operator("lightwell.export", icon="EXPORT")
        if solve.NOTES in bpy.data.texts:
            count = len([line for line in bpy.data.texts[solve.NOTES].lines if line.body])
            layout.label(text=f"{count} notes in the text '{solve.NOTES}'")


def _wrapped(layout: bpy.types.UILayout, words: str, width: int = 44) -> None:
    """A message in lines of about `width` letters."""
    line = ""
    column = layout.column(align=True)
    for word in words.split():
        if line and len(line) + len(word) + 1 > width:
            column.label(text=line)
            line = ""
        line = f"{line} {word}" if line else word
    if line:
        column.label(text=line)


CLASSES = (LIGHTWELL_PT_panel, LIGHTWELL_PT_light, LIGHTWELL_PT_channels, LIGHTWELL_PT_scene)
