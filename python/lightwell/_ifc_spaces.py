"""Spaces of a model in IFC as grids over the slabs below them."""

from collections import defaultdict
from typing import Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from ._ifc_model import Model, toml_list
from ._toml import toml_string

LEVEL = 0.01
"""Metres by which faces of one level may differ in height."""


class _Footprint(NamedTuple):
    """The bottom of a space."""

    bottom: float
    """Its height, metres."""
    loops: List[np.ndarray]
    """Closed lines about it and about its holes, each (k, 2), metres."""
    within: np.ndarray
    """(m, 2): a point in each of its triangles, the largest first."""


class Spaces:
    """The spaces that are read, until all surfaces are known."""

    def __init__(self, height: float):
        self.height = height
        self.footprints: List[Tuple[str, _Footprint]] = []

    def add(self, name: str, points: np.ndarray, faces: np.ndarray, model: Model) -> None:
        footprint = _footprint(points, faces)
        if not footprint.loops:
            model.notes.append(f"{name} has no level bottom: its grid covers the box about it.")
            footprint = _box(points)
        self.footprints.append((name, footprint))

    def write(self, model: Model) -> None:
        for name, footprint in self.footprints:
            floor = _floor(footprint, model)
            if floor is None:
                model.notes.append(f"{name} has no grid: no slab or covering lies below it.")
                continue
            for number, (outline, holes) in enumerate(_areas(footprint.loops)):
                part = name if number == 0 else f"{name} part {number + 1}"
                model.grids.append(self._grid(part, floor, footprint.bottom, outline, holes))

    def _grid(self, name: str, floor: str, bottom: float, outline: np.ndarray, holes: List[np.ndarray]) -> str:
        # EN 12464-1 leaves out 15 % of the shorter side along walls, and no more than half a metre.
        margin = min(0.5, 0.15 * float(np.ptp(outline, axis=0).min()))
        lines = [
            "[[grids]]",
            f"name = {toml_string(name)}",
            f"surface = {toml_string('model/' + floor)}",
            f"height = {self.height!r}",
            f"margin = {round(margin, 9)!r}",
            f"outline = {_loop(outline, bottom)}",
        ]
        if holes:
            lines.append(f"holes = [{', '.join(_loop(hole, bottom) for hole in holes)}]")
        return "\n".join(lines)


def _loop(corners: np.ndarray, height: float) -> str:
    return "[" + ", ".join(toml_list([x, y, height]) for x, y in corners) + "]"


def _footprint(points: np.ndarray, faces: np.ndarray) -> _Footprint:
    bottom = float(points[:, 2].min())
    corners = points[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(across, axis=1)
    is_level = (np.abs(corners[:, :, 2] - bottom) < LEVEL).all(axis=1) & (doubled > 0.0)
    level = faces[is_level]
    by_size = np.argsort(-doubled[is_level], kind="stable")
    return _Footprint(bottom, _boundaries(points, level), corners[is_level][by_size].mean(axis=1)[:, :2])


def _box(points: np.ndarray) -> _Footprint:
    low, high = points.min(axis=0), points.max(axis=0)
    loop = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return _Footprint(float(low[2]), [loop], 0.5 * (low + high)[np.newaxis, :2])


def _boundaries(points: np.ndarray, faces: np.ndarray) -> List[np.ndarray]:
    """Loops of the edges that belong to one triangle alone. Places within a micrometre are one."""
    places = {v: (round(points[v][0], 6), round(points[v][1], 6)) for v in np.unique(faces).tolist()}
    edges: Dict[Tuple[float, float], List[Tuple[float, float]]] = defaultdict(list)
    for face in faces.tolist():
        for a, b in zip(face, face[1:] + face[:1]):
            start, end = places[a], places[b]
            if start in edges[end]:
                edges[end].remove(start)
            else:
                edges[start].append(end)
    loops = []
    while start := next((place for place, ends in edges.items() if ends), None):
        loop = [start]
        while edges[loop[-1]]:
            end = edges[loop[-1]].pop()
            if end == start:
                loops.append(_without_straight_corners(np.array(loop)))
                break
            loop.append(end)
    return [loop for loop in loops if len(loop) >= 3]


def _without_straight_corners(loop: np.ndarray) -> np.ndarray:
    """The loop without corners within a micrometre of the line between their neighbours."""
    before, after = np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0)
    along = after - before
    length = np.maximum(np.linalg.norm(along, axis=1), 1e-6)
    to = loop - before
    return loop[np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) > 1e-6 * length]


def _areas(loops: List[np.ndarray]) -> List[Tuple[np.ndarray, List[np.ndarray]]]:
    """Outlines, the largest first, each with its holes."""
    depth = [sum(_holds(other, loop[0]) for other in loops if other is not loop) for loop in loops]
    outer = [loop for loop, level in zip(loops, depth) if level % 2 == 0]
    areas: List[Tuple[np.ndarray, List[np.ndarray]]] = [
        (loop, []) for loop in sorted(outer, key=lambda each: -abs(_area(each)))
    ]
    for loop, level in zip(loops, depth):
        if level % 2 == 1:  # the smallest outline about a hole is its own
            next(holes for outline, holes in reversed(areas) if _holds(outline, loop[0])).append(loop)
    return areas


def _area(loop: np.ndarray) -> float:
    x, y = loop.T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def _holds(loop: np.ndarray, point: np.ndarray) -> bool:
    """True for a point within a loop, by the even-odd rule."""
    a, b = loop, np.roll(loop, -1, axis=0)
    crossed = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    a, b = a[crossed], b[crossed]
    x = a[:, 0] + (point[1] - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return bool((point[0] < x).sum() % 2)


def _floor(footprint: _Footprint, model: Model) -> Optional[str]:
    """The surface with a level face below the footprint, that of its largest part first."""
    for point in footprint.within:
        for surface in model.surfaces:
            corners = surface.vertices[surface.faces]
            level = np.abs(corners[:, :, 2] - footprint.bottom).max(axis=1) < LEVEL
            if any(_holds(triangle[:, :2], point) for triangle in corners[level]):
                return surface.name
    return None
