"""Light fixtures of a model in IFC as lamps."""

import fnmatch
import os
from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

from ._ifc_model import Fixture, Model, element_name, is_a, toml_list
from ._toml import toml_string


@dataclass
class Fixtures:
    """The table of fixtures, and the folders of the model and of the scene."""

    table: List[Fixture]
    model_folder: str
    scene: str
    """Path of the scene file."""

    def add(self, element: Any, points: np.ndarray, model: Model) -> None:
        """Adds the lamps of a fixture: by the table, else by its own light sources."""
        names = [name for name in (element.Name, getattr(_type_of(element), "Name", None)) if name]
        chosen = next((row for row in self.table for name in names if fnmatch.fnmatchcase(name, row.pattern)), None)
        if chosen is not None:
            chosen.is_used = True
            keys = [f"{key} = {value!r}" for key, value in chosen.numbers.items()]
            _add_lamp(element_name(element), chosen.file, _underside(element, points), keys, model)
            return
        why = "no line of the table of fixtures names it"
        found = 0
        for source, matrix in _sources(element):
            name = element_name(element) if found == 0 else f"{element_name(element)} {found + 1}"
            problem = self._add_source(source, matrix, name, model)
            found += not problem
            why = problem or why
        if found == 0:
            model.notes.append(f"{element_name(element)} gives no light: {why}.")

    def _add_source(self, source: Any, matrix: np.ndarray, name: str, model: Model) -> str:
        """Adds the lamp of an IfcLightSource; what keeps it from being one, or ""."""
        if not source.is_a("IfcLightSourceGoniometric"):
            return f"its {source.is_a()} has no photometry; name a file in the table of fixtures"
        data = source.LightDistributionDataSource
        if data.is_a("IfcExternalReference"):
            file = self._referred(data.Location)
            if file is None:
                return f"the file of its light source, '{data.Location}', is not beside the model"
            _add_lamp(name, file, matrix, [], model)
            return ""
        text, problem = _photometry(source, data, name)
        if text is None:
            return problem
        ending = f"{source.id()}.ies"
        model.photometry[ending] = text
        stem = os.path.splitext(os.path.basename(self.scene))[0]
        _add_lamp(name, f"{stem}-{ending}", matrix, [], model)
        return ""

    def _referred(self, location: Optional[str]) -> Optional[str]:
        """A file that the model names, relative to the scene."""
        path = (location or "").removeprefix("file://").replace("\\", "/")
        for place in (path, os.path.basename(path)):
            file = os.path.join(self.model_folder, place)
            if place and os.path.isfile(file):
                return os.path.relpath(file, os.path.dirname(self.scene) or ".")
        return None


def is_fixture(element: Any) -> bool:
    """True for light fixtures, which IFC2X3 knows by their type alone."""
    if is_a(element, "IfcLightFixture"):
        return True
    kind = _type_of(element) if element.is_a("IfcFlowTerminal") else None
    return kind is not None and bool(kind.is_a("IfcLightFixtureType"))


def _type_of(element: Any) -> Any:
    from ifcopenshell.util.element import get_type  # type: ignore

    return get_type(element)


def _add_lamp(name: str, file: str, matrix: np.ndarray, keys: List[str], model: Model) -> None:
    """Adds a lamp of a photometric file at the origin of a matrix, metres, along its -z."""
    lines = [
        "[[lamps]]",
        f"name = {toml_string(name)}",
        f"file = {toml_string(file.replace(os.sep, '/'))}",
        f"position = {toml_list(matrix[:3, 3])}",
        f"aim = {toml_list(-matrix[:3, 2])}",
        f"c0 = {toml_list(matrix[:3, 0])}",
    ]
    model.lamps.append("\n".join(lines + keys))


def _placement(element: Any) -> np.ndarray:
    """The placement of an element, in the unit of its file."""
    from ifcopenshell.util.placement import get_local_placement  # type: ignore

    return np.array(get_local_placement(element.ObjectPlacement), dtype=np.float64)


def _in_metres(element: Any, matrix: np.ndarray) -> np.ndarray:
    from ifcopenshell.util.unit import calculate_unit_scale  # type: ignore

    made = matrix.copy()
    made[:3, 3] *= calculate_unit_scale(element.file)
    return made


def _underside(element: Any, points: np.ndarray) -> np.ndarray:
    """The placement moved to the middle of the underside of the points, metres."""
    matrix = _in_metres(element, _placement(element))
    if len(points):
        local = (points - matrix[:3, 3]) @ matrix[:3, :3]
        low, high = local.min(axis=0), local.max(axis=0)
        matrix[:3, 3] += matrix[:3, :3] @ np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]])
    return matrix


