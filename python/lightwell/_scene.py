"""Scenes: surfaces with materials, cameras and light."""

import os
from typing import Any, Callable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _lightwell
from ._arrays import array_of, checked_progress, faces_of, integers_of, points_of
from ._camera import Camera, camera_of
from ._errors import InputError
from ._material import Material, material_of, materials_of
from ._toml import mapping_of, mappings_of, toml_text, whole_file

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[str, float], Optional[bool]]
Table = Mapping[str, Any]
"""Keys and values of a table of the scene format."""


def fixed(array: np.ndarray) -> np.ndarray:
    """The array, which is read-only from now on."""
    array.setflags(write=False)
    return array


class Scene:
    """A room and its contents. Made by `read`, `Scene.from_arrays` or `Scene.from_tables`; never changed."""

    def __init__(self, data: "_lightwell.SceneData"):
        if not isinstance(data, _lightwell.SceneData):
            raise InputError(
                "a Scene is made by lightwell.read(path), lightwell.Scene.from_arrays(vertices, faces) or "
                "lightwell.Scene.from_tables(tables)"
            )
        self._data = data
        self._first_notes: List[str] = []
        self._tables: Optional[Tuple[str, str]] = None  # text and folder
        self._triangles: Optional[Tuple[np.ndarray, np.ndarray, np.ndarray]] = None

    @classmethod
    def from_arrays(
        cls,
        vertices: Any,
        faces: Any,
        *,
        surface: Any = None,
        names: Optional[Sequence[str]] = None,
        materials: Union[Material, Table, Sequence[Union[Material, Table]], None] = None,
        reflectance: Any = None,
        emission: Any = None,
        uv: Any = None,
        normals: Any = None,
        cameras: Union[Camera, Sequence[Camera]] = (),
        lamps: Union[Table, Sequence[Table]] = (),
        sky: Optional[Table] = None,
        grids: Union[Table, Sequence[Table]] = (),
        tables: Table = {},
        folder: Path = ".",
        title: str = "",
    ) -> "Scene":
        """A scene of polygons.

        vertices: (n, 3), metres.
        faces: (m, k) integers, or a list of m lists of three and more: vertex numbers from 0,
            counter-clockwise seen from the front.
        surface: (m,) integers from 0, the surface that each face belongs to. None: all faces are one
            surface, or each is its own where the arguments below have m entries.
        names: a name for each surface.
        materials: a Material for each surface, or one for all; or dictionaries with a `name` and the keys
            of [materials.NAME] of the scene format: textures, glass, coats, lumens.
        reflectance: diffuse reflectance, 0 to 1: one for all, (s,) one for each surface, or (s, 3).
            Comes before that of the materials.
        emission: exitance, W/m^2: likewise.
        uv: (n, 2), texture coordinates of the vertices; (0, 0) is a picture's top left corner.
        normals: (n, 3), of any length, at the vertices: faces are smooth in pictures.
        cameras: cameras for pictures.
        lamps, grids: dictionaries with the keys of [[lamps]] and [[grids]] of the scene format, metres.
        sky: a dictionary with the keys of [sky].
        tables: other tables by their names: areas, maintenance, energy, report, motions, windows.
        folder: where photometric files and pictures that are named lie.

        Faces that are not flat are cut, and those without area left out; `notes` says so.

        Raises InputError for arrays of the wrong shape or type, coordinates that are not finite,
        vertex numbers out of range, materials that would create energy, and keys that are not known.
        """
        points = points_of("vertices", vertices)
        corners, first = faces_of(faces)
        count = len(first) - 1
        each = (names, materials, reflectance, emission)
        owner, surfaces = _owners(surface, count, max(_length(values) for values in each))
        made = materials_of(surfaces, materials, reflectance, emission)
        listed = _lightwell.SurfaceList()
        listed.names = _names(surfaces, names)
        listed.materials = [made_of._compiled() for made_of in made.compiled]
        listed.named_materials = made.named
        unknown = set(tables) - {"areas", "maintenance", "energy", "report", "motions", "windows"}
        if unknown:
            raise InputError(
                f"tables has '{sorted(map(str, unknown))[0]}', which from_arrays takes as an argument, or not at all"
            )
        document = {
            "title": str(title),
            "materials": made.tables or None,
            "cameras": [view._table() for view in _cameras(cameras)] or None,
            "lamps": mappings_of("lamps", lamps) or None,
            "sky": None if sky is None else mapping_of("sky", sky),
            "grids": mappings_of("grids", grids) or None,
            **tables,
        }
        return cls(
            _lightwell.from_arrays(
                listed, _text(document, folder, False), points, corners, first, owner,
                _at_vertices("uv", uv, len(points), 2), _at_vertices("normals", normals, len(points), 3),
            )
        )

    @classmethod
    def from_tables(cls, tables: Table, *, folder: Path = ".", inside_folder: bool = False) -> "Scene":
        """A scene of the tables of a scene file (docs/scene-format.md), without the file.

        tables: by name: materials, surfaces, lamps, sky, cameras, grids and all others, with the keys and
            units of the format. Arrays of NumPy may stand for lists: {"polygons": vertices[faces]} is the
            surface of (m, k, 3) corners. Materials and cameras may be `Material` and `Camera`.
        folder: where meshes, photometric files, pictures and spectra that are named lie.
        inside_folder: refuse references to files outside of the folder.

        Raises InputError that names the table, the key and what to do.
        """
        document = dict(mapping_of("tables", tables))
        materials = mapping_of("materials", document.get("materials", {}))
        document["materials"] = {
            name: made._table() if isinstance(made, Material) else made for name, made in materials.items()
        }
        views = document.get("cameras", ())
        listed = list(views) if isinstance(views, (list, tuple)) else [views]
        if document.get("unit", "m") != "m" and any(isinstance(view, Camera) for view in listed):
            raise InputError("a lightwell.Camera has metres, and these tables another unit; give its table instead")
        document["cameras"] = [view._table() if isinstance(view, Camera) else view for view in listed]
        text = _text(document, folder, bool(inside_folder))
        scene = cls(_lightwell.from_tables(text))
        scene._tables = text.text, os.path.abspath(os.fspath(folder))
        return scene

    def save(self, path: Path) -> None:
        """Writes the tables of a scene of `from_tables` as a scene file (.toml), which the command line reads.

        Files that the tables name are relative to their `folder`, which the file has to lie in.
        """
        target = os.path.abspath(os.fspath(path))
        if os.path.splitext(target)[1] != ".toml":
            raise InputError(f"'{os.fspath(path)}' must end in .toml")
        if self._tables is None:
            raise InputError("only a scene of from_tables can be saved, since it has all tables of a file")
        text, folder = self._tables
        if os.path.dirname(target) != folder:
            raise InputError(f"the tables name files relative to '{folder}'; save the scene there")
        with whole_file(target) as file:
            file.write(text)

    @classmethod
    def from_trimesh(cls, mesh: Any, **options: Any) -> "Scene":
        """A scene of a `trimesh.Trimesh`, or of anything with `vertices` (n, 3) and `faces` (m, 3).

        options: those of `from_arrays`.
        """
        return cls.from_arrays(np.asarray(mesh.vertices), np.asarray(mesh.faces), **options)

    @classmethod
    def from_pyvista(cls, mesh: Any, **options: Any) -> "Scene":
        """A scene of a `pyvista.PolyData`.

        options: those of `from_arrays`.
        """
        flat = np.asarray(mesh.faces)
        faces, at = [], 0
        while at < len(flat):
            faces.append(flat[at + 1 : at + 1 + flat[at]])
            at += 1 + int(flat[at])
        return cls.from_arrays(np.asarray(mesh.points), faces, **options)

    def to_trimesh(self) -> Any:
        """The triangles as a `trimesh.Trimesh`; face attribute `surface`. Needs trimesh."""
        import trimesh  # type: ignore

        mesh = trimesh.Trimesh(self.vertices.copy(), self.faces.copy(), process=False)
        mesh.face_attributes["surface"] = self.surface.copy()
        return mesh

    def to_pyvista(self) -> Any:
        """The triangles as a `pyvista.PolyData`; cell data `surface`. Needs pyvista."""
        import pyvista  # type: ignore

        faces = np.column_stack([np.full(len(self.faces), 3), self.faces])
        mesh = pyvista.PolyData(np.array(self.vertices), faces.reshape(-1))
        mesh.cell_data["surface"] = self.surface.copy()
        return mesh

    def _geometry(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        if self._triangles is None:
            vertices, faces, surface = self._data.triangles()
            self._triangles = fixed(vertices), fixed(faces), fixed(surface)
        return self._triangles

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) float64, metres: corners of `faces`, not shared between them."""
        return self._geometry()[0]

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int32: the surfaces as triangles, counter-clockwise seen from the front.

        Polygons are triangulated, and exact round shapes become 32 facets around.
        """
        return self._geometry()[1]

    @property
    def surface(self) -> np.ndarray:
        """(m,) int32: the surface that each of `faces` belongs to, an index into `names`."""
        return self._geometry()[2]

    @property
    def names(self) -> List[str]:
        """Names of the surfaces."""
        return self._data.names

    @property
    def areas(self) -> np.ndarray:
        """Area of each surface, one side, m^2."""
        return np.array(self._data.areas)

    @property
    def materials(self) -> List[Material]:
        """The material of each surface, without textures, coats, metals and glass."""
        return [material_of(material) for material in self._data.materials]

    @property
    def lamps(self) -> List[str]:
        """Names of the lamps that are no surfaces."""
        return self._data.lamps

    @property
    def cameras(self) -> List[Camera]:
        return [camera_of(camera, self._data.motions) for camera in self._data.cameras]

    @property
    def bands(self) -> List[str]:
        """Names of the spectral bands, the columns of all arrays of light."""
        return self._data.bands

    @property
    def file(self) -> str:
        """The file that was read; "" for a scene from arrays."""
        return self._data.file

    @property
    def title(self) -> str:
        return self._data.title

    @property
    def metres_per_unit(self) -> float:
        """Length unit of the file. Coordinates here are metres already."""
        return self._data.metres_per_unit

    @property
    def relative_units(self) -> bool:
        """True if the unit of light is unknown: values of light then compare with each other alone."""
        return self._data.relative_units

    @property
    def notes(self) -> List[str]:
        """Assumptions, repairs and omissions, a sentence each."""
        return self._first_notes + self._data.notes

    @property
    def losses(self) -> List[str]:
        """Those notes by which something of the input is lost."""
        return self._data.losses

    def __repr__(self) -> str:
        of = f"'{os.path.basename(self.file)}'" if self.file else "from arrays"
        parts = [f"{len(self.names)} surfaces"]
        if self.lamps:
            parts.append(f"{len(self.lamps)} lamps")
        parts.append(f"{len(self._data.cameras)} cameras")
        parts.append(f"{self.areas.sum():.6g} m^2")
        if not self._data.gives_light:
            parts.append("no light")
        if self.losses:
            parts.append(f"{len(self.losses)} losses")
        return f"<lightwell.Scene {of}: {', '.join(parts)}>"


