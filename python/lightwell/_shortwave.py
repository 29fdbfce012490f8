"""Sky view factors, and sun and sky on facets and points with all reflections, on view factors."""

from typing import Any, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _lightwell
from ._arrays import (
    array_of,
    checked_progress,
    directions_of,
    integers_of,
    points_of,
    unit_vector,
    whole_number,
)
from ._errors import InputError
from ._form_factors import FormFactors
from ._radiation import PerSurface, _rows
from ._scene import Progress, fixed


class PointLight(NamedTuple):
    """Sun and sky at points. p is the number of points; of h instants, (p,) becomes (h, p)."""

    sky_view_factor: np.ndarray
    """(p,) float64, 0 to 1: share of the hemisphere, weighted by the cosine, that shows the sky."""
    direct: np.ndarray
    """(p,) float64, W/m^2, irradiance by the sun."""
    diffuse: np.ndarray
    """(p,) float64, W/m^2, irradiance by the sky."""
    reflected: np.ndarray
    """(p,) float64, W/m^2, irradiance by what rows reflect."""
    total: np.ndarray
    """(p,) float64, W/m^2, the sum of the three."""


class Shortwave:
    """Sun and sky on the rows of view factors; made by `shortwave`. n is the number of rows.

    Arrays are read-only. Of h instants, light of the shape (n,) becomes (h, n), and powers (h,).
    """

    def __init__(self, found: "_lightwell.ShortwaveArrays", is_series: bool, has_points: bool):
        def light(values: np.ndarray) -> np.ndarray:
            return fixed(values if is_series else values[0])

        def power(values: np.ndarray) -> Any:
            return fixed(values) if is_series else float(values[0])

        self.sky_view_factor: np.ndarray = fixed(found.sky_view)
        """(n,) float64, 0 to 1: share of a row's radiation that reaches the dome above the horizon."""
        self.direct: np.ndarray = light(found.direct)
        """(n,) float64, W/m^2, irradiance by the sun, mean over the row."""
        self.diffuse: np.ndarray = light(found.diffuse)
        """(n,) float64, W/m^2, irradiance by the sky."""
        self.reflected: np.ndarray = light(found.reflected)
        """(n,) float64, W/m^2, irradiance by what rows reflect."""
        self.net: np.ndarray = light(found.net)
        """(n,) float64, W/m^2, absorbed: (1 - albedo) (direct + diffuse + reflected)."""
        self.arriving: Union[float, np.ndarray] = power(found.arriving)
        """W, from sun and sky on all rows."""
        self.absorbed: Union[float, np.ndarray] = power(found.absorbed)
        """W, by all rows."""
        self.escaped: Union[float, np.ndarray] = power(found.escaped)
        """W, reflected out of the openings; `absorbed` and `escaped` add up to `arriving`."""
        self.points: Optional[PointLight] = None
        """Light at `points`; None where none were given."""
        if has_points:
            sun, sky, rows = light(found.point_direct), light(found.point_diffuse), light(found.point_reflected)
            self.points = PointLight(fixed(found.point_sky_view), sun, sky, rows, fixed(sun + sky + rows))

    def __repr__(self) -> str:
        rows, instants = self.net.shape[-1], np.size(self.arriving)
        many = f"{instants} instants, sums of " if self.net.ndim > 1 else ""
        return (
            f"<lightwell.Shortwave: {rows} rows, {many}{np.sum(self.arriving):.6g} W arrive, "
            f"{np.sum(self.absorbed):.6g} W are absorbed>"
        )


