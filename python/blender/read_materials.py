"""Reads Blender's shader nodes as far as the solver knows them."""

import os
import re
from dataclasses import replace
from typing import Dict, List, Optional, Tuple, Union

import bpy
import numpy as np

from .logic.colours import encoded
from .logic.materials import Picture, Shader

UNKNOWN_GREY = Shader(base=(0.8, 0.8, 0.8), roughness=1.0)  # as Cycles draws faces without a material

WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "MIRROR": "mirror", "CLIP": "clamp"}

OF_LIGHT = (".exr", ".hdr")
"""Endings of pictures without an upper end, which are read as light alone."""

LEFT_OUT_INPUTS = {  # a number above 0 or a link counts
    "Subsurface Weight": "subsurface scattering",
    "Sheen Weight": "sheen",
    "Anisotropic": "anisotropy",
    "Thin Film Thickness": "thin film",
}

LEFT_OUT_TINTS = {"Specular Tint": "specular tint", "Coat Tint": "coat tint"}  # a colour besides white or a link counts

LEFT_OUT_OUTPUTS = {"Volume": "a volume", "Displacement": "displacement"}
"""Inputs of the material's output that count if they are linked."""


class Pictures:
    """Images that materials use, as files of the scene's folder."""

    def __init__(self, files: Dict[str, bytes]):
        self.files = files
        self._known: Dict[Tuple[str, bool], Optional[str]] = {}

    def file_of(self, image: bpy.types.Image, is_light: bool = False) -> Optional[str]:
        """The file below the scene's folder; None if the image has no pixels, such as a missing file.

        is_light: the picture is one of light, not of reflectance or a mask, and may be OpenEXR or HDR.
        """
        key = (image.name_full, is_light)
        if key not in self._known:
            self._known[key] = self._keep(image, is_light)
        return self._known[key]

    def _keep(self, image: bpy.types.Image, is_light: bool) -> Optional[str]:
        data = _stored_bytes(image)
        ending = _ending(data)
        if ending is None or ending in OF_LIGHT and not is_light:
            data, ending = _as_png(image), ".png"
        if data is None:
            return None
        plain = re.sub(r"[^A-Za-z0-9_-]", "_", os.path.splitext(image.name)[0])[:60]
        name = f"pictures/{len(self._known) + 1:03d}-{plain}{ending}"
        self.files[name] = data
        return name


def _stored_bytes(image: bpy.types.Image) -> Optional[bytes]:
    if image.is_dirty or image.source != "FILE":
        return None
    if image.packed_file:
        return image.packed_file.data
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return None


def _ending(data: Optional[bytes]) -> Optional[str]:
    """The ending of a format that the solver reads."""
    if data is None:
        return None
    starts = {b"\x89PNG": ".png", b"\xff\xd8\xff": ".jpg", b"\x76\x2f\x31\x01": ".exr", b"#?": ".hdr"}
    return next((ending for start, ending in starts.items() if data.startswith(start)), None)


