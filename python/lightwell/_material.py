"""Materials."""

from dataclasses import dataclass, replace
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Union

import numpy as np

from . import _lightwell
from ._arrays import real_number
from ._errors import InputError
from ._toml import toml_text

Values = Union[float, Sequence[float]]
"""One value for all bands, or one each for red, green and blue."""


def _values(name: str, values: Any) -> List[float]:
    if np.ndim(values) == 0:
        return [real_number(name, values)]
    return [real_number(name, value) for value in values]


def _spectral(name: str, values: Any) -> Values:
    numbers = _values(name, values)
    return numbers[0] if np.ndim(values) == 0 else numbers


@dataclass(frozen=True)
class Material:
    """Reflection and emission of a surface. Shares add up to at most 1 in every band."""

    name: str = "material"
    reflectance: Values = 0.5
    """Diffuse reflectance rho, 0 to 1."""
    emission: Values = 0.0
    """Exitance M = pi L of a Lambertian emitter, W/m^2."""
    specular: Values = 0.0
    """Mirror reflectance, 0 to 1."""
    roughness: float = 0.0
    """GGX alpha of the mirror, 0 to 1; 0 is smooth."""
    transmittance: Values = 0.0
    """Diffuse transmittance of a thin sheet, 0 to 1."""
    one_sided: bool = False
    """True: the back is black."""
    emits_both_sides: bool = False

    def _compiled(self) -> "_lightwell.Material":
        made = _lightwell.Material()
        made.name = str(self.name)
        made.reflectance = _values("reflectance", self.reflectance)
        made.emission = _values("emission", self.emission)
        made.specular = _values("specular", self.specular)
        made.roughness = real_number("roughness", self.roughness)
        made.transmittance = _values("transmittance", self.transmittance)
        made.one_sided = bool(self.one_sided)
        made.emits_both_sides = bool(self.emits_both_sides)
        return made

    def _table(self) -> Dict[str, Any]:
        """The keys of the scene format."""
        emits = bool(np.any(np.asarray(self.emission) != 0.0))
        return {
            "reflectance": _spectral("reflectance", self.reflectance),
            "exitance": _spectral("emission", self.emission) if emits else None,
            "emits": "both" if emits and self.emits_both_sides else None,
            "specular": _spectral("specular", self.specular),
            "roughness": real_number("roughness", self.roughness) if self.roughness else None,
            "translucent": _spectral("transmittance", self.transmittance),
            "sides": "one" if self.one_sided else None,
        }


def material_of(compiled: "_lightwell.Material") -> Material:
    return Material(
        name=compiled.name,
        reflectance=tuple(compiled.reflectance),
        emission=tuple(compiled.emission),
        specular=tuple(compiled.specular),
        roughness=compiled.roughness,
        transmittance=tuple(compiled.transmittance) or 0.0,
        one_sided=compiled.one_sided,
        emits_both_sides=compiled.emits_both_sides,
    )


def _per_surface(name: str, surfaces: int, values: Any) -> List[Values]:
    array = np.asarray(values, dtype=object if isinstance(values, list) else None)
    if array.ndim == 0:
        return [real_number(name, values)] * surfaces
    if len(array) != surfaces:
        raise InputError(
            f"{name} has {len(array)} entries for {surfaces} surfaces; give one for all, or one for each, "
            "of one value or three (r, g, b)"
        )
    return [value if np.ndim(value) == 0 else tuple(value) for value in array]


class MaterialsOfSurfaces(NamedTuple):
    """Materials of s surfaces."""

    compiled: List[Material]
    """(s,): of each surface, unless it has a named one."""
    named: List[str]
    """(s,): name of one of `tables`; "": none."""
    tables: Dict[str, Mapping[str, Any]]
    """Keys of [materials.NAME] of the scene format."""


def materials_of(surfaces: int, materials: Any, reflectance: Any, emission: Any) -> MaterialsOfSurfaces:
    """The arguments of `Scene.from_arrays`."""
    if materials is None:
        given: List[Any] = [Material(name=f"material {number}") for number in range(surfaces)]
    elif isinstance(materials, (Material, Mapping)):
        given = [materials] * surfaces
    else:
        given = list(materials)
        if not all(isinstance(material, (Material, Mapping)) for material in given):
            raise InputError("materials must be a lightwell.Material or a dictionary, or a list of them")
        if len(given) != surfaces:
            raise InputError(
                f"materials has {len(given)} entries for {surfaces} surfaces; give one for all, or one each"
            )
    tables: Dict[str, Mapping[str, Any]] = {}
    named = [_add_table(material, tables) if isinstance(material, Mapping) else "" for material in given]
    if tables and not (reflectance is None and emission is None):
        raise InputError("reflectance and emission go with lightwell.Material; give them as keys of the dictionaries")
    made = [Material() if name else material for name, material in zip(named, given)]
    if reflectance is not None:
        each = _per_surface("reflectance", surfaces, reflectance)
        made = [replace(material, reflectance=value) for material, value in zip(made, each)]
    if emission is not None:
        each = _per_surface("emission", surfaces, emission)
        made = [replace(material, emission=value) for material, value in zip(made, each)]
    return MaterialsOfSurfaces(made, named, tables)


def _add_table(material: Mapping[str, Any], tables: Dict[str, Mapping[str, Any]]) -> str:
    """Adds the keys of a material without its name, which is returned."""
    name = material.get("name")
    if not isinstance(name, str) or not name:
        raise InputError(f"the material {dict(material)!r} has no name; give it the key 'name'")
    keys = {key: value for key, value in material.items() if key != "name"}
    if toml_text(tables.setdefault(name, keys)) != toml_text(keys):
        raise InputError(f"two materials have the name '{name}'; give each its own")
    return name
