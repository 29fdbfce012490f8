"""Solutions: the light of a scene on a mesh."""

import os
from functools import cached_property
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _lightwell
from ._arrays import checked_progress, directions_of, points_of, real_number, set_options, share_text, whole_number
from ._camera import Camera
from ._errors import InputError
from ._lightmaps import Lightmaps, are_both, lightmap_options
from ._report import report_figures
from ._scene import Progress, Scene, fixed

Path = Union[str, "os.PathLike[str]"]


class Readings(NamedTuple):
    """Light at points."""

    irradiance: np.ndarray
    """(n, bands) float32, W/m^2."""
    lux: np.ndarray
    """(n,) float64, lx."""
    lux_within: np.ndarray
    """(n,) float64, lx: bound of the error with odds of about 19 to 1; NaN where nothing is known."""


class Solution:
    """The light of a scene, view-independent, on a mesh of triangles and quadrilaterals.

    Made by `solve` and `load`; never changed afterwards. Its arrays are read-only. Those named as
    views share the solution's memory, which lives as long as any of them.
    """

    def __init__(self, data: "_lightwell.SolutionData"):
        if not isinstance(data, _lightwell.SolutionData):
            raise InputError("a Solution is made by lightwell.solve(scene) or lightwell.load(path)")
        self._data = data

    # The mesh.

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) float64, metres; a view."""
        return self._data.vertices

    @property
    def normals(self) -> np.ndarray:
        """(n, 3) float64: unit normals of the vertices, on the side that is lit; a view."""
        return self._data.normals

    @property
    def elements(self) -> np.ndarray:
        """(m, 4) int32: vertices of each element, counter-clockwise; [3] is -1 for a triangle; a view."""
        return self._data.elements

    @cached_property
    def triangle_element(self) -> np.ndarray:
        """(k,) int32: the element that each of `triangles` is of."""
        quads = np.flatnonzero(self.elements[:, 3] >= 0).astype(np.int32)
        return fixed(np.concatenate([np.arange(len(self.elements), dtype=np.int32), quads]))

    @cached_property
    def triangles(self) -> np.ndarray:
        """(k, 3) int32: the elements as triangles; second halves of quadrilaterals come last."""
        quads = self.elements[self.elements[:, 3] >= 0]
        return fixed(np.concatenate([self.elements[:, :3], quads[:, [0, 2, 3]]]))

    @property
    def element_area(self) -> np.ndarray:
        """(m,) float64, m^2; a view."""
        return self._data.element_area

    @property
    def element_patch(self) -> np.ndarray:
        """(m,) int32: the patch that each element is of; a view."""
        return self._data.element_patch

    @property
    def patch_area(self) -> np.ndarray:
        """(p,) float64, m^2; a view."""
        return self._data.patch_area

    @property
    def patch_surface(self) -> np.ndarray:
        """(p,) int32: surface of each patch, an index into `Scene.names`; a view."""
        return self._data.patch_surface

    # The light.

    @cached_property
    def irradiance(self) -> np.ndarray:
        """(n, bands) float32, W/m^2 at the vertices: direct and indirect light together."""
        return fixed(self._data.irradiance)

    @property
    def direct_irradiance(self) -> np.ndarray:
        """(n, bands) float32, W/m^2 at the vertices, straight from lights; a view."""
        return self._data.direct_irradiance

    @property
    def indirect_irradiance(self) -> np.ndarray:
        """(n, bands) float32, W/m^2 at the vertices, all other light; a view."""
        return self._data.indirect_irradiance

    @cached_property
    def radiosity(self) -> np.ndarray:
        """(n, bands) float32, W/m^2 at the vertices: B = M + rho E."""
        return fixed(self._data.radiosity)

    @property
    def patch_radiosity(self) -> np.ndarray:
        """(p, bands) float32, W/m^2; a view."""
        return self._data.patch_radiosity

    @property
    def patch_reflectance(self) -> np.ndarray:
        """(p, bands) float32, 0 to 1; a view."""
        return self._data.patch_reflectance

    @property
    def patch_emission(self) -> np.ndarray:
        """(p, bands) float32, exitance M, W/m^2; a view."""
        return self._data.patch_emission

    @cached_property
    def lux(self) -> np.ndarray:
        """(n,) float64, lx at the vertices."""
        return fixed(self._data.lux)

    # Estimated errors.

    @property
    def error(self) -> float:
        """Estimated RMS error of irradiance, relative to the mean irradiance; 0: no estimate."""
        return self._data.error

    @cached_property
    def element_error(self) -> np.ndarray:
        """(m,) float32: bound of the error anywhere in each element, relative, odds of 19 to 1."""
        return fixed(self._data.element_error)

    @property
    def energy(self) -> Dict[str, float]:
        """Watts: `emitted` = `absorbed` + `escaped` + `unshot`. `from_lamps` is part of emitted,
        `missed` part of escaped."""
        return self._data.energy

    @property
    def outcome(self) -> str:
        """"converged", "max_sweeps_reached", "accuracy_missed" or "cut_short"."""
        return self._data.outcome

    @property
    def residual(self) -> float:
        """Largest |M + rho F B - B| relative to the largest B, at the end."""
        return self._data.residual

    @property
    def seconds(self) -> Dict[str, float]:
        """Wall time of the phases, s."""
        return self._data.seconds

    @property
    def notes(self) -> List[str]:
        """What meshing had to leave out, how refinement ended, and what a checkpoint lacks, a sentence each."""
        refined, unkept = self._data.refinement, self._data.unkept
        notes = self._data.notes + ([f"Refinement: {refined}."] if refined else [])
        return notes + ([f"Checkpoint: {unkept}."] if unkept else [])

    @property
    def looked_from(self) -> List[str]:
        """Where errors were held small, the names of `look_from`; empty: everywhere."""
        return self._data.looked_from

    @property
    def bands(self) -> List[str]:
        """Names of the bands, the columns of arrays of light."""
        return self._data.bands

    @property
    def channels(self) -> Dict[str, float]:
        """Luminous flux of each channel of light that is kept apart, lm; empty: none."""
        return self._data.channels

    @property
    def options(self) -> str:
        """The options it was solved with."""
        return self._data.options

    @property
    def scene(self) -> Optional[Scene]:
        """The scene; None if the solution was loaded without it."""
        return None if self._data.scene is None else Scene(self._data.scene)

    # Readings and pictures.

    def probe(
        self,
        points: Any,
        normals: Any,
        *,
        rays: int = 1024,
        interpolate: bool = False,
        progress: Optional[Progress] = None,
    ) -> np.ndarray:
        """Irradiance at points, (n, bands) float32, W/m^2.

        points: (n, 3), metres.
        normals: (n, 3) or (3,), of any length: the directions that the points face.
        rays: of the gather at each point, a power of two.
        interpolate: read the mesh instead, which is quick; points must then lie on surfaces.
        """
        places = points_of("points", points)
        ways = directions_of("normals", normals, len(places))
        if interpolate:
            return _lightwell.interpolate(self._data, places, ways)
        count = whole_number("rays", rays, 1, 1 << 20)
        return _lightwell.probe(self._data, places, ways, count, checked_progress(progress))

    def measure(
        self,
        points: Any,
        normals: Any,
        *,
        accuracy: Union[float, str] = 0.0,
        rays: int = 1024,
        progress: Optional[Progress] = None,
    ) -> Readings:
        """Irradiance and illuminance at points, each with a bound of its error.

        accuracy: bound to reach at each point, as a share of its illuminance (0.01 or "1%"; 0.1 % at
            least); 0: what the rays give.
        Other arguments: those of `probe`.
        """
        places = points_of("points", points)
        ways = directions_of("normals", normals, len(places))
        count = whole_number("rays", rays, 1, 1 << 20)
        text = share_text(accuracy)
        wanted = 0.0 if text in ("0", "0.0") else _lightwell.share("accuracy", text)
        irradiance, lux, within = _lightwell.probe_with_bounds(
            self._data, places, ways, wanted, count, checked_progress(progress)
        )
        return Readings(irradiance, lux, within)

    def lux_at(self, points: Any, normals: Any, **options: Any) -> np.ndarray:
        """Illuminance at points, (n,) float64, lx. Arguments: those of `measure`."""
        return self.measure(points, normals, **options).lux

    def render(
        self,
        camera: Union[Camera, str, None] = None,
        *,
        width: Optional[int] = None,
        height: Optional[int] = None,
        quality: str = "good",
        pass_: str = "auto",
        shadow_rays: Optional[int] = None,
        photons: Optional[int] = None,
        gather_samples: Optional[int] = None,
        virtual_lights: Optional[int] = None,
        depth: Optional[int] = None,
        samples: Optional[int] = None,
        noise: Union[float, str, None] = None,
        progress: Optional[Progress] = None,
    ) -> np.ndarray:
        """A picture: (height, width, 3) float32, linear sRGB radiance, W/(m^2 sr), row 0 on top.

        camera: a Camera, the name of one of the scene's, or None for the scene's first.
        width, height: pixels; the width alone keeps the shape.
        quality: "draft", "good" or "final".
        pass_: "auto", "interpolate", "direct", "gather" or "virtual-lights".
        noise: relative standard error at which sampling of a pixel ends.
        Others: those of `lightwell render --help`.
        """
        if height is not None and width is None:
            raise InputError("height is given without width; give both, or the width alone")
        options = _lightwell.RenderOptions()
        asked = {
            "quality": quality,
            "pass_": pass_,
            "shadow_rays": shadow_rays,
            "photons": photons,
            "gather_samples": gather_samples,
            "virtual_lights": virtual_lights,
            "depth": depth,
            "samples": samples,
            "noise": noise,
            "width": width,
            "height": height,
        }
        set_options(options, asked, shares=["noise"])
        if isinstance(camera, Camera):
            view = camera._compiled(self._data.scene)
        elif camera is None or isinstance(camera, str):
            view = _lightwell.camera_named(self._data, camera or "")
        else:
            raise InputError(f"camera is {camera!r}; give a lightwell.Camera or a camera's name")
        return _lightwell.render(self._data, view, options, checked_progress(progress))

    def relight(self, channels: Mapping[str, Union[float, str]]) -> "Solution":
        """A solution with channels of light dimmed or recoloured, without solving again.

        channels: by the name of a channel, or a pattern such as "row*": a factor (0.3), "off", "on", a
            colour ("#ffd9b0") or both ("0.3,#ffd9b0"), relative to the scene as solved.
        """
        if not isinstance(channels, Mapping):
            raise InputError(
                f"channels is {channels!r}; give settings by the name of a channel, such as {{'desk': 0.3}}"
            )
        settings = [
            (str(name), value if isinstance(value, str) else repr(real_number(str(name), value)))
            for name, value in channels.items()
        ]
        return Solution(_lightwell.relight(self._data, settings))

    def report(
        self,
        *paths: Path,
        surfaces: Sequence[str] = (),
        planes: Mapping[str, float] = {},
        observers: Sequence[str] = (),
        watts: Mapping[str, float] = {},
        margin: Optional[float] = None,
        spacing: Optional[float] = None,
        maintenance: Optional[float] = None,
        areas: Optional[Path] = None,
        activity: str = "",
        activities: Optional[Path] = None,
        sports: Optional[Path] = None,
        colour_samples: Optional[Path] = None,
        rays: int = 1024,
        camera: Optional[str] = None,
        language: str = "en",
        progress: Optional[Progress] = None,
    ) -> Dict[str, Any]:
        """Figures of the lighting design; also written to `paths`: .pdf, .html (a page to print), .json, .csv.

        surfaces: measured on, besides the [[grids]] of the scene's file.
        planes: heights above surfaces, metres, by the name of the surface: {"floor": 0.75}.
        observers: cameras for whose eyes glare (UGR) is rated.
        watts: electric power of each luminaire, by its name.
        margin: strip along the outline of planes that is left out, metres (0.5).
        spacing: largest distance between points, metres (by EN 12464-1).
        maintenance: maintenance factor of electric light, above 0 up to 1 (that of the design, or 1).
        areas: .toml with grids and areas of EN 12464-1, EN 1838 and EN 12193, in place of those of the
            scene's file, which are held to their limits otherwise.
        activity: of EN 12464-1, to which working planes without an area are held: "writing", ...
        activities, sports: .toml, tables of limits in place of the program's.
        colour_samples: .csv, the 99 samples of TM-30, for R_f and R_g of observers.
        rays: of the gather at each point, a power of two.
        camera: of the picture on the page (the first).
        language: of .pdf and .html: "en", "de", "fr" or "es".

        Keys: those of `lightwell report --json`; lengths there are metres or the unit they name.
        """
        asked = {name: value for name, value in locals().items() if name not in ("self", "paths", "progress")}
        files = [os.fspath(path) for path in paths]
        return report_figures(self._data, files, asked, checked_progress(progress))

    def save(self, path: Path) -> None:
        """Writes the solution (.vtp), which `load`, the command line and ParaView read."""
        if os.path.splitext(os.fspath(path))[1] != ".vtp":
            raise InputError(f"'{os.fspath(path)}' must end in .vtp")
        _lightwell.save(self._data, os.fspath(path))

    def export(
        self,
        path: Path,
        *,
        exposure: float = 0.0,
        sides: str = "front",
        lightmap: bool = False,
        lightmap_size: int = 2048,
        texels_per_metre: Optional[float] = None,
        lightmap_padding: int = 4,
        lightmap_pass: str = "interpolate",
        lightmap_channels: bool = False,
        progress: Optional[Progress] = None,
    ) -> None:
        """Writes a model with its light: .glb, .ply or .obj, or a page to walk through, .html.

        exposure: stops, negative for darker.
        sides: of thin surfaces, "front" or "both".
        lightmap: light of a .glb in textures instead of colours of vertices; its data go beside it, into
            FILE-lightmap-1.exr and so on.
        lightmap_size, texels_per_metre, lightmap_padding, lightmap_pass: those of `lightmaps`.
        lightmap_channels: also data of each channel of light, FILE-lightmap-1-CHANNEL.exr.
        progress: called with the phase and the share done of lightmaps; False stops the work.
        """
        both = are_both(sides)
        ev = real_number("exposure", exposure)
        if not lightmap:
            _lightwell.export_model(self._data, os.fspath(path), ev, both)
            return
        options = lightmap_options(lightmap_size, texels_per_metre, lightmap_padding, lightmap_pass)
        options.channels = bool(lightmap_channels)
        _lightwell.export_lightmaps(self._data, os.fspath(path), options, (ev, both), checked_progress(progress))

    def lightmaps(
        self,
        *,
        size: int = 2048,
        texels_per_metre: Optional[float] = None,
        padding: int = 4,
        pass_: str = "interpolate",
        sides: str = "front",
        progress: Optional[Progress] = None,
    ) -> Lightmaps:
        """The light in square pictures that lie on the surfaces: charts of triangles, and NumPy arrays.

        size: texels along an edge of a picture, 16 to 8192.
        texels_per_metre: resolution, in several pictures if necessary; None: what fits into one.
        padding: texels around each chart, 1 to 64.
        pass_: light of a texel: "interpolate" (from the solution), "direct" (direct light anew) or
            "gather" (indirect light anew too).
        sides: of thin surfaces, "front" or "both".

        Values are those of the files that `export` writes with the same options.

        Raises InputError for options out of range and for charts that do not fit; Interrupted after False.
        """
        options = lightmap_options(size, texels_per_metre, padding, pass_)
        return Lightmaps(_lightwell.lightmaps(self._data, options, are_both(sides), checked_progress(progress)))

    def to_pyvista(self) -> Any:
        """The elements as a `pyvista.PolyData`; point data irradiance, radiosity, lux. Needs pyvista."""
        import pyvista  # type: ignore

        faces = np.column_stack([np.full(len(self.triangles), 3), self.triangles])
        mesh = pyvista.PolyData(np.array(self.vertices), faces.reshape(-1))
        for name in ("irradiance", "radiosity", "lux"):
            mesh.point_data[name] = getattr(self, name)
        return mesh

    def __repr__(self) -> str:
        error = f"error {100 * self.error:.2g} %" if self.error > 0 else "no error estimate"
        parts = [f"{len(self.elements)} elements", f"{len(self.vertices)} vertices", self.outcome, error]
        if self.channels:
            parts.append(f"channels {', '.join(self.channels)}")
        return f"<lightwell.Solution: {', '.join(parts)}>"
