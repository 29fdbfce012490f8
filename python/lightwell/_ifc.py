"""Models in IFC (ISO 16739) as scene files, read by IfcOpenShell."""

import contextlib
import csv
import fnmatch
import json
import os
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, Optional, Sequence, TextIO, Tuple, Union

import numpy as np

from ._arrays import at_least_zero, real_number
from ._errors import Error, InputError
from ._scene import Scene, read

Path = Union[str, "os.PathLike[str]"]

GREY = 0.5
"""Reflectance of surfaces whose material says nothing."""

NO_SURFACES = ("IfcSpace", "IfcOpeningElement", "IfcVirtualElement", "IfcAnnotation", "IfcGrid")


@dataclass
class _Fixture:
    """A row of the table of fixtures: its pattern, and the keys of `[[lamps]]`."""

    pattern: str
    file: str
    numbers: Dict[str, float]
    is_used: bool = False


@dataclass
class _Surface:
    """Triangles of an element that have one material."""

    name: str
    material: str
    vertices: np.ndarray
    faces: np.ndarray


@dataclass
class _Model:
    surfaces: List[_Surface] = field(default_factory=list)
    materials: Dict[str, Tuple[Sequence[float], float]] = field(default_factory=dict)
    """By name: reflectance of r, g and b, and the share that passes."""
    lamps: List[str] = field(default_factory=list)
    grids: List[str] = field(default_factory=list)
    notes: List[str] = field(default_factory=list)


def from_ifc(
    path: Path,
    output: Path,
    *,
    fixtures: Optional[Path] = None,
    materials: Optional[Path] = None,
    height: float = 0.8,
) -> Scene:
    """Writes a model in IFC as a scene file beside its geometry, and reads the scene. Needs IfcOpenShell.

    path: .ifc, IFC2X3 or IFC4.
    output: .toml to write; the geometry goes into .obj and .mtl files of the same name.
    fixtures: .csv with the columns fixture, a name or pattern of light fixtures or of their types, and
        file, the photometric file relative to the table; lumens, watts and factor where wanted.
    materials: .csv with the columns material, a name or pattern, and reflectance, 0 to 1.
    height: of the plane of each space that reports measure, above its floor, metres.

    Elements are cut by their openings. A material reflects what the table says, else its property
    VisibleReflectanceFront (Pset_MaterialOptical), else the colour of its style, decoded from sRGB.
    Fixtures shine along their own -z from the middle of their underside; C0 runs along their x.

    `Scene.notes` has the notes of `convert_ifc` first. Raises InputError, and Error without
    IfcOpenShell.
    """
    notes = convert_ifc(path, output, fixtures=fixtures, materials=materials, height=height)
    scene = read(output)
    scene._first_notes = notes
    return scene


def convert_ifc(
    path: Path,
    output: Path,
    *,
    fixtures: Optional[Path] = None,
    materials: Optional[Path] = None,
    height: float = 0.8,
) -> List[str]:
    """Writes the files of `from_ifc`, without reading them.

    Returns what is assumed or left out, a sentence each. Arguments and errors: those of `from_ifc`.
    """
    if os.path.splitext(os.fspath(output))[1] != ".toml":
        raise InputError(f"'{os.fspath(output)}' must end in .toml")
    plane = at_least_zero("height", height)
    table = [] if fixtures is None else _read_fixtures(os.fspath(fixtures), os.path.dirname(os.fspath(output)))
    reflectances = {} if materials is None else _read_reflectances(os.fspath(materials))
    model = _read_model(os.fspath(path), table, reflectances, plane)
    if not model.surfaces:
        raise InputError(f"{os.fspath(path)}: no element has a surface; a model with walls and slabs is needed")
    _write(model, os.fspath(output), os.path.basename(os.fspath(path)))
    return model.notes


def _read_table(path: str, needed: Sequence[str]) -> List[Dict[str, str]]:
    """Rows of a CSV file with a header line."""
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            rows = csv.DictReader(file, skipinitialspace=True)
            missing = [name for name in needed if name not in (rows.fieldnames or [])]
            if missing:
                raise InputError(
                    f"{path}:1: there is no column '{missing[0]}'; the columns {', '.join(needed)} are needed"
                )
            found = []
            for row in rows:
                if not all(row.get(name) for name in needed):
                    raise InputError(f"{path}:{rows.line_num}: a line needs {' and '.join(needed)}")
                found.append({str(key): value or "" for key, value in row.items()})
            return found
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None


