"""Materials of a scene file from what Blender's shaders say."""

import math
from dataclasses import dataclass, field
from typing import Callable, Dict, List, Optional, Tuple

Colour = Tuple[float, float, float]
Table = Dict[str, object]

DIFFUSE_ROUGHNESS = 0.7  # rougher coats and metals scatter as diffuse surfaces do; as in the glTF reader
LEAST_METAL = 0.02


@dataclass(frozen=True)
class Picture:
    """An image on a surface: its file below the scene's folder, how it continues and is filtered."""

    file: str
    wrap: str = "repeat"
    filter: str = "smooth"

    def table(self) -> Table:
        return {"file": self.file, "wrap": self.wrap, "filter": self.filter}


@dataclass(frozen=True)
class Shader:
    """The inputs of Blender's Principled BSDF that the solver knows; colours are linear Rec. 709."""

    base: Colour = (0.8, 0.8, 0.8)
    base_picture: Optional[Picture] = None
    metallic: float = 0.0
    roughness: float = 0.5
    ior: float = 1.5
    specular_level: float = 0.5
    """0.5 leaves the reflectance of `ior` as it is; 0 is a diffuse surface."""
    transmission: float = 0.0
    coat: float = 0.0
    coat_ior: float = 1.5
    coat_roughness: float = 0.03
    alpha: float = 1.0
    mask: Optional[Picture] = None
    translucent: float = 0.0
    """Share of the base colour that a thin sheet scatters to its other side."""
    emission: Colour = (0.0, 0.0, 0.0)
    """Radiance, W/(m^2 sr): colour times strength, of white texels where there is a picture."""
    emission_picture: Optional[Picture] = None
    left_out: Tuple[str, ...] = field(default=())
    """Inputs and nodes that were not understood."""


def _is_layered(shader: Shader) -> bool:
    """True if the base mirrors or lets light through by itself, which leaves no place for a coat."""
    is_mirror = shader.metallic >= LEAST_METAL and shader.roughness <= DIFFUSE_ROUGHNESS
    return is_mirror or shader.alpha < 1.0 or shader.translucent > 0.0


LEFT_OUT: Tuple[Tuple[Tuple[str, ...], str, Callable[[Shader], bool]], ...] = (
    (("shine", "glass"), "alpha", lambda s: s.alpha < 1.0),
    (("shine", "glass"), "a mask", lambda s: s.mask is not None),
    (("shine", "glass"), "metallic", lambda s: s.metallic >= LEAST_METAL),
    (("shine", "glass"), "a coat", lambda s: s.coat > 0.0),
    (("opaque",), "a coat of a weight below 0.5", lambda s: 0.0 < s.coat < 0.5),
    (("opaque",), "a coat rougher than 0.7", lambda s: s.coat >= 0.5 and s.coat_roughness > DIFFUSE_ROUGHNESS),
    (("opaque",), "a coat of metal or of what lets light through", lambda s: s.coat >= 0.5 and _is_layered(s)),
)
"""What materials of a kind do not have here: the kinds, the words, and whether a shader has it."""

KINDS = {"shine": "of a material that shines", "glass": "of glass", "opaque": ""}


def _unused(shader: Shader, kind: str) -> List[str]:
    return [f"{said} {KINDS[kind]}".rstrip() for kinds, said, has in LEFT_OUT if kind in kinds and has(shader)]


def emits(shader: Shader) -> bool:
    return max(shader.emission) > 0.0


def depends_on_closure(shader: Shader) -> bool:
    """True if the material is another one on closed bodies than on open sheets."""
    return emits(shader) or shader.transmission >= 0.5


def material_table(shader: Shader, is_closed: bool) -> Tuple[Table, List[str]]:
    """Keys of `[materials.NAME]`, and what was approximated.

    is_closed: the surface is that of a body with its fronts outside, which shines outwards only and
    is solid glass; otherwise an open sheet, which shines on both sides and is a thin pane.
    """
    base = tuple(_share(c) for c in shader.base)
    remarks = list(shader.left_out)
    if base != shader.base:
        remarks.append("base colour above 1")
    kind = "shine" if emits(shader) else "glass" if shader.transmission >= 0.5 else "opaque"
    remarks += _unused(shader, kind)
    if emits(shader):
        return _emitter(shader, base, is_closed, remarks), remarks
    if shader.transmission >= 0.5:
        if shader.base_picture:
            remarks.append("base colour picture of glass")
        return {"glass": _glass(shader, base, is_closed)}, remarks
    if shader.transmission > 0.0:
        remarks.append("transmission below 0.5")
    return _opaque(shader, base, remarks), remarks


