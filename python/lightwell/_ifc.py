"""Models in IFC (ISO 16739) as scene files, read by IfcOpenShell."""

import csv
import os
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np

from ._arrays import at_least_zero, real_number
from ._errors import Error, InputError
from ._ifc_lamps import Fixtures, is_fixture
from ._ifc_materials import Optics, add_surfaces
from ._ifc_model import Fixture, Model, element_name, is_a, points_of_shape, write_model
from ._ifc_spaces import Spaces
from ._scene import Scene, read

Path = Union[str, "os.PathLike[str]"]

NO_SURFACES = ("IfcOpeningElement", "IfcVirtualElement", "IfcAnnotation", "IfcGrid")


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
    materials: .csv with the columns material, a name or pattern of materials, of styles, or of the class of
        elements that have neither; reflectance, 0 to 1; and transmittance of a whole pane where wanted.
    height: of the plane of each space that reports measure, above its floor, metres.

    Elements are cut by their openings. A material reflects what the table says, else its property
    VisibleReflectanceFront (Pset_MaterialOptical), else the colour of its style, decoded from sRGB.
    Glass passes what the table, VisibleLightTransmittance (Pset_DoorWindowGlazingType) or
    VisibleTransmittance says, else the transparency of its style.
    Fixtures shine along their own -z from the middle of their underside; C0 runs along their x. Those that
    no line of the table names have the light of their own goniometric light sources.
    Grids cover the bottoms of spaces, without half a metre along their edges.

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
    optics = {} if materials is None else _read_optics(os.fspath(materials))
    fitted = Fixtures(table, os.path.dirname(os.fspath(path)), os.fspath(output))
    model = _read_model(os.fspath(path), fitted, optics, plane)
    if not model.surfaces:
        raise InputError(f"{os.fspath(path)}: no element has a surface; a model with walls and slabs is needed")
    write_model(model, os.fspath(output), os.path.basename(os.fspath(path)))
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


def _read_fixtures(path: str, folder: str) -> List[Fixture]:
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
        found.append(Fixture(row["fixture"], os.path.relpath(file, folder or "."), numbers))
    return found


def _read_optics(path: str) -> Dict[str, Optics]:
    """The table of materials."""
    found = {}
    for line, row in enumerate(_read_table(path, ("material", "reflectance")), start=2):
        shares = {}
        for key in ("reflectance", "transmittance"):
            if not row.get(key):
                continue
            shares[key] = real_number(f"{path}:{line}: {key}", row[key])
            if not 0.0 <= shares[key] <= 1.0:
                raise InputError(f"{path}:{line}: {key} is {shares[key]:g}; a number from 0 to 1 is needed")
        if sum(shares.values()) > 1.0:
            raise InputError(f"{path}:{line}: reflectance and transmittance exceed 1 together; give smaller ones")
        found[row["material"]] = Optics(shares["reflectance"], shares.get("transmittance"))
    return found


def _read_model(path: str, fixtures: Fixtures, optics: Dict[str, Optics], height: float) -> Model:
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
    model = Model()
    spaces = Spaces(height)
    for element, shape in _shapes(products, model):
        points = np.zeros((0, 3)) if shape is None else points_of_shape(shape.geometry.verts)
        if is_fixture(element):
            fixtures.add(element, points, model)
        elif element.is_a("IfcSpace"):
            faces = np.array(shape.geometry.faces, dtype=np.int64).reshape(-1, 3)
            spaces.add(element_name(element), points, faces, model)
        else:
            add_surfaces(element, shape, optics, model)
    spaces.write(model)
    model.notes += [
        f"{fixture.pattern}: no light fixture of the model fits this line of the table."
        for fixture in fixtures.table
        if not fixture.is_used
    ]
    return model


def _shapes(products: Sequence[Any], model: Model) -> Iterator[Tuple[Any, Any]]:
    """Elements with their triangles, in world coordinates and metres, ordered by their number.

    Fixtures may have none, and a shape of None.
    """
    import ifcopenshell.geom  # type: ignore

    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("weld-vertices", True)
    settings.set("apply-default-materials", False)
    for element in sorted(products, key=lambda each: int(each.id())):
        if any(is_a(element, name) for name in NO_SURFACES):
            continue
        shape, problem = None, ""
        if element.Representation is not None:
            try:
                shape = ifcopenshell.geom.create_shape(settings, element)
            except RuntimeError as error:
                problem = str(error)
        if shape is not None or is_fixture(element):
            yield element, shape
        elif problem:
            model.notes.append(f"{element_name(element)} is left out: IfcOpenShell makes no shape of it ({problem}).")
