"""The daylight of a year and of instants, as arrays."""

import datetime
import json
import os
from functools import cached_property
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _lightwell
from ._arrays import array_of, checked_progress
from ._errors import Error, InputError
from ._scene import Path, Progress, fixed

Time = Union[str, datetime.datetime]
HOURS_A_DAY = 24


class DaylightMeasures(NamedTuple):
    """Measures of a year, (s,) float64, of s sensors; views. Unless told otherwise: % of occupied hours."""

    autonomy: np.ndarray
    """DA300: 300 lx or more."""
    continuous_autonomy: np.ndarray
    """cDA300: mean of min(E / 300 lx, 1)."""
    below_100: np.ndarray
    """UDI, fell short: below 100 lx."""
    from_100_to_300: np.ndarray
    """UDI, supplementary: 100 lx to below 300 lx."""
    from_300_to_3000: np.ndarray
    """UDI, autonomous: 300 lx to 3000 lx."""
    above_3000: np.ndarray
    """UDI, exceeded: above 3000 lx."""
    sun_hours: np.ndarray
    """Occupied hours with 1000 lx or more straight from the sun."""
    mean_lux: np.ndarray
    """lx, mean of all hours of the year, nights included."""
    en_above_100: np.ndarray
    """EN 17037: % of the half of the hours with most light of the dome that have 100 lx."""
    en_above_300: np.ndarray
    en_above_500: np.ndarray
    en_above_750: np.ndarray
    en_median_lux: np.ndarray
    """lx, what half of those hours reach, to 1.6 %."""


class DaylightGlare(NamedTuple):
    """Glare of an observer in the h hours with light."""

    observer: str
    dgp: np.ndarray
    """(h,) float32, daylight glare probability, 0 to 1; a view."""
    vertical_lux: np.ndarray
    """(h,) float32, lx at the eye; a view."""


class DaylightRoom:
    """Sensors that are judged together: those of a grid, or `points`."""

    def __init__(self, found: Tuple[Any, ...], places: Tuple[np.ndarray, np.ndarray], figures: Dict[str, Any]):
        name, first, count, grid = found
        self.name: str = name
        self.sensors: slice = slice(first, first + count)
        """Where its sensors are among all."""
        self.points: np.ndarray = places[0][self.sensors]
        """(n, 3) float64, metres; a view."""
        self.normals: np.ndarray = places[1][self.sensors]
        """(n, 3) float64, the directions that the sensors face; a view."""
        self.figures: Dict[str, Any] = figures
        """Figures of the room, by the keys of year.json or instant.json."""
        self.shape: Optional[Tuple[int, int]] = None
        """Rows and columns of the grid; None for points."""
        self.extent: Optional[Tuple[float, float, float, float]] = None
        """0, width, 0 and depth of the grid in metres along its axes, for `imshow`; None for points."""
        self._cell: Optional[np.ndarray] = None
        if grid is not None:
            rows, columns, self._cell, corner, along, across, step_u, step_v = grid
            self.shape = rows, columns
            self.extent = 0.0, columns * step_u, 0.0, rows * step_v
            self.corner: np.ndarray = fixed(np.array(corner))
            """(3,) metres: outer corner of the first cell of a grid."""
            self.axes: np.ndarray = fixed(np.array([along, across]))
            """(2, 3): unit vectors along columns and along rows of a grid."""

    def image(self, values: Any) -> np.ndarray:
        """Values of sensors as a picture of the grid, for `imshow(..., origin="lower", extent=room.extent)`.

        values: (..., s) of all sensors, or (..., n) of this room's, real numbers.

        Returns (..., rows, columns) float64, NaN where the grid has no sensor; rows run along
        `axes[1]`. Raises InputError for a room without a grid, and for values of another length.
        """
        if self.shape is None or self._cell is None:
            raise InputError(f"'{self.name}' has points without a grid; plot room.points instead")
        array = array_of("values", values)
        if array.ndim and array.shape[-1] > len(self.points):
            array = array[..., self.sensors]
        if array.ndim == 0 or array.shape[-1] != len(self.points):
            raise InputError(
                f"values has the shape {np.shape(values)}; (..., {len(self.points)}), a value for each sensor of "
                f"'{self.name}', or one for each of all, is needed"
            )
        picture = np.full(array.shape[:-1] + (self.shape[0] * self.shape[1],), np.nan)
        picture[..., self._cell] = array
        return picture.reshape(array.shape[:-1] + self.shape)

    def __repr__(self) -> str:
        of = "" if self.shape is None else f" in {self.shape[0]} x {self.shape[1]} cells"
        return f"<lightwell.DaylightRoom '{self.name}': {len(self.points)} sensors{of}>"