def _read_fixtures(path: str, folder: str) -> List[_Fixture]:
    """The table of fixtures, with files relative to `folder`."""
    found = []
    known = ("lumens", "watts", "factor")
    for line, row in enumerate(_read_table(path, ("fixture", "file")), start=2):
        unknown = set(row) - {"fixture", "file", *known}
        if unknown:
            raise InputError(f"{path}:1: there is no column '{sorted(unknown)[0]}'; {', '.join(known)} are known")
        file = os.path.join(os.path.dirname(path), row["file"])
        if not os.path.isfile(file):
            raise InputError(f"{path}:{line}: there is no file '{file}'; name a photometric file beside the table")
        numbers = {key: real_number(f"{path}:{line}: {key}", row[key]) for key in known if row.get(key)}
        found.append(_Fixture(row["fixture"], os.path.relpath(file, folder or "."), numbers))
    return found


def _read_reflectances(path: str) -> Dict[str, float]:
    found = {}
    for line, row in enumerate(_read_table(path, ("material", "reflectance")), start=2):
        rho = real_number(f"{path}:{line}: reflectance", row["reflectance"])
        if not 0.0 <= rho <= 1.0:
            raise InputError(f"{path}:{line}: reflectance is {rho:g}; a number from 0 to 1 is needed")
        found[row["material"]] = rho
    return found


def _read_model(path: str, fixtures: List[_Fixture], reflectances: Dict[str, float], height: float) -> _Model:
    try:
        import ifcopenshell  # type: ignore
    except ImportError:
        raise Error(
            "IFC is read by IfcOpenShell, which is not installed: pip install 'lightwell[ifc]'"
        ) from None
    if not os.path.isfile(path):
        raise InputError(f"{path}: there is no such file")
    try:
        file: Any = ifcopenshell.open(path)
        products = file.by_type("IfcProduct")
    except Exception as error:
        raise InputError(f"{path}: this is no IFC file that IfcOpenShell {ifcopenshell.version} reads: {error}") from None
    model = _Model()
    spaces = _Spaces(height)
    for shape in _shapes(file, products, model):
        element = file.by_id(shape.id)
        if element.is_a("IfcSpace"):
            spaces.add(_name(element), _points(shape.geometry.verts))
        elif _is_fixture(element):
            _add_lamp(element, _points(shape.geometry.verts), fixtures, model)
        else:
            _add_surfaces(element, shape, reflectances, model)
    for element in products:
        if element.Representation is None and _is_fixture(element):
            _add_lamp(element, np.zeros((0, 3)), fixtures, model)
    spaces.write(model)
    model.notes += [
        f"{fixture.pattern}: no light fixture of the model fits this line of the table."
        for fixture in fixtures
        if not fixture.is_used
    ]
    return model


def _shapes(file: Any, products: Sequence[Any], model: _Model) -> Any:
    """Triangles of all elements, in world coordinates and metres, ordered by their number."""
    import ifcopenshell.geom  # type: ignore

    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("weld-vertices", True)
    settings.set("apply-default-materials", False)
    hidden = [name for name in NO_SURFACES if name != "IfcSpace"]
    wanted = [
        element
        for element in products
        if element.Representation is not None and not any(_is_a(element, name) for name in hidden)
    ]
    for element in sorted(wanted, key=lambda each: int(each.id())):
        try:
            yield ifcopenshell.geom.create_shape(settings, element)
        except RuntimeError as error:
            model.notes.append(f"{_name(element)} is left out: IfcOpenShell makes no shape of it ({error}).")


def _is_a(element: Any, name: str) -> bool:
    """False for classes that the file's schema does not have."""
    try:
        return bool(element.is_a(name))
    except RuntimeError:
        return False


def _is_fixture(element: Any) -> bool:
    """True for light fixtures, which IFC2X3 knows by their type alone."""
    from ifcopenshell.util.element import get_type  # type: ignore

    if _is_a(element, "IfcLightFixture"):
        return True
    kind: Any = get_type(element) if element.is_a("IfcFlowTerminal") else None
    return kind is not None and bool(kind.is_a("IfcLightFixtureType"))


def _points(numbers: Sequence[float]) -> np.ndarray:
    return np.array(numbers, dtype=np.float64).reshape(-1, 3)


