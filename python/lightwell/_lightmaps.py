"""Lightmaps: the light of surfaces in pictures that lie on them."""

from functools import cached_property
from typing import List, Optional

import numpy as np

from . import _lightwell
from ._arrays import set_options
from ._errors import InputError
from ._scene import fixed


class Lightmap:
    """One of the pictures of `Lightmaps`, s x s texels, row 0 on top. Arrays are read-only.

    Texels outside of charts continue the charts around, so that no filter reads black.
    """

    def __init__(self, data: "_lightwell.LightmapData", number: int):
        self._data = data
        self._number = number

    @property
    def irradiance(self) -> np.ndarray:
        """(s, s, bands) float32, E, W/m^2; a view."""
        return self._data.irradiance(self._number)

    @property
    def radiosity(self) -> np.ndarray:
        """(s, s, 3) float32, B = M + rho E, W/m^2, linear Rec. 709 RGB; a view."""
        return self._data.radiosity(self._number)

    @property
    def radiance(self) -> np.ndarray:
        """(s, s, 3) float32, W/(m^2 sr), linear RGB as models show it; a view, for `tone_map`."""
        return self._data.radiance(self._number)

    @cached_property
    def lux(self) -> np.ndarray:
        """(s, s) float64, lx."""
        return fixed(self._data.lux(self._number))

    @property
    def lux_within(self) -> Optional[np.ndarray]:
        """(s, s) float32, lx: bound of the error of `lux`, odds of about 19 to 1; None where none is known; a view."""
        values = self._data.lux_within(self._number)
        return None if values is None else values[..., 0]

    @cached_property
    def covered(self) -> np.ndarray:
        """(s, s) bool: texels whose middle lies on a surface."""
        return fixed(self._data.covered(self._number).astype(bool))

    def __repr__(self) -> str:
        size = self._data.size
        return f"<lightwell.Lightmap {self._number}: {size} x {size} texels, {100 * self.covered.mean():.3g} % covered>"


class Lightmaps:
    """Triangles of charts with coordinates in pictures, and the pictures; made by `Solution.lightmaps`.

    n is the number of vertices, m that of triangles. Arrays are read-only; views share the memory of the
    lightmaps, which lives as long as any of them.
    """

    def __init__(self, data: "_lightwell.LightmapData"):
        if not isinstance(data, _lightwell.LightmapData):
            raise InputError("Lightmaps are made by Solution.lightmaps()")
        self._data = data

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) float64, metres; shared within a chart alone; a view."""
        return self._data.vertices

    @property
    def uv(self) -> np.ndarray:
        """(n, 2) float32, 0 to 1: place in the chart's picture; (0, 0) is its top left corner, as in glTF; a view."""
        return self._data.uv

    @property
    def triangles(self) -> np.ndarray:
        """(m, 3) int32, counter-clockwise seen from the lit side; a view."""
        return self._data.triangles

    @property
    def picture(self) -> np.ndarray:
        """(m,) int32: number of each triangle's picture among `pictures`; a view."""
        return self._data.picture

    @property
    def surface(self) -> np.ndarray:
        """(m,) int32: surface of each triangle, an index into `Scene.names`; a view."""
        return self._data.surface

    @property
    def chart(self) -> np.ndarray:
        """(m,) int32: chart of each triangle; a view."""
        return self._data.chart

    @cached_property
    def back(self) -> np.ndarray:
        """(m,) bool: triangles of the backs of surfaces."""
        return fixed(self._data.back.astype(bool))

    @cached_property
    def pictures(self) -> List[Lightmap]:
        """The pictures, all of one size."""
        return [Lightmap(self._data, number) for number in range(self._data.count)]

    @property
    def size(self) -> int:
        """Texels along an edge of a picture."""
        return self._data.size

    @property
    def texels_per_metre(self) -> float:
        """Resolution."""
        return self._data.texels_per_metre

    @property
    def padding(self) -> int:
        """Texels around each chart."""
        return self._data.padding

    def __repr__(self) -> str:
        return (
            f"<lightwell.Lightmaps: {self._data.count} of {self.size} x {self.size} texels, {self._data.charts} charts, "
            f"{self.texels_per_metre:.4g} texels/m>"
        )

def are_both(sides: str) -> bool:
    if sides not in ("front", "both"):
        raise InputError(f"there are no sides '{sides}'; choose from: front, both")
    return sides == "both"


def lightmap_options(size: int, density: Optional[float], padding: int, pass_: str) -> "_lightwell.LightmapOptions":
    options = _lightwell.LightmapOptions()
    asked = {"size": size, "texels_per_metre": density, "padding": padding, "pass_": pass_}
    set_options(options, asked)
    return options