class DaylightInstant:
    """The daylight of one instant; made by `daylight_at` and `DaylightYear.at`. s is the number of sensors.

    Arrays are read-only.
    """

    def __init__(self, data: "_lightwell.DaylightInstantData"):
        if not isinstance(data, _lightwell.DaylightInstantData):
            raise InputError("a DaylightInstant is made by lightwell.daylight_at(scene, weather, when)")
        self._data = data
        self.when: str = data.when
        """Date and standard time."""
        self.lux: np.ndarray = data.lux
        """(s,) float32, lx; a view."""
        self.sun_lux: np.ndarray = data.sun_lux
        """(s,) float32, lx straight from the sun; a view."""
        self.figures: Dict[str, Any] = json.loads(data.figures)
        """All figures, by the keys that `lightwell daylight --at ... --json` prints."""
        self.points, self.normals = (fixed(places) for places in data.places)
        """(s, 3) float64, metres, and the directions that the sensors face."""

    @cached_property
    def rooms(self) -> List[DaylightRoom]:
        """The grids, sensor grids and points, in the order of the sensors."""
        return _rooms(self._data.rooms, (self.points, self.normals), self.figures)

    def save(self, folder: Path) -> None:
        """Writes instant.csv and instant.html, as `lightwell daylight --at` does. Makes the folder."""
        _lightwell.save_instant(self._data, _made_folder(folder))

    def __repr__(self) -> str:
        return f"<lightwell.DaylightInstant: {self.when}, {len(self.lux)} sensors, mean {self.lux.mean():.6g} lx>"


