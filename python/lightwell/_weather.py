"""Sun and sky of the hours of a year."""

import os
from typing import List, Sequence, Union

import numpy as np

from . import _lightwell
from ._arrays import unit_vector
from ._errors import InputError
from ._scene import fixed


class Weather:
    """The hours of a year with light, h of them, in order; made by `read_weather`.

    The sun stands where it is in the middle of the hour, in standard time. Arrays are read-only.
    """

    def __init__(self, data: "_lightwell.WeatherData"):
        self.place: str = data.place
        self.latitude: float = data.latitude
        """Degrees north."""
        self.longitude: float = data.longitude
        """Degrees east."""
        self.hours_east: float = data.hours_east
        """Standard time less UTC."""
        self.notes: List[str] = data.notes
        """What was missing in the file, a sentence each."""
        self._data = data
        dates, light = data.dates, data.light
        self.month, self.day, self.hour, self.number = (fixed(column.copy()) for column in dates.T)
        """(h,) int32: month, day, hour of the day from 0, and hour of the year from 0."""
        self.altitude, self.azimuth, self.direct, self.diffuse = (
            fixed(column.copy()) for column in light.T
        )
        """(h,) float64: degrees above the horizon, degrees from north by east; irradiance across the
        sun's rays, and of open level ground by the sky, W/m^2."""

    @property
    def day_of_year(self) -> np.ndarray:
        """(h,) int32: number of the day of each hour, from 1."""
        return fixed(self.number // 24 + 1)

    def sun(
        self, up: Sequence[float] = (0.0, 0.0, 1.0), north: Sequence[float] = (0.0, 1.0, 0.0)
    ) -> np.ndarray:
        """(h, 3) float64: unit vectors towards the sun.

        up, north: (3,), of any length; north need not be level.
        """
        zenith = np.array(unit_vector("up", up))
        level = np.array(unit_vector("north", north))
        level = level - zenith * float(level @ zenith)
        if not np.linalg.norm(level) > 1e-9:
            raise InputError("north points up or down; give the direction of north on the ground")
        return self._data.suns(tuple(zenith), unit_vector("north", level))

    def __repr__(self) -> str:
        return (
            f"<lightwell.Weather: {self.place}, {len(self.number)} hours with light, "
            f"{self.latitude:g} N {self.longitude:g} E>"
        )


def read_weather(path: Union[str, "os.PathLike[str]"]) -> Weather:
    """Reads hourly weather of a year: .epw (EnergyPlus) or .wea (RADIANCE).

    Raises InputError with file, line, and what to do.
    """
    return Weather(_lightwell.read_weather(os.fspath(path)))