def _sources(element: Any) -> Iterator[Tuple[Any, np.ndarray]]:
    """Light sources of an element's shape and of its type, each with its placement, metres."""
    from ifcopenshell.util.placement import get_axis2placement, get_mappeditem_transformation

    def items(representation: Any, matrix: np.ndarray) -> Iterator[Tuple[Any, np.ndarray]]:
        for item in representation.Items:
            if item.is_a("IfcMappedItem"):
                placed = matrix @ np.array(get_mappeditem_transformation(item), dtype=np.float64)
                yield from items(item.MappingSource.MappedRepresentation, placed)
            elif item.is_a("IfcLightSource"):
                own = np.array(get_axis2placement(item.Position)) if item.is_a("IfcLightSourceGoniometric") else np.eye(4)
                yield item, _in_metres(element, matrix @ own)

    shape = element.Representation
    for representation in shape.Representations if shape is not None else ():
        yield from items(representation, _placement(element))


def _photometry(source: Any, data: Any, name: str) -> Tuple[Optional[str], str]:
    """An LM-63 file of an IfcLightIntensityDistribution; or None, and what keeps it from being one."""
    from ifcopenshell.util.unit import calculate_unit_scale

    if data.LightDistributionCurve not in ("TYPE_A", "TYPE_B", "TYPE_C"):
        return None, f"the intensities of its light source are of type {data.LightDistributionCurve}; A, B and C are read"
    if not source.LuminousFlux or source.LuminousFlux <= 0.0:
        return None, "its light source has no luminous flux"
    degrees = np.degrees(calculate_unit_scale(source.file, "PLANEANGLEUNIT"))
    given = {
        round(plane.MainPlaneAngle * degrees, 6): (np.array(plane.SecondaryPlaneAngle) * degrees, plane.LuminousIntensity)
        for plane in data.DistributionData
    }
    for angles, values in given.values():
        if len(angles) != len(values) or (np.diff(angles) <= 0.0).any():
            return None, "the angles of a plane of its light source do not rise, or are not as many as its intensities"
    if data.LightDistributionCurve != "TYPE_C":
        given = _type_c_of(data.LightDistributionCurve, given)
    gammas = _with_ends(np.concatenate([angles for angles, _ in given.values()]), 0.0, 180.0)
    intensities = _on_common_angles(given, gammas)
    angles = list(intensities)
    if angles[0] != 0.0 or angles[-1] > 360.0:
        return None, "the planes of its light source do not begin at C0"
    if len(angles) > 1 and angles[-1] not in (90.0, 180.0, 360.0):
        intensities[360.0] = intensities[0.0]
    values = np.array(list(intensities.values())) * source.LuminousFlux
    # A luminaire gives no more than its lamps: what would exceed them is in cd/klm.
    if _flux(np.array(list(intensities)), gammas, values) > 1.5 * source.LuminousFlux:
        values = values / 1000.0
    return _lm63(name, np.array(list(intensities)), gammas, values), ""


Planes = Dict[float, Tuple[np.ndarray, Any]]
"""Angles within each plane and the intensities there, by the angle of the plane; degrees."""


def _with_ends(given: np.ndarray, least: float, most: float) -> np.ndarray:
    """Angles from `least` to `most` degrees, with an end of light just beyond those given."""
    low, high = given.min(), given.max()
    ends = [least, most] + ([low - 0.01] if low > least + 0.01 else []) + ([high + 0.01] if high < most - 0.01 else [])
    return np.unique(np.round(np.concatenate([given, ends]), 6))


def _on_common_angles(planes: Planes, angles: np.ndarray) -> Dict[float, np.ndarray]:
    return {main: np.interp(angles, own, values, 0.0, 0.0) for main, (own, values) in sorted(planes.items())}