def read(
    path: Union[str, "os.PathLike[str]"],
    *,
    inside_folder: bool = False,
    strict: bool = False,
    progress: Optional[Progress] = None,
) -> Scene:
    """Reads a scene: .toml, .obj, .ply, .stl, .gltf, .glb, .dae, .fbx, .xml, .rad, .rif, .mgf, .pov,
    .hbjson, .stf or .vs3.

    inside_folder: refuse references to files outside of the scene's folder.
    strict: raise InputError if anything of the file is left out, approximated or missing.
    progress: called with the phase and the share done; False stops the work.

    Raises InputError with file, line or object, and what to do. Reading itself cannot be stopped.
    """
    scene = Scene(_lightwell.read(os.fspath(path), bool(inside_folder), checked_progress(progress)))
    if strict and scene.losses:
        raise InputError(
            f"{scene.file}: not all of the scene can be used, and strict makes that an error:\n  "
            + "\n  ".join(scene.losses)
        )
    return scene


def _text(document: Table, folder: Path, inside_folder: bool) -> "_lightwell.SceneText":
    return _lightwell.SceneText(toml_text(document), os.fspath(folder), inside_folder)


def _cameras(cameras: Any) -> List[Camera]:
    views = [cameras] if isinstance(cameras, Camera) else list(cameras)
    if not all(isinstance(view, Camera) for view in views):
        raise InputError("cameras must be a list of lightwell.Camera")
    return views