def shortwave(
    factors: FormFactors,
    *,
    albedo: PerSurface,
    sun: Any = (),
    direct: Any = 0.0,
    diffuse: Any = 0.0,
    up: Sequence[float] = (0.0, 0.0, 1.0),
    sky: str = "even",
    day: Any = None,
    points: Any = None,
    normals: Any = None,
    rays: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Shortwave:
    """Sky view factors of rows, and the sun and sky that rows absorb after all diffuse reflections.

    factors: result of `form_factors`.
    albedo: 0 to 0.99: one value, (n,) values, or values by the name of the surface.
    sun: (3,), towards the sun, of any length; above the horizon. (h, 3): of h instants.
    direct: irradiance across the sun's rays, W/m^2: one value, or (h,).
    diffuse: irradiance of open level ground by the sky, W/m^2: one value, or (h,). No light comes from
        below the horizon.
    sky: "even", or "perez", the all-weather sky that follows from sun, direct and diffuse (Perez, Seals &
        Michalsky 1993): brighter about the sun and at the horizon.
    day: number of the day in the year, 1 to 366, for "perez": one, or (h,), as `Weather.day_of_year`.
    up: (3,), to the zenith, of any length.
    points: (p, 3), metres: also light at these points, in the air or on facets.
    normals: (p, 3) or (3,), of any length: the directions that the points face.
    rays: fewest shadow rays of a row's patch for each place of the sun, a power of two from 64 to 1024;
        by default 1024 for one instant and 64 for more.
    progress: called with the phase and the share done; False stops the work.

    What does not depend on the sun is computed once for all instants. Numbers are those of
    `lightwell shortwave`, bit for bit.

    Raises InputError, and Interrupted after False.
    """
    if not isinstance(factors, FormFactors):
        raise InputError("factors must be a result of form_factors, which knows the geometry")
    asked = _lightwell.ShortwaveQuestion()
    asked.up = unit_vector("up", up)
    is_series, asked.suns, asked.direct, asked.diffuse = _instants(sun, direct, diffuse, asked.up)
    asked.days = _days(sky, day, np.size(sun) > 0, len(asked.suns))
    asked.albedo = np.ascontiguousarray(_rows("albedo", albedo, len(factors.areas), factors, np.nan))
    if (points is None) != (normals is None):
        raise InputError("points need the directions that they face; give points and normals")
    places = points_of("points", np.zeros((0, 3)) if points is None else points)
    asked.points = places
    asked.normals = places if points is None else directions_of("normals", normals, len(places))
    usual = _lightwell.rays_of_many_suns if is_series else _lightwell.rays_of_one_sun
    asked.rays = _checked_rays(usual if rays is None else rays)
    found = _lightwell.shortwave(factors._found, asked, checked_progress(progress))
    return Shortwave(found, is_series, points is not None)


def _days(sky: str, day: Any, has_sun: bool, count: int) -> np.ndarray:
    """Days of the year of all instants under Perez' sky; none for an even sky."""
    if sky not in ("even", "perez"):
        raise InputError(f"there is no sky '{sky}'; choose from: even, perez")
    if sky == "even":
        if day is not None:
            raise InputError("day is that of an instant under sky='perez'; leave it out, or give that sky")
        return np.zeros(0, np.int32)
    if day is None or not has_sun:
        raise InputError("sky='perez' follows from the sun and the date; give sun and day")
    days = integers_of("day", np.atleast_1d(array_of("day", day)))
    if len(days) not in (1, count) or (days < 1).any() or (days > 366).any():
        raise InputError(f"day is {day!r}; one number from 1 to 366, or one for each of {count} instants, is needed")
    return np.ascontiguousarray(np.broadcast_to(days, (count,)))


def _checked_rays(rays: Any) -> int:
    count = whole_number("rays", rays, _lightwell.rays_of_many_suns, _lightwell.rays_of_one_sun)
    if count & (count - 1):
        raise InputError(f"rays is {count}; a power of two is needed, such as 256")
    return count


def _instants(
    sun: Any, direct: Any, diffuse: Any, up: Tuple[float, float, float]
) -> Tuple[bool, np.ndarray, np.ndarray, np.ndarray]:
    """True for a list of instants; unit vectors to the sun (h, 3), direct and diffuse light (h,)."""
    given = {"direct": array_of("direct", direct), "diffuse": array_of("diffuse", diffuse)}
    counts = {name: len(values) for name, values in given.items() if values.ndim > 0}
    if np.ndim(sun) == 2:
        counts["sun"] = len(sun)
    is_series = bool(counts)
    count = max(counts.values(), default=1)
    for name, length in counts.items():
        if length not in (1, count) or length == 0:
            raise InputError(f"{name} has {length} instants where others have {count}; give one each")
    lights = [_irradiances(name, values, count) for name, values in given.items()]
    if np.size(sun) == 0:
        if (lights[0] > 0.0).any():
            raise InputError("direct light needs the direction of the sun; give sun=(x, y, z)")
        return is_series, np.tile(np.array(up), (count, 1)), lights[0], lights[1]
    towards = directions_of("sun", sun, count)
    towards = towards / np.linalg.norm(towards, axis=1)[:, np.newaxis]
    below = np.flatnonzero((lights[0] > 0.0) & ~(towards @ np.array(up) > 0.0))
    if below.size:
        where = f" at instant {below[0]}" if is_series else ""
        raise InputError(f"the sun is below the horizon{where}; give direct=0, or a sun above")
    return is_series, np.ascontiguousarray(towards), lights[0], lights[1]


def _irradiances(name: str, values: np.ndarray, count: int) -> np.ndarray:
    if values.ndim > 1:
        raise InputError(f"{name} has the shape {values.shape}; one value, or one for each instant, is needed")
    light = np.ascontiguousarray(np.broadcast_to(values, (count,)), dtype=np.float64)
    bad = np.flatnonzero(~(np.isfinite(light) & (light >= 0.0)))
    if bad.size:
        raise InputError(f"{name} is {light[bad[0]]:g}; a number of 0 or more is needed")
    return light
