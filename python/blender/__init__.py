"""Lightwell in Blender: the light of a scene in lux, on its surfaces, dimmed without solving again."""

import bpy

from . import lightmaps, overlay, panel, properties, show, solve

MODULES = (properties, solve, show, overlay, lightmaps, panel)


def register() -> None:
    for module in MODULES:
        for found in module.CLASSES:
            bpy.utils.register_class(found)
    properties.attach()
    solve.attach()
    overlay.attach()


def unregister() -> None:
    overlay.detach()
    solve.detach()
    properties.detach()
    for module in reversed(MODULES):
        for found in reversed(module.CLASSES):
            bpy.utils.unregister_class(found)
