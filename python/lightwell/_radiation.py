"""Radiant exchange of gray, diffuse surfaces, on top of view factors."""

from functools import cached_property
from typing import Any, Dict, Mapping, Optional, Union

import numpy as np

from . import _lightwell
from ._arrays import array_of, real_number
from ._errors import InputError
from ._form_factors import FormFactors
from ._scene import fixed

PerSurface = Union[float, Mapping[str, float], Any]
"""One value for all rows, (n,) values, or values by the name of the surface."""


class Radiation:
    """Net radiant exchange of an enclosure; made by `radiation`. n is the number of rows.

    Arrays are read-only.
    """

    def __init__(
        self,
        areas: "_lightwell.ExchangeAreas",
        emissivity: np.ndarray,
        exchange: "_lightwell.RadiantExchange",
        surroundings: float,
        factors: Optional[FormFactors],
    ):
        self._areas = areas
        self._factors = factors
        self.emissivity = fixed(emissivity.copy())
        """(n,) float64, 0 to 1."""
        self.surroundings = surroundings
        """Temperature of the surroundings, K."""
        self.temperature: np.ndarray = fixed(exchange.kelvin)
        """(n,) float64, K; NaN where nothing decides it."""
        self.radiosity: np.ndarray = fixed(exchange.radiosity)
        """(n,) float64, W/m^2, emitted and reflected."""
        self.irradiation: np.ndarray = fixed(exchange.irradiation)
        """(n,) float64, W/m^2."""
        self.heat: np.ndarray = fixed(exchange.heat)
        """(n,) float64, W, net, away from each row. Adds up to `to_surroundings`."""
        self.to_surroundings: float = exchange.to_surroundings
        """W, net, out of the openings."""

    @property
    def areas(self) -> np.ndarray:
        """(n,) float64, m^2."""
        return fixed(self._areas.area)

    @cached_property
    def gebhart(self) -> np.ndarray:
        """(n, n + 1) float64: share of what row i emits that row j absorbs, directly or after
        reflections; the last column is the surroundings. Rows add up to 1."""
        return fixed(_lightwell.gebhart_factors(self._areas, self.emissivity))

    @cached_property
    def script_f(self) -> np.ndarray:
        """(n, n + 1) float64: transfer factors of Hottel & Sarofim, emissivity times `gebhart`."""
        return fixed(_lightwell.transfer_factors(self._areas, self.emissivity))

    @cached_property
    def exchange(self) -> np.ndarray:
        """(n, n + 1) float64, W: net exchange of row i with row j, A_i script_f_ij sigma (T_i^4 -
        T_j^4), and with the surroundings."""
        # A row whose temperature nothing decides exchanges nothing: its factors are 0.
        kelvin = np.append(np.nan_to_num(self.temperature), self.surroundings)
        power = _lightwell.stefan_boltzmann * kelvin**4
        return fixed(self.areas[:, None] * self.script_f * (power[:-1, None] - power[None, :]))

    @property
    def heat_by_surface(self) -> Dict[str, float]:
        """W by the name of the surface; of view factors with names."""
        if self._factors is None:
            raise InputError("the view factors are an array, which has no names of surfaces")
        sums: Dict[str, float] = {}
        for name, heat in zip(self._factors.names, self.heat):
            sums[name] = sums.get(name, 0.0) + float(heat)
        return sums

    def __repr__(self) -> str:
        return (
            f"<lightwell.Radiation: {len(self.heat)} rows, {np.clip(self.heat, 0, None).sum():.6g} W "
            f"exchanged, {self.to_surroundings:.6g} W to surroundings of {self.surroundings:g} K>"
        )


def radiation(
    factors: Union[FormFactors, Any],
    *,
    emissivity: PerSurface,
    temperature: PerSurface = None,
    heat: PerSurface = None,
    surroundings: float = 0.0,
    areas: Any = None,
    open: Any = None,
) -> Radiation:
    """Net radiant exchange between gray, diffuse surfaces (network method).

    factors: result of `form_factors`, or an (n, n) array of F_ij together with `areas`.
    emissivity: 0 to 1: one value, (n,) values, or values by the name of the surface.
    temperature: K, likewise. NaN, or a name left out: unknown, and found from the heat.
    heat: W, net, away from each row of unknown temperature (of the name: of each of its rows); 0,
        adiabatic, unless given.
    surroundings: temperature that the openings show, K.
    areas: (n,), m^2, for factors in an array.
    open: (n,), share of each row that reaches the surroundings, for factors in an array (0).

    Up to 4096 rows. This cannot be stopped, and takes half a minute for so many.

    Raises InputError that names the row.
    """
    if isinstance(factors, FormFactors):
        if areas is not None or open is not None:
            raise InputError("areas and open belong to factors in an array; form_factors knows its own")
        exchange_areas = _lightwell.areas_of(factors._found)
        count, named = len(factors.areas), factors
    else:
        matrix = np.ascontiguousarray(array_of("factors", factors), dtype=np.float64)
        if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
            raise InputError(f"factors has the shape {matrix.shape}; (n, n) is needed")
        if areas is None:
            raise InputError("factors in an array need areas, the area of each row in m^2")
        count, named = len(matrix), None
        exchange_areas = _lightwell.areas_from(
            _rows("areas", areas, count, None, 0.0),
            matrix,
            _rows("open", 0.0 if open is None else open, count, None, 0.0),
        )
    eps = _rows("emissivity", emissivity, count, named, np.nan)
    kelvin = _rows("temperature", np.nan if temperature is None else temperature, count, named, np.nan)
    watts = _rows("heat", 0.0 if heat is None else heat, count, named, 0.0)
    both = np.flatnonzero(~np.isnan(kelvin) & (watts != 0.0))
    if both.size:
        raise InputError(f"row {both[0]} has a temperature and a heat; give one of the two")
    outside = real_number("surroundings", surroundings)
    found = _lightwell.radiant_exchange(exchange_areas, eps, kelvin, watts, outside)
    return Radiation(exchange_areas, eps, found, outside, named)


def _rows(
    name: str, values: Any, count: int, factors: Optional[FormFactors], missing: float
) -> np.ndarray:
    """A value for each row: (count,) float64."""
    if isinstance(values, Mapping):
        if factors is None:
            raise InputError(f"{name} by names needs view factors with names; give a value for each row")
        unknown = set(values) - set(factors.names)
        if unknown:
            raise InputError(f"{name}: there is no surface '{sorted(unknown)[0]}'")
        return np.array([real_number(name, values.get(row, missing)) if row in values else missing
                         for row in factors.names])
    array = np.asarray(array_of(name, values), dtype=np.float64)
    if array.ndim == 0:
        array = np.full(count, array)
    if array.shape != (count,):
        raise InputError(f"{name} has the shape {array.shape}; one value, or ({count},), is needed")
    return np.ascontiguousarray(array)
