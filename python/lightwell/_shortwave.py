"""Sky view factors, and sun and sky on facets with all reflections, on top of view factors."""

from typing import Any, Sequence, Tuple

import numpy as np

from . import _lightwell
from ._arrays import at_least_zero, directions_of
from ._errors import InputError
from ._form_factors import FormFactors
from ._radiation import PerSurface, _rows
from ._scene import fixed


class Shortwave:
    """Sun and sky on the rows of view factors; made by `shortwave`. n is the number of rows.

    Arrays are read-only.
    """

    def __init__(self, sky: np.ndarray, direct: np.ndarray, diffuse: np.ndarray, exchange: Any):
        self.sky_view_factor: np.ndarray = fixed(sky)
        """(n,) float64, 0 to 1: share of a row's radiation that reaches the dome above the horizon."""
        self.direct: np.ndarray = fixed(direct)
        """(n,) float64, W/m^2, irradiance by the sun, mean over the row."""
        self.diffuse: np.ndarray = fixed(diffuse)
        """(n,) float64, W/m^2, irradiance by the sky."""
        self.reflected: np.ndarray = fixed(exchange.reflected)
        """(n,) float64, W/m^2, irradiance by what rows reflect."""
        self.net: np.ndarray = fixed(exchange.net)
        """(n,) float64, W/m^2, absorbed: (1 - albedo) (direct + diffuse + reflected)."""
        self.arriving: float = exchange.arriving
        """W, from sun and sky on all rows."""
        self.absorbed: float = exchange.absorbed
        """W, by all rows."""
        self.escaped: float = exchange.escaped
        """W, reflected out of the openings; `absorbed` and `escaped` add up to `arriving`."""

    def __repr__(self) -> str:
        return (
            f"<lightwell.Shortwave: {len(self.net)} rows, {self.arriving:.6g} W arrive, "
            f"{self.absorbed:.6g} W are absorbed>"
        )


def shortwave(
    factors: FormFactors,
    *,
    albedo: PerSurface,
    sun: Sequence[float] = (),
    direct: float = 0.0,
    diffuse: float = 0.0,
    up: Sequence[float] = (0.0, 0.0, 1.0),
) -> Shortwave:
    """Sky view factors of rows, and the sun and sky that rows absorb after all diffuse reflections.

    factors: result of `form_factors`.
    albedo: 0 to 0.99: one value, (n,) values, or values by the name of the surface.
    sun: (3,), towards the sun, of any length; above the horizon.
    direct: irradiance across the sun's rays, W/m^2.
    diffuse: irradiance of open level ground by an even sky, W/m^2. No light comes from below the
        horizon.
    up: (3,), to the zenith, of any length.

    Raises InputError.
    """
    if not isinstance(factors, FormFactors):
        raise InputError("factors must be a result of form_factors, which knows the geometry")
    count = len(factors.areas)
    zenith = _unit("up", up)
    sky = _lightwell.sky_view_factors(factors._found, zenith)
    from_sky = at_least_zero("diffuse", diffuse) * sky
    from_sun = np.zeros(count)
    across = at_least_zero("direct", direct)
    if across > 0.0:
        if len(sun) == 0:
            raise InputError("direct light needs the direction of the sun; give sun=(x, y, z)")
        towards = _unit("sun", sun)
        if not float(np.dot(towards, zenith)) > 0.0:
            raise InputError("the sun is below the horizon; give direct=0, or a sun above")
        from_sun = across * _lightwell.sun_factors(factors._found, towards)
    shares = _rows("albedo", albedo, count, factors, np.nan)
    exchange = _lightwell.shortwave_exchange(factors._found, from_sun + from_sky, shares)
    return Shortwave(sky, from_sun, from_sky, exchange)


def _unit(name: str, direction: Sequence[float]) -> Tuple[float, float, float]:
    vector = directions_of(name, direction, 1)[0]
    x, y, z = vector / np.linalg.norm(vector)
    return float(x), float(y), float(z)