class DaylightYear:
    """The daylight of a year at sensors; made by `daylight`. Never changed afterwards; arrays are read-only.

    s is the number of sensors, h that of the hours with light. Those named as views share the year's
    memory, which lives as long as any of them.
    """

    def __init__(self, data: "_lightwell.DaylightYearData"):
        if not isinstance(data, _lightwell.DaylightYearData):
            raise InputError("a DaylightYear is made by lightwell.daylight(scene, weather)")
        self._data = data
        self.number, self.month, self.day, self.hour = (fixed(column.copy()) for column in data.dates.T)
        """(h,) int32: hour of the year from 0, month, day, and hour of the day from 0, standard time."""
        self.altitude, self.azimuth, self.outdoor_sun_lux, self.outdoor_dome_lux = (
            fixed(column.copy()) for column in data.sky.T
        )
        """(h,) float64: the sun's degrees above the horizon and from north by east; lx across the sun's
        rays, and of the dome on open level ground."""
        self.points, self.normals = (fixed(places) for places in data.places)
        """(s, 3) float64, metres, and the directions that the sensors face."""
        self.metrics, self.least, self.most = (DaylightMeasures(*values) for values in data.measures)
        """Measures, and those of less and of more light by the bound of its error (odds of about 19 to 1)."""
        self.figures: Dict[str, Any] = json.loads(data.figures)
        """All figures of rooms, ratings, windows, observers and sun points, by the keys of year.json."""

    # The hours.

    @property
    def lux(self) -> np.ndarray:
        """(h, s) float32, lx; a view."""
        return self._data.lux

    @property
    def sun_lux(self) -> np.ndarray:
        """(h, s) float32, the part of `lux` straight from the sun; a view."""
        return self._data.sun_lux

    @property
    def window_states(self) -> np.ndarray:
        """(h, g) int32: state of each of g groups of windows, an index into its states; a view."""
        return self._data.window_states

    def calendar(self, values: Any) -> np.ndarray:
        """Values of the hours as a picture of the year, for `imshow(..., origin="lower", aspect="auto")`.

        values: (h,) real numbers, such as `year.lux[:, 0]`.

        Returns (24, days) float64, NaN where it is dark.
        """
        array = array_of("values", values)
        if array.shape != self.number.shape:
            raise InputError(f"values has the shape {array.shape}; ({len(self.number)},), one for each hour, is needed")
        picture = np.full((HOURS_A_DAY, self._data.days), np.nan)
        picture[self.number % HOURS_A_DAY, self.number // HOURS_A_DAY] = array
        return picture

    # The measures.

    @property
    def error(self) -> float:
        """Bound of the error of the year's light without direct sun, relative, odds of about 19 to 1."""
        return float(self.figures["relative_error"])

    @cached_property
    def daylight_factor(self) -> np.ndarray:
        """(s,) float64, %: share of open ground's illuminance under CIE's overcast sky."""
        return fixed(100.0 * self._data.daylight_factor.astype(np.float64))

    @cached_property
    def rooms(self) -> List[DaylightRoom]:
        """The grids, sensor grids and points, in the order of the sensors, with their figures: sDA, ASE, EN 17037,
        energy of lamps."""
        return _rooms(self._data.rooms, (self.points, self.normals), self.figures)

    @cached_property
    def glare(self) -> List[DaylightGlare]:
        """Glare of each observer."""
        return [DaylightGlare(*of_eye) for of_eye in self._data.glare]

    @property
    def ratings(self) -> List[Dict[str, Any]]:
        """Points and figures of each rating, by the keys of year.json."""
        return list(self.figures.get("ratings", ()))

    @property
    def notes(self) -> List[str]:
        """What is missing in the weather or the scene, a sentence each."""
        return list(self.figures["notes"])

    @property
    def conventions(self) -> List[str]:
        """What is assumed, a sentence each."""
        return list(self.figures["conventions"])

    # Instants and files.

    def at(
        self, when: Union[Time, Sequence[Time]], *, progress: Optional[Progress] = None
    ) -> Union[DaylightInstant, List[DaylightInstant]]:
        """The daylight of an instant of this weather, or of several: see `daylight_at`."""
        return instants(self._data.study, when, progress)

    def save(self, folder: Path, *, hourly: bool = False) -> None:
        """Writes the files that `lightwell daylight` writes: sensors.csv, hours.csv, year.html, year.json and others.

        folder: made if it is not there.
        hourly: also illuminance.npy and sunlight.npy, (h, s) float32.

        Raises Error with the file and the reason.
        """
        _lightwell.save_year(self._data, _made_folder(folder), bool(hourly))

    def __str__(self) -> str:
        return str(self._data.text).rstrip("\n")

    def __repr__(self) -> str:
        rooms = ", ".join(
            f"{room.name} (sDA {room.figures['sDA300_50']['value']:.3g} %, EN 17037 {room.figures['en_17037']['level']})"
            for room in self.rooms[:4]
        )
        more = f" and {len(self.rooms) - 4} more" if len(self.rooms) > 4 else ""
        return (
            f"<lightwell.DaylightYear: {self.figures['weather']['place']}, {len(self.number)} hours with light, "
            f"{len(self.points)} sensors, error {100 * self.error:.2g} %: {rooms}{more}>"
        )


def _time_text(when: Any) -> str:
    if isinstance(when, str):
        return when
    if not isinstance(when, datetime.datetime):
        raise InputError(f"the instant is {when!r}; give text such as '2024-11-21 15:30', or a datetime")
    if when.tzinfo is not None:
        raise InputError(f"the instant {when} has a time zone; give the weather's standard time without one")
    if when.second or when.microsecond:
        raise InputError(f"the instant {when} has seconds; give whole minutes")
    return when.isoformat(sep=" ", timespec="minutes")


def instants(
    study: "_lightwell.DaylightStudy", when: Union[Time, Sequence[Time]], progress: Optional[Progress]
) -> Union[DaylightInstant, List[DaylightInstant]]:
    is_one = isinstance(when, (str, datetime.datetime)) or not hasattr(when, "__iter__")
    texts = [_time_text(when)] if is_one else [_time_text(time) for time in when]  # type: ignore[union-attr]
    made = [DaylightInstant(data) for data in _lightwell.daylight_instants(study, texts, checked_progress(progress))]
    return made[0] if is_one else made


def _rooms(
    found: Sequence[Tuple[Any, ...]], places: Tuple[np.ndarray, np.ndarray], figures: Mapping[str, Any]
) -> List[DaylightRoom]:
    return [DaylightRoom(room, places, of_room) for room, of_room in zip(found, figures["rooms"])]


def _made_folder(folder: Path) -> str:
    path = os.fspath(folder)
    try:
        os.makedirs(path, exist_ok=True)
    except OSError as error:
        raise Error(f"{path}: the folder cannot be made: {error.strerror}") from None
    return path