def _emitter(shader: Shader, base: Colour, is_closed: bool, remarks: List[str]) -> Table:
    table: Table = {
        "radiance": [float(c) for c in shader.emission],
        "emits": "front" if is_closed else "both",
        "reflectance": [float(c) for c in base],
    }
    if shader.base_picture:
        table["texture"] = shader.base_picture.table()
    if shader.emission_picture:
        table["emission_texture"] = shader.emission_picture.table()
    if shader.transmission > 0.0:
        remarks.append("transmission of a material that shines")
        table["reflectance"] = [0.0, 0.0, 0.0]
        table.pop("texture", None)
    return table


def _glass(shader: Shader, base: Colour, is_closed: bool) -> Table:
    ior = min(max(shader.ior, 0.1), 10.0)
    if not is_closed:
        return {"ior": max(ior, 1.0), "thin": True, "transmissivity": list(base)}
    # Cycles colours each of the two crossings by the root of the base colour.
    glass: Table = {"ior": ior, "tint": [math.sqrt(c) for c in base]}
    if shader.roughness > 0.0:
        glass["roughness"] = _share(shader.roughness) ** 2
    return glass


def _opaque(shader: Shader, base: Colour, remarks: List[str]) -> Table:
    there = _share(shader.alpha)
    metal = _share(shader.metallic) if shader.metallic >= LEAST_METAL else 0.0
    is_glossy = shader.roughness <= DIFFUSE_ROUGHNESS
    table: Table = {}
    mirror = metal if is_glossy else 0.0
    through = _share(shader.translucent)
    diffuse = (1.0 - mirror) * there * (1.0 - through)
    # A picture has its own colours; the factor of reflectance is then the share alone.
    table["reflectance"] = [diffuse * (1.0 if shader.base_picture else c) for c in base]
    if shader.base_picture:
        table["texture"] = shader.base_picture.table()
        if mirror > 0.0:
            remarks.append("base colour picture of a metal's mirror")
    if mirror > 0.0:
        table["specular"] = [mirror * there * c for c in base]
        table["roughness"] = _share(shader.roughness) ** 2
    if through > 0.0:
        table["translucent"] = [there * through * c for c in base]
    if there < 1.0:
        table["transparent"] = 1.0 - there
    if shader.mask:
        table["mask"] = shader.mask.table()
    coat = _coat(shader)
    if coat and mirror == 0.0 and there == 1.0 and through == 0.0:
        # Principled: what the layer does not mirror reaches the base, and all that the base scatters
        # leaves. `base` of a coat would be darkened by reflection from within.
        left = 1.0 - even_reflectance(float(coat["ior"]))
        table["reflectance"] = [left * float(c) for c in table["reflectance"]]
        table["coat"] = coat
    return table


def even_reflectance(ior: float) -> float:
    """Share of even light that a smooth dielectric mirrors: the mean of Fresnel's equations by 2 cos d(cos).

    0.0918 for 1.5 (Egan & Hilgeman 1979). By Simpson's rule in the root of the cosine, where the
    integrand is smooth; rounded up by 1e-4, so that base and layer never exceed 1.
    """
    steps = 64
    total = 0.0
    for i in range(steps + 1):
        root = i / steps
        weight = 1 if i in (0, steps) else 4 if i % 2 else 2
        cosine = root * root
        total += weight * _fresnel(cosine, ior) * 4 * cosine * root
    return min(total / (3 * steps) + 1e-4, 1.0)


def _fresnel(cosine: float, ior: float) -> float:
    inside = math.sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior))
    parallel = (ior * cosine - inside) / (ior * cosine + inside)
    across = (cosine - ior * inside) / (cosine + ior * inside)
    return 0.5 * (parallel * parallel + across * across)


def _coat(shader: Shader) -> Optional[Table]:
    """The smooth layer over a diffuse base: the clear coat, or else the dielectric's own reflection."""
    if shader.coat >= 0.5 and shader.coat_roughness <= DIFFUSE_ROUGHNESS and shader.coat_ior > 1.0:
        return {"ior": min(shader.coat_ior, 10.0), "roughness": _share(shader.coat_roughness) ** 2}
    if shader.metallic >= LEAST_METAL or shader.roughness > DIFFUSE_ROUGHNESS:
        return None
    # Principled: F0 = ((n - 1) / (n + 1))^2 times twice the specular level.
    steep = ((shader.ior - 1.0) / (shader.ior + 1.0)) ** 2 * 2.0 * shader.specular_level
    root = math.sqrt(min(max(steep, 0.0), 0.66))
    ior = (1.0 + root) / (1.0 - root)
    return {"ior": ior, "roughness": _share(shader.roughness) ** 2} if ior > 1.001 else None


def _share(value: float) -> float:
    return min(max(float(value), 0.0), 1.0)