def _name(element: Any) -> str:
    """A name that no other element has, on one line."""
    return " ".join(f"{element.Name or element.is_a()} ({element.id()})".replace("#", "").split())


def _add_surfaces(element: Any, shape: Any, reflectances: Dict[str, float], model: _Model) -> None:
    geometry = shape.geometry
    vertices, faces = _points(geometry.verts), np.array(geometry.faces, dtype=np.int64).reshape(-1, 3)
    owner = np.array(geometry.material_ids, dtype=np.int64)
    styles = list(geometry.materials)
    for number in np.unique(owner) if len(owner) else []:
        style = styles[number] if number >= 0 else None
        material = _material(element, style, reflectances, model)
        part = faces[owner == number]
        suffix = "" if len(styles) < 2 else f" {material}"
        model.surfaces.append(_Surface(_name(element) + suffix, material, vertices, part))


def _material(element: Any, style: Any, reflectances: Dict[str, float], model: _Model) -> str:
    """The name of the material of a style on an element, which is added to the model."""
    from ifcopenshell.util.element import get_material, get_psets

    of_element = get_material(element, should_skip_usage=True)
    named = getattr(of_element, "Name", None) or getattr(of_element, "LayerSetName", None)
    styled = None if style is None else _style_name(element.file, style)
    names = [" ".join(name.split()) for name in (named, styled) if name]
    for pattern, rho in reflectances.items():
        for name in names:
            if fnmatch.fnmatchcase(name, pattern):
                return _keep(model, name, [rho] * 3, _transparency(style))
    optical = {} if of_element is None else get_psets(of_element).get("Pset_MaterialOptical", {})
    front = optical.get("VisibleReflectanceFront")
    if front is not None and 0.0 <= float(front) <= 1.0:
        return _keep(model, str(named), [float(front)] * 3, _transparency(style))
    if style is not None:
        colour = [_linear(value) for value in style.diffuse.components]
        return _keep(model, styled or "style", colour, _transparency(style))
    note = f"{element.is_a()} without colour or reflectance: a reflectance of {GREY} is assumed."
    if note not in model.notes:
        model.notes.append(note)
    return _keep(model, named or "grey", [GREY] * 3, 0.0)


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


def _keep(model: _Model, name: str, reflectance: Sequence[float], passed: float) -> str:
    """The name under which the model has this material."""
    made = ([round(float(value), 6) for value in reflectance], round(passed, 6))
    name = " ".join(name.replace("#", "").split())
    free, number = name, 2
    while model.materials.setdefault(free, made) != made:
        free, number = f"{name} {number}", number + 1
    return free


def _add_lamp(element: Any, points: np.ndarray, fixtures: List[_Fixture], model: _Model) -> None:
    from ifcopenshell.util.element import get_type
    from ifcopenshell.util.placement import get_local_placement  # type: ignore
    from ifcopenshell.util.unit import calculate_unit_scale  # type: ignore

    kind = get_type(element)
    names = [name for name in (element.Name, getattr(kind, "Name", None)) if name]
    chosen = next((f for f in fixtures for name in names if fnmatch.fnmatchcase(name, f.pattern)), None)
    if chosen is None:
        model.notes.append(f"{_name(element)} gives no light: no line of the table of fixtures names it.")
        return
    chosen.is_used = True
    matrix = np.array(get_local_placement(element.ObjectPlacement), dtype=np.float64)
    turn, origin = matrix[:3, :3], matrix[:3, 3] * calculate_unit_scale(element.file)
    if len(points):
        local = (points - origin) @ turn
        low, high = local.min(axis=0), local.max(axis=0)
        origin = origin + turn @ np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]])
    lines = [
        "[[lamps]]",
        f"name = {_text(_name(element))}",
        f"file = {_text(chosen.file.replace(os.sep, '/'))}",
        f"position = {_list(origin)}",
        f"aim = {_list(-turn[:, 2])}",
        f"c0 = {_list(turn[:, 0])}",
    ]
    model.lamps.append("\n".join(lines + [f"{key} = {value!r}" for key, value in chosen.numbers.items()]))


