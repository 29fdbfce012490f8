"""Conversions of the Blender add-on that need no Blender: light, materials, cameras, files, colours."""
