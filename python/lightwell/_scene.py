"""Scenes: surfaces with materials, cameras and light."""

import os
from dataclasses import dataclass, replace
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _lightwell
from ._arrays import checked_progress, faces_of, integers_of, points_of, real_number, whole_number
from ._errors import InputError

Progress = Callable[[str, float], Optional[bool]]
Values = Union[float, Sequence[float]]
"""One value for all bands, or one each for red, green and blue."""


def fixed(array: np.ndarray) -> np.ndarray:
    """The array, which is read-only from now on."""
    array.setflags(write=False)
    return array


def _values(name: str, values: Any) -> List[float]:
    if np.ndim(values) == 0:
        return [real_number(name, values)]
    return [real_number(name, value) for value in values]


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


@dataclass(frozen=True)
class Camera:
    """A place to look from. Lengths in metres, angles in degrees, sizes in pixels."""

    position: Sequence[float]
    target: Sequence[float]
    """A point that is seen in the middle of the picture."""
    up: Sequence[float] = (0.0, 0.0, 1.0)
    """The direction that is upwards in the picture."""
    fov: Optional[float] = None
    """Full horizontal angle; None: the usual one of the projection, 40 for perspective."""
    width: int = 512
    height: int = 512
    projection: str = "perspective"
    name: str = "camera"
    shift: Sequence[float] = (0.0, 0.0)
    """Shift of the lens to the right and upwards, in shares of the picture's width and height."""
    distortion: Sequence[float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    """Coefficients k1, k2, k3, p1, p2 of Brown's lens distortion, of perspective cameras."""

    def _compiled(self) -> "_lightwell.Camera":
        view = _lightwell.View()
        view.name = str(self.name)
        view.position = _values("position", self.position)
        view.target = _values("target", self.target)
        view.up = _values("up", self.up)
        view.fov_degrees = None if self.fov is None else real_number("fov", self.fov)
        view.width = whole_number("width", self.width, 1, 32768)
        view.height = whole_number("height", self.height, 1, 32768)
        view.projection = str(self.projection)
        view.shift = _values("shift", self.shift)
        view.distortion = _values("distortion", self.distortion)
        return _lightwell.camera_of(view)


def _camera(compiled: "_lightwell.Camera") -> Camera:
    ahead = zip(compiled.position, compiled.direction)
    return Camera(
        position=tuple(compiled.position),
        target=tuple(place + way for place, way in ahead),
        up=tuple(compiled.up),
        fov=compiled.fov_degrees,
        width=compiled.width,
        height=compiled.height,
        projection=compiled.projection,
        name=compiled.name,
        shift=tuple(compiled.shift),
        distortion=tuple(compiled.distortion),
    )


def _material(compiled: "_lightwell.Material") -> Material:
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


class Scene:
    """A room and its contents. Made by `read` or `Scene.from_arrays`; never changed afterwards."""

    def __init__(self, data: "_lightwell.SceneData"):
        if not isinstance(data, _lightwell.SceneData):
            raise InputError(
                "a Scene is made by lightwell.read(path) or lightwell.Scene.from_arrays(vertices, faces)"
            )
        self._data = data
        self._first_notes: List[str] = []
        self._triangles: Optional[Tuple[np.ndarray, np.ndarray, np.ndarray]] = None

    @classmethod
    def from_arrays(
        cls,
        vertices: Any,
        faces: Any,
        *,
        surface: Any = None,
        names: Optional[Sequence[str]] = None,
        materials: Union[Material, Sequence[Material], None] = None,
        reflectance: Any = None,
        emission: Any = None,
        cameras: Union[Camera, Sequence[Camera]] = (),
        title: str = "",
    ) -> "Scene":
        """A scene of polygons.

        vertices: (n, 3), metres.
        faces: (m, k) integers, or a list of m lists of three and more: vertex numbers from 0,
            counter-clockwise seen from the front.
        surface: (m,) integers from 0, the surface that each face belongs to. None: all faces are one
            surface, or each is its own where the arguments below have m entries.
        names: a name for each surface.
        materials: a Material for each surface, or one for all.
        reflectance: diffuse reflectance, 0 to 1: one for all, (s,) one for each surface, or (s, 3).
            Comes before that of the materials.
        emission: exitance, W/m^2: likewise.
        cameras: cameras for pictures.

        Faces that are not flat are cut, and those without area left out; `notes` says so.

        Raises InputError for arrays of the wrong shape or type, coordinates that are not finite,
        vertex numbers out of range, and materials that would create energy.
        """
        points = points_of("vertices", vertices)
        corners, first = faces_of(faces)
        count = len(first) - 1
        each = (names, materials, reflectance, emission)
        owner, surfaces = _owners(surface, count, max(_length(values) for values in each))
        made = _materials(surfaces, materials, reflectance, emission)
        parts = _lightwell.SceneParts()
        parts.title = str(title)
        parts.names = _names(surfaces, names)
        parts.materials = [material._compiled() for material in made]
        views = [cameras] if isinstance(cameras, Camera) else list(cameras)
        if not all(isinstance(view, Camera) for view in views):
            raise InputError("cameras must be a list of lightwell.Camera")
        parts.cameras = [view._compiled() for view in views]
        return cls(_lightwell.from_arrays(parts, points, corners, first, owner))

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
        return [_material(material) for material in self._data.materials]

    @property
    def lamps(self) -> List[str]:
        """Names of the lamps that are no surfaces."""
        return self._data.lamps

    @property
    def cameras(self) -> List[Camera]:
        return [_camera(camera) for camera in self._data.cameras]

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
    if values is None or isinstance(values, (str, Material)) or np.ndim(values) == 0:
        return -1
    return len(values)


def _names(surfaces: int, names: Optional[Sequence[str]]) -> List[str]:
    if names is None:
        return [f"surface {number}" for number in range(surfaces)]
    given = [names] if isinstance(names, str) else [str(name) for name in names]
    if len(given) != surfaces:
        raise InputError(f"names has {len(given)} entries for {surfaces} surfaces; give one each")
    return given


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


def _materials(surfaces: int, materials: Any, reflectance: Any, emission: Any) -> List[Material]:
    if materials is None:
        made = [Material(name=f"material {number}") for number in range(surfaces)]
    elif isinstance(materials, Material):
        made = [materials] * surfaces
    else:
        made = list(materials)
        if not all(isinstance(material, Material) for material in made):
            raise InputError("materials must be a lightwell.Material, or a list of them")
        if len(made) != surfaces:
            raise InputError(
                f"materials has {len(made)} entries for {surfaces} surfaces; give one for all, or one each"
            )
    if reflectance is not None:
        each = _per_surface("reflectance", surfaces, reflectance)
        made = [replace(material, reflectance=value) for material, value in zip(made, each)]
    if emission is not None:
        each = _per_surface("emission", surfaces, emission)
        made = [replace(material, emission=value) for material, value in zip(made, each)]
    return made