class _Spaces:
    """Spaces as grids over the slabs below them."""

    def __init__(self, height: float):
        self.height = height
        self.names: List[str] = []
        self.boxes: List[Tuple[np.ndarray, np.ndarray]] = []

    def add(self, name: str, points: np.ndarray) -> None:
        self.names.append(name)
        self.boxes.append((points.min(axis=0), points.max(axis=0)))

    def write(self, model: _Model) -> None:
        for name, (low, high) in zip(self.names, self.boxes):
            floor = self._floor(low, high, model)
            if floor is None:
                model.notes.append(f"{name} has no grid: no slab or covering lies below it.")
                continue
            # EN 12464-1 leaves out 15 % of the shorter side along walls, and no more than half a metre.
            margin = min(0.5, 0.15 * float((high - low)[:2].min()))
            inner = [low + margin, high - margin]
            box = f"{{ min = {_list([*inner[0][:2], low[2] - 0.01])}, max = {_list([*inner[1][:2], low[2] + 0.01])} }}"
            model.grids.append(
                f"[[grids]]\nname = {_text(name)}\nsurface = {_text('model/' + floor)}\n"
                f"height = {self.height!r}\nmargin = 0.0\npart = {box}"
            )

    def _floor(self, low: np.ndarray, high: np.ndarray, model: _Model) -> Optional[str]:
        """The surface with a level face at the bottom of the box that covers its middle."""
        middle = 0.5 * (low + high)
        for surface in model.surfaces:
            corners = surface.vertices[surface.faces]
            level = np.abs(corners[:, :, 2] - low[2]).max(axis=1) < 0.01
            for triangle in corners[level]:
                if _is_inside(triangle[:, :2], middle[:2]):
                    return surface.name
        return None


def _is_inside(triangle: np.ndarray, point: np.ndarray) -> bool:
    after = np.roll(triangle, -1, axis=0)
    edge, to = after - triangle, point - triangle
    sides = edge[:, 0] * to[:, 1] - edge[:, 1] * to[:, 0]
    return bool((sides >= 0.0).all() or (sides <= 0.0).all())


def _list(values: Any) -> str:
    return "[" + ", ".join(repr(round(float(value), 9) + 0.0) for value in values) + "]"


def _text(value: str) -> str:
    """A string of TOML, which has JSON's escapes but for pairs of surrogates."""
    return json.dumps(value, ensure_ascii=False)


def _write(model: _Model, output: str, source: str) -> None:
    """Writes the scene last, so that a scene never lacks its geometry."""
    stem = os.path.splitext(os.path.basename(output))[0]
    base = os.path.splitext(output)[0]
    with _whole_file(base + ".mtl") as file:
        for name, (reflectance, _) in model.materials.items():
            file.write(f"newmtl {name}\nKd {' '.join(map(repr, reflectance))}\n")
    with _whole_file(base + ".obj") as file:
        file.write(f"mtllib {stem}.mtl\n")
        _write_mesh(model, file)
    parts = [f"# Made from {source}, an IFC model.", 'unit = "m"']
    for name, (reflectance, passed) in model.materials.items():
        # A pane has two faces, which light passes one after the other.
        share = passed**0.5
        lines = [f"[materials.{_text(name)}]", f"reflectance = {_list((1.0 - share) * np.array(reflectance))}"]
        if share > 0.0:
            lines.append(f"transparent = {round(share, 9)!r}")
        parts.append("\n".join(lines))
    parts.append(f"[[surfaces]]\nname = \"model\"\nmesh = {_text(stem + '.obj')}")
    with _whole_file(output) as file:
        file.write("\n\n".join(parts + model.lamps + model.grids) + "\n")


@contextlib.contextmanager
def _whole_file(path: str) -> Iterator[TextIO]:
    """A text file that takes the place of `path` once it is whole."""
    part = path + ".part"
    try:
        with open(part, "w", encoding="utf-8", newline="\n") as file:
            yield file
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: cannot be written: {error}") from None
    finally:
        with contextlib.suppress(OSError):
            os.remove(part)


def _write_mesh(model: _Model, file: TextIO) -> None:
    first = 1
    for surface in model.surfaces:
        used, faces = np.unique(surface.faces, return_inverse=True)
        file.write(f"o {surface.name}\nusemtl {surface.material}\n")
        for point in surface.vertices[used]:
            file.write("v " + " ".join(repr(round(float(value), 9) + 0.0) for value in point) + "\n")
        for face in faces.reshape(-1, 3) + first:
            file.write("f " + " ".join(str(number) for number in face) + "\n")
        first += len(used)
