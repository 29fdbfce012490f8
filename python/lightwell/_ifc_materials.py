"""Surfaces and materials of a model in IFC."""

import fnmatch
from typing import Any, Dict, NamedTuple, Optional, Sequence

import numpy as np

from ._ifc_model import FaceOptics, Model, Surface, element_name, is_a, points_of_shape

GREY = 0.5
"""Reflectance of surfaces whose material says nothing."""
GLASS = 0.08
"""Reflectance of a pane of which the model says only what it passes: two faces of 4 %."""
PANES = ("IfcWindow", "IfcPlate", "IfcCurtainWall", "IfcDoor")
"""Classes whose property sets may describe their glass."""


class Optics(NamedTuple):
    """A row of the table of materials."""

    reflectance: float
    passed: Optional[float]
    """The share that passes; None: what the model says."""


def add_surfaces(element: Any, shape: Any, table: Dict[str, Optics], model: Model) -> None:
    """Adds the triangles of an element, a surface for each of its styles."""
    geometry = shape.geometry
    vertices, faces = points_of_shape(geometry.verts), np.array(geometry.faces, dtype=np.int64).reshape(-1, 3)
    owner = np.array(geometry.material_ids, dtype=np.int64)
    styles = list(geometry.materials)
    for number in np.unique(owner) if len(owner) else []:
        style = styles[number] if number >= 0 else None
        material = _material(element, style, table, model)
        part = faces[owner == number]
        suffix = "" if len(styles) < 2 else f" {material}"
        model.surfaces.append(Surface(element_name(element) + suffix, material, vertices, part))


class _Pane(NamedTuple):
    """A share that passes both faces of an element."""

    passed: float
    is_measured: bool
    """True: a property or the table says so; False: a style, which is made for pictures."""


def _material(element: Any, style: Any, table: Dict[str, Optics], model: Model) -> str:
    """The name of the material of a style on an element, which is added to the model."""
    from ifcopenshell.util.element import get_material, get_psets  # type: ignore

    of_element = get_material(element, should_skip_usage=True)
    named = getattr(of_element, "Name", None) or getattr(of_element, "LayerSetName", None)
    styled = None if style is None else _style_name(element.file, style)
    names = [" ".join(name.split()) for name in (named, styled) if name] or [element.is_a()]
    optical = {} if of_element is None else get_psets(of_element).get("Pset_MaterialOptical", {})
    pane = _pane(element, style, optical)
    for pattern, row in table.items():
        for name in names:
            if fnmatch.fnmatchcase(name, pattern):
                return _keep(model, name, [row.reflectance] * 3, pane if row.passed is None else _Pane(row.passed, True))
    front = _share(optical.get("VisibleReflectanceFront"))
    if front is not None:
        return _keep(model, str(named), [front] * 3, pane)
    if pane.is_measured and pane.passed > 0.0:
        return _keep(model, styled or named or "glass", [min(GLASS, 1.0 - pane.passed)] * 3, pane)
    if style is not None:
        return _keep(model, styled or "style", [_linear(value) for value in style.diffuse.components], pane)
    note = f"{element.is_a()} without colour or reflectance: a reflectance of {GREY} is assumed."
    if note not in model.notes:
        model.notes.append(note)
    return _keep(model, named or "grey", [GREY] * 3, pane)


def _pane(element: Any, style: Any, optical: Dict[str, Any]) -> _Pane:
    """The light that passes: by the element's glazing, its material, or the style.

    The glazing of an element with styles is what its transparent styles colour.
    """
    from ifcopenshell.util.element import get_psets

    of_style = _transparency(style)
    if style is not None and of_style == 0.0:
        return _Pane(0.0, False)
    if any(is_a(element, name) for name in PANES) and (style is not None or not is_a(element, "IfcDoor")):
        glazing = get_psets(element).get("Pset_DoorWindowGlazingType", {})
        passed = _share(glazing.get("VisibleLightTransmittance"))
        if passed is not None:
            return _Pane(passed, True)
    passed = _share(optical.get("VisibleTransmittance"))
    return _Pane(of_style, False) if passed is None else _Pane(passed, True)


def _share(value: Any) -> Optional[float]:
    """A number from 0 to 1; None for all else."""
    return float(value) if isinstance(value, (int, float)) and 0.0 <= value <= 1.0 else None


def _style_name(file: Any, style: Any) -> str:
    """The name of the IfcSurfaceStyle that a style of a shape was made from."""
    made_from = file.by_id(style.instance_id())
    if not made_from.is_a("IfcSurfaceStyle"):
        users = file.get_inverse(made_from)
        made_from = next((user for user in users if user.is_a("IfcSurfaceStyle")), made_from)
    return str(getattr(made_from, "Name", None) or style.name)


def _transparency(style: Any) -> float:
    """The share of light that passes a style, 0 to 1."""
    if style is None or not style.has_transparency():
        return 0.0
    passed = float(style.transparency)
    return min(max(passed, 0.0), 1.0) if passed == passed else 0.0


def _linear(value: float) -> float:
    """A share of light of a number in sRGB, 0 to 1 (IEC 61966-2-1)."""
    v = min(max(float(value), 0.0), 1.0)
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def _faces(reflectance: Sequence[float], pane: _Pane) -> FaceOptics:
    """Each of the two faces of an element that together reflect and pass what it does.

    Of two sheets that reflect r and pass t, T = t^2 / (1 - r^2) passes and R = r (1 + T) comes back. The
    colour of a style is instead that of what does not pass a face.
    """
    if not pane.is_measured:
        passed = pane.passed**0.5
        return FaceOptics([(1.0 - passed) * value for value in reflectance], passed)
    face = [min(value, 1.0 - pane.passed) / (1.0 + pane.passed) for value in reflectance]
    return FaceOptics(face, (pane.passed * (1.0 - max(face) ** 2)) ** 0.5)


def _keep(model: Model, name: str, reflectance: Sequence[float], pane: _Pane) -> str:
    """The name under which the model has this material."""
    faces = _faces(reflectance, pane)
    made = FaceOptics([round(float(value), 6) for value in faces.reflectance], round(faces.transparent, 6))
    name = " ".join(name.replace("#", "").split())
    free, number = name, 2
    while model.materials.setdefault(free, made) != made:
        free, number = f"{name} {number}", number + 1
    return free