def _type_c_of(kind: str, given: Planes) -> Planes:
    """Intensities of type A or B, linear between their angles, on planes of type C.

    The planes of type B meet in a horizontal axis along C90, with B0 at the bottom and B90 at C0, and beta rises
    towards C90 (CIE 121). Those of type A are these, turned by 90 degrees counter-clockwise about the vertical (IFC).
    Angles from 0 on alone hold for both signs.
    """
    planes = _mirrored({_turned(main): own for main, own in given.items()})
    planes = {main: _mirrored_within(own) for main, own in planes.items()}
    inner = _with_ends(np.concatenate([angles for angles, _ in planes.values()]), -90.0, 90.0)
    rows = _on_common_angles(planes, inner)
    mains = np.array(list(rows))
    table = np.array(list(rows.values()))
    gap = mains[0] + 360.0 - mains[-1]
    if len(mains) > 1 and 0.0 < gap <= 1.5 * np.diff(mains).max():  # all around
        mains = np.concatenate([mains, [mains[0] + 360.0]])
        table = np.concatenate([table, table[:1]])
    step = float(np.clip(min(_least_step(mains), _least_step(inner)), 1.0, 5.0))
    c = np.linspace(0.0, 360.0, round(360.0 / step) + 1)
    gammas = np.linspace(0.0, 180.0, round(180.0 / step) + 1)
    sine = np.sin(np.radians(gammas))
    found: Planes = {}
    for angle in c:
        x, y, down = sine * np.cos(np.radians(angle)), sine * np.sin(np.radians(angle)), np.cos(np.radians(gammas))
        towards, axis = (x, y) if kind == "TYPE_B" else (y, -x)
        main = np.degrees(np.arctan2(towards, down))
        main[main < mains[0] - 1e-9] += 360.0
        secondary = np.degrees(np.arcsin(np.clip(axis, -1.0, 1.0)))
        found[round(float(angle), 6)] = gammas, _bilinear((mains, inner), table, main, secondary)
    return found


def _turned(angle: float) -> float:
    """An angle from -180 to 180 degrees."""
    return angle - 360.0 if angle > 180.0 else angle


def _mirrored(planes: Planes) -> Planes:
    """Planes on both sides of the vertical one, where those of one side alone are given."""
    if min(planes) < 0.0 or len(planes) == 1:
        return planes
    return {**{-main: own for main, own in planes.items() if main > 0.0}, **planes}


def _mirrored_within(plane: Tuple[np.ndarray, Any]) -> Tuple[np.ndarray, Any]:
    angles, values = plane[0], np.asarray(plane[1], dtype=np.float64)
    if angles[0] < 0.0:
        return angles, values
    first = 1 if angles[0] == 0.0 else 0
    return np.concatenate([-angles[first:][::-1], angles]), np.concatenate([values[first:][::-1], values])


def _least_step(angles: np.ndarray) -> float:
    """The least step between angles, but for those that end the light."""
    steps = np.diff(angles)
    wide = steps[steps > 0.1]
    return float(wide.min()) if len(wide) else 5.0


def _bilinear(
    angles: Tuple[np.ndarray, np.ndarray], table: np.ndarray, main: np.ndarray, secondary: np.ndarray
) -> np.ndarray:
    """Values of a table between its angles; 0 beyond them. A single plane holds for all angles of planes."""
    mains, inner = angles
    columns = np.array([np.interp(secondary, inner, row, 0.0, 0.0) for row in table])
    if len(mains) == 1:
        return columns[0]
    at = np.clip(np.searchsorted(mains, main, side="right") - 1, 0, len(mains) - 2)
    t = (main - mains[at]) / (mains[at + 1] - mains[at])
    number = np.arange(len(main))
    between = (1.0 - t) * columns[at, number] + t * columns[at + 1, number]
    return np.where((t < -1e-9) | (t > 1.0 + 1e-9), 0.0, between)


def _flux(planes: np.ndarray, gammas: np.ndarray, values: np.ndarray) -> float:
    """The flux of intensities: the integral over the sphere by the trapezium rule."""
    mean = values[0]
    if len(planes) > 1:
        weights = np.diff(planes) / (planes[-1] - planes[0])
        mean = (weights[:, np.newaxis] * 0.5 * (values[1:] + values[:-1])).sum(axis=0)
    heights = -np.diff(np.cos(np.radians(gammas)))
    return float(2.0 * np.pi * (0.5 * (mean[1:] + mean[:-1]) * heights).sum())


def _lm63(name: str, planes: np.ndarray, gammas: np.ndarray, candela: np.ndarray) -> str:
    def rows(values: Any) -> str:
        return "\n".join(" ".join(f"{value:.9g}" for value in values[i : i + 10]) for i in range(0, len(values), 10))

    plain = name.encode("ascii", "replace").decode()
    lines = [
        "IESNA:LM-63-2002",
        f"[LUMINAIRE] {plain}",
        "TILT=NONE",
        f"1 -1 1 {len(gammas)} {len(planes)} 1 2 0 0 0",
        "1 1 0",
        rows(gammas),
        rows(planes),
        *(rows(plane) for plane in candela),
    ]
    return "\n".join(lines) + "\n"