def is_black(image: bpy.types.Image) -> bool:
    """True if no pixel has light; the program refuses a channel of a surface that does not shine."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return image.channels > 0 and not (values.reshape(-1, image.channels)[:, :3] > 0.0).any()


def _as_png(image: bpy.types.Image) -> Optional[bytes]:
    if image.source not in ("FILE", "GENERATED") or not image.has_data and not image.size[0]:
        return None
    width, height = image.size
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    if width * height == 0 or len(values) != width * height * image.channels:
        return None
    rgba = _four_channels(values.reshape(-1, image.channels))
    if image.is_float:  # linear, where the pixels of other images are those of the file
        rgba[:, :3] = encoded(rgba[:, :3])
    path = os.path.join(bpy.app.tempdir or bpy.utils.resource_path("USER"), "lightwell-picture.png")
    copy = bpy.data.images.new("lightwell-picture", width, height, alpha=True)
    try:
        copy.pixels.foreach_set(rgba.ravel())
        copy.file_format = "PNG"
        copy.save(filepath=path)
        with open(path, "rb") as file:
            return file.read()
    except (RuntimeError, OSError):
        return None
    finally:
        bpy.data.images.remove(copy)
        if os.path.exists(path):
            os.remove(path)


def _four_channels(values: np.ndarray) -> np.ndarray:
    rgba = np.ones((len(values), 4), np.float32)
    count = values.shape[1]
    if count >= 3:
        rgba[:, :count] = values[:, :4]
    else:
        rgba[:, :3] = values[:, :1]
    return rgba


def read_material(material: Optional[bpy.types.Material], pictures: Pictures) -> Shader:
    """The material as the solver knows it."""
    if material is None:
        return replace(UNKNOWN_GREY, left_out=("faces without a material have a reflectance of 0.8",))
    tree = node_tree(material)
    output = output_of(tree) if tree else None
    surface = source_of(output.inputs["Surface"]) if output else None
    beside = tuple(said for name, said in LEFT_OUT_OUTPUTS.items() if output and output.inputs[name].is_linked)
    if surface is None:
        return _viewport(material, *beside, "no surface shader; the viewport's colour")
    reader = READERS.get(surface.type)
    if reader is None:
        return _viewport(material, *beside, f"node '{surface.bl_label}'; the viewport's colour")
    inputs = _Inputs(surface, material, pictures)
    shader = reader(inputs)
    return replace(shader, left_out=shader.left_out + beside + tuple(dict.fromkeys(inputs.left_out)))


def node_tree(data: Union[bpy.types.Material, bpy.types.World]) -> Optional[bpy.types.NodeTree]:
    """The nodes in use; before Blender 5 they could be switched off."""
    return data.node_tree if bpy.app.version >= (5, 0, 0) or data.use_nodes else None


def output_of(tree: bpy.types.NodeTree) -> Optional[bpy.types.Node]:
    """The output that Cycles takes."""
    for target in ("CYCLES", "ALL"):
        output = tree.get_output_node(target)
        if output:
            return output
    return None


def _viewport(material: bpy.types.Material, *why: str) -> Shader:
    colour = tuple(material.diffuse_color[:3])
    return Shader(base=colour, roughness=1.0, left_out=why)


def source_of(socket: bpy.types.NodeSocket) -> Optional[bpy.types.Node]:
    """The node that feeds a socket, past reroutes."""
    while socket.is_linked and socket.links:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


class _Inputs:
    """Inputs of one shader node; what they hold besides numbers and pictures is listed in `left_out`."""

    def __init__(self, node: bpy.types.Node, material: bpy.types.Material, pictures: Pictures):
        self.node = node
        self.material = material
        self.pictures = pictures
        self.left_out: List[str] = []

    def number(self, name: str, default: float = 0.0) -> float:
        socket = self.node.inputs.get(name)
        if socket is None:
            return default
        source = source_of(socket)
        if source is not None and source.type == "VALUE":
            return float(source.outputs[0].default_value)
        if source is not None:
            self.left_out.append(f"node '{source.bl_label}' of {name.lower()}; the socket's own number")
        return float(socket.default_value)

    def colour(self, name: str) -> Tuple[Tuple[float, float, float], Optional[Picture]]:
        """The colour, and the picture that stands in its place."""
        socket = self.node.inputs.get(name)
        if socket is None:
            return (0.0, 0.0, 0.0), None
        source = source_of(socket)
        own = tuple(float(c) for c in socket.default_value[:3])
        if source is None:
            return own, None
        if source.type == "RGB":
            return tuple(float(c) for c in source.outputs[0].default_value[:3]), None
        if source.type == "TEX_IMAGE":
            picture = self._picture(source, self._is_light(name))
            if picture and self._is_light(name) and is_black(source.image):
                return (0.0, 0.0, 0.0), None
            if picture:
                return (1.0, 1.0, 1.0), picture
            self.left_out.append("pictures that are missing; a grey of 0.5")
            return (0.5, 0.5, 0.5), None
        self.left_out.append(f"node '{source.bl_label}' of {name.lower()}; the viewport's colour")
        return tuple(self.material.diffuse_color[:3]), None

    def _is_light(self, name: str) -> bool:
        return name == "Emission Color" or self.node.type == "EMISSION"

    def alpha_picture(self, name: str) -> Optional[Picture]:
        """The picture whose alpha is linked to a socket."""
        socket = self.node.inputs.get(name)
        source = source_of(socket) if socket else None
        if source is None or source.type != "TEX_IMAGE" or socket.links[0].from_socket.name != "Alpha":
            return None
        return self._picture(source)

    def _picture(self, node: bpy.types.Node, is_light: bool = False) -> Optional[Picture]:
        if node.image is None:
            return None
        file = self.pictures.file_of(node.image, is_light)
        if file is None:
            return None
        vector = source_of(node.inputs["Vector"])
        if vector is not None and vector.type not in ("UVMAP", "TEX_COORD"):
            self.left_out.append(f"node '{vector.bl_label}' of a picture's place")
        elif vector is not None and vector.type == "TEX_COORD":
            if node.inputs["Vector"].links[0].from_socket.name != "UV":
                self.left_out.append("pictures placed otherwise than by UV; the active UV map")
        if node.extension == "CLIP":
            self.left_out.append("pictures clipped at their edge; the edge is continued")
        nearest = "nearest" if node.interpolation == "Closest" else "smooth"
        return Picture(file, WRAPS.get(node.extension, "repeat"), nearest)


def _principled(inputs: _Inputs) -> Shader:
    base, picture = inputs.colour("Base Color")
    emission, glow = inputs.colour("Emission Color")
    strength = inputs.number("Emission Strength")
    mask = inputs.alpha_picture("Alpha")
    for name, said in LEFT_OUT_INPUTS.items():
        socket = inputs.node.inputs.get(name)
        if socket is not None and (socket.is_linked or socket.default_value > 0.0):
            inputs.left_out.append(said)
    for name, said in LEFT_OUT_TINTS.items():
        socket = inputs.node.inputs.get(name)
        is_seen = name != "Coat Tint" or inputs.node.inputs["Coat Weight"].default_value > 0.0
        if socket is not None and is_seen and (socket.is_linked or min(socket.default_value[:3]) < 1.0):
            inputs.left_out.append(said)
    if inputs.node.inputs["Normal"].is_linked:
        inputs.left_out.append("bump and normal maps")
    return Shader(
        base=base,
        base_picture=picture,
        metallic=inputs.number("Metallic"),
        roughness=inputs.number("Roughness"),
        ior=inputs.number("IOR", 1.5),
        specular_level=inputs.number("Specular IOR Level", 0.5),
        transmission=inputs.number("Transmission Weight"),
        coat=inputs.number("Coat Weight"),
        coat_ior=inputs.number("Coat IOR", 1.5),
        coat_roughness=inputs.number("Coat Roughness", 0.03),
        alpha=1.0 if mask else inputs.number("Alpha", 1.0),
        mask=mask,
        emission=tuple(strength * c for c in emission) if strength > 0.0 else (0.0, 0.0, 0.0),
        emission_picture=glow if strength > 0.0 else None,
    )


def _diffuse(inputs: _Inputs) -> Shader:
    base, picture = inputs.colour("Color")
    return Shader(base=base, base_picture=picture, roughness=1.0)


def _emission(inputs: _Inputs) -> Shader:
    colour, picture = inputs.colour("Color")
    strength = inputs.number("Strength", 1.0)
    return Shader(
        base=(0.0, 0.0, 0.0),
        roughness=1.0,
        emission=tuple(strength * c for c in colour),
        emission_picture=picture,
    )


def _glass(inputs: _Inputs) -> Shader:
    base, picture = inputs.colour("Color")
    roughness = inputs.number("Roughness")
    # The node colours each crossing; the tint of a principled shader is the root of its base colour.
    both = tuple(c * c for c in base)
    return Shader(
        base=both, base_picture=picture, roughness=roughness, ior=inputs.number("IOR", 1.5), transmission=1.0
    )


def _glossy(inputs: _Inputs) -> Shader:
    name = "Base Color" if inputs.node.inputs.get("Base Color") else "Color"
    base, picture = inputs.colour(name)
    return Shader(base=base, base_picture=picture, roughness=inputs.number("Roughness"), metallic=1.0)


def _translucent(inputs: _Inputs) -> Shader:
    base, picture = inputs.colour("Color")
    if picture:
        inputs.left_out.append("pictures of translucency; a grey of 0.5")
        base = (0.5, 0.5, 0.5)
    return Shader(base=base, roughness=1.0, translucent=1.0)


def _transparent(inputs: _Inputs) -> Shader:
    base, _ = inputs.colour("Color")
    # A sheet passes the same share of all bands on, and absorbs the rest.
    return Shader(base=(0.0, 0.0, 0.0), roughness=1.0, alpha=1.0 - sum(base) / 3.0)


READERS = {
    "BSDF_PRINCIPLED": _principled,
    "BSDF_DIFFUSE": _diffuse,
    "EMISSION": _emission,
    "BSDF_GLASS": _glass,
    "BSDF_GLOSSY": _glossy,
    "BSDF_METALLIC": _glossy,
    "BSDF_TRANSLUCENT": _translucent,
    "BSDF_TRANSPARENT": _transparent,
}
