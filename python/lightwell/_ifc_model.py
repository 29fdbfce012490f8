"""What is read from a model in IFC, and the files that hold it."""

import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, NamedTuple, Sequence, TextIO

import numpy as np

from ._toml import toml_string, whole_file


@dataclass
class Fixture:
    """A row of the table of fixtures: its pattern, and the keys of `[[lamps]]`."""

    pattern: str
    file: str
    numbers: Dict[str, float]
    is_used: bool = False


@dataclass
class Surface:
    """Triangles of an element that have one material."""

    name: str
    material: str
    vertices: np.ndarray
    faces: np.ndarray


class FaceOptics(NamedTuple):
    """A material, of each face of the elements that it is on."""

    reflectance: List[float]
    """Of r, g and b, 0 to 1."""
    transparent: float
    """The share that passes straight on, 0 to 1."""


@dataclass
class Model:
    """What the files hold. Lamps and grids are tables of the scene format."""

    surfaces: List[Surface] = field(default_factory=list)
    materials: Dict[str, FaceOptics] = field(default_factory=dict)
    photometry: Dict[str, str] = field(default_factory=dict)
    """Text of photometric files to be written beside the scene, by the end of their names."""
    lamps: List[str] = field(default_factory=list)
    grids: List[str] = field(default_factory=list)
    notes: List[str] = field(default_factory=list)


def is_a(element: Any, name: str) -> bool:
    """False for classes that the file's schema does not have."""
    try:
        return bool(element.is_a(name))
    except RuntimeError:
        return False


def points_of_shape(numbers: Sequence[float]) -> np.ndarray:
    return np.array(numbers, dtype=np.float64).reshape(-1, 3)


def element_name(element: Any) -> str:
    """A name that no other element has, on one line."""
    return " ".join(f"{element.Name or element.is_a()} ({element.id()})".replace("#", "").split())


def toml_list(values: Any) -> str:
    return "[" + ", ".join(repr(round(float(value), 9) + 0.0) for value in values) + "]"


def write_model(model: Model, output: str, source: str) -> None:
    """Writes the scene last, so that a scene never lacks its geometry."""
    stem = os.path.splitext(os.path.basename(output))[0]
    base = os.path.splitext(output)[0]
    for name, text in model.photometry.items():
        with whole_file(f"{base}-{name}") as file:
            file.write(text)
    with whole_file(base + ".mtl") as file:
        for name, optics in model.materials.items():
            file.write(f"newmtl {name}\nKd {' '.join(map(repr, optics.reflectance))}\n")
    with whole_file(base + ".obj") as file:
        file.write(f"mtllib {stem}.mtl\n")
        _write_mesh(model, file)
    parts = [f"# Made from {source}, an IFC model.", 'unit = "m"']
    for name, optics in model.materials.items():
        lines = [f"[materials.{toml_string(name)}]", f"reflectance = {toml_list(optics.reflectance)}"]
        if optics.transparent > 0.0:
            lines.append(f"transparent = {optics.transparent!r}")
        parts.append("\n".join(lines))
    parts.append(f"[[surfaces]]\nname = \"model\"\nmesh = {toml_string(stem + '.obj')}")
    with whole_file(output) as file:
        file.write("\n\n".join(parts + model.lamps + model.grids) + "\n")


def _write_mesh(model: Model, file: TextIO) -> None:
    first = 1
    for surface in model.surfaces:
        used, faces = np.unique(surface.faces, return_inverse=True)
        file.write(f"o {surface.name}\nusemtl {surface.material}\n")
        for point in surface.vertices[used]:
            file.write("v " + " ".join(repr(round(float(value), 9) + 0.0) for value in point) + "\n")
        for face in faces.reshape(-1, 3) + first:
            file.write("f " + " ".join(str(number) for number in face) + "\n")
        first += len(used)