def _at_vertices(name: str, values: Any, vertices: int, count: int) -> np.ndarray:
    """`count` numbers at each vertex; none for None."""
    if values is None:
        return np.zeros((0, count))
    array = array_of(name, values)
    if array.shape != (vertices, count):
        raise InputError(f"{name} has the shape {array.shape}; ({vertices}, {count}), a row for each vertex, is needed")
    if not np.isfinite(array).all():
        raise InputError(f"{name} has a number that is not finite")
    return np.ascontiguousarray(array, dtype=np.float64)


def _owners(surface: Any, faces: int, given: int) -> Tuple[np.ndarray, int]:
    """The surface of each face, and the number of surfaces; `given`: most values of any argument."""
    if surface is None:
        surfaces = faces if faces > 1 and given == faces else 1
        return np.arange(faces, dtype=np.int32) if surfaces > 1 else np.zeros(faces, np.int32), surfaces
    owner = integers_of("surface", surface)
    if len(owner) != faces:
        raise InputError(f"surface has {len(owner)} entries for {faces} faces; give one each")
    surfaces = int(owner.max()) + 1 if faces else 0
    if surfaces > max(faces, given):
        raise InputError(
            f"surface has the number {surfaces - 1}, but {faces} faces make {faces} surfaces at most; "
            "number them from 0"
        )
    return owner, surfaces


def _length(values: Any) -> int:
    if values is None or isinstance(values, (str, Material, Mapping)) or np.ndim(values) == 0:
        return -1
    return len(values)


def _names(surfaces: int, names: Optional[Sequence[str]]) -> List[str]:
    if names is None:
        return [f"surface {number}" for number in range(surfaces)]
    given = [names] if isinstance(names, str) else [str(name) for name in names]
    if len(given) != surfaces:
        raise InputError(f"names has {len(given)} entries for {surfaces} surfaces; give one each")
    return given
