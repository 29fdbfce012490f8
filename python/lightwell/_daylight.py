"""A year of daylight, and instants of it, from a scene and its weather."""

import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _lightwell
from ._arrays import at_least_zero, checked_progress, directions_of, points_of, real_number, set_options
from ._camera import Camera
from ._daylight_year import DaylightInstant, DaylightYear, Time, instants
from ._errors import InputError
from ._scene import Path, Progress, Scene
from ._weather import Weather, read_weather

Observer = Union[Camera, str]


def daylight(
    scene: Scene,
    weather: Union[Weather, Path],
    *,
    planes: Mapping[str, float] = {},
    surfaces: Sequence[str] = (),
    margin: Optional[float] = None,
    spacing: Optional[float] = None,
    points: Any = None,
    normals: Any = None,
    observers: Union[Observer, Sequence[Observer]] = (),
    sun_points: Any = None,
    sun_day: str = "03-21",
    least_sun: float = 0.0,
    ratings: Union[str, Sequence[str]] = (),
    rating_table: Optional[Path] = None,
    rooms: Optional[Path] = None,
    occupied: Union[Tuple[int, int], str] = (8, 18),
    windows: Optional[Path] = None,
    north: float = 0.0,
    ground: float = 0.2,
    sky: Optional[int] = None,
    rays: Optional[int] = None,
    max_patch_size: Optional[float] = None,
    walk: Optional[Path] = None,
    progress: Optional[Progress] = None,
) -> DaylightYear:
    """The daylight of every hour of a year at sensors, as `lightwell daylight` computes it.

    weather: an .epw or .wea file, or a `Weather`.
    planes: heights above surfaces with sensors, metres, by the name of the surface: {"floor": 0.8};
        besides [[grids]] of the scene.
    surfaces: names of surfaces that have sensors themselves.
    margin, spacing: strip along the outline of planes without sensors (0.5), and largest distance between
        sensors (by EN 12464-1), metres.
    points, normals: sensors one by one, (n, 3), metres, and the directions that they face, (n, 3) or (3,), of
        any length (0, 0, 1).
    observers: cameras (`Camera`, or names of the scene's) for whose eyes glare (DGP) is counted.
    sun_points: (n, 3), metres, points of windows whose hours of sun are counted (EN 17037).
    sun_day, least_sun: "MM-DD" from 02-01 to 03-21; least altitude of the sun, degrees, 0 to 89.
    ratings: "leed", "breeam-office", ...; rating_table: .toml in place of the program's.
    rooms: .toml, use of rooms and their lamps, whose energy daylight saves (EN 15193-1).
    occupied: occupied hours of every day, standard time: (8, 18), or "8-18".
    windows: .toml, states of windows and their operation, in place of the scene's [[windows]].
    north: degrees by which north is turned clockwise from that of the scene's sky, -360 to 360.
    ground: reflectance of the ground outside of the scene, 0 to 1.
    sky: subdivision of Tregenza's 145 patches, each way, 1 to 8 (4).
    rays: gather rays of a sensor, a power of two (4096).
    max_patch_size: longest edge of patches, metres (about 3200 patches).
    walk: .html, also writes a page to walk in at all hours, windows in their first states.
    progress: called with the phase and the share done; False stops the work.

    With the same options the numbers are those of the command line, bit for bit. Ctrl-C raises
    KeyboardInterrupt within about a second; then there is no year.

    Raises InputError, e.g. for a scene without sensors, and Interrupted after False.
    """
    asked = {name: value for name, value in locals().items() if name not in ("scene", "weather", "walk", "progress")}
    page = "" if walk is None else os.fspath(walk)
    if page and os.path.splitext(page)[1] != ".html":
        raise InputError(f"'{page}' must end in .html")
    study = _study(scene, weather, asked)
    return DaylightYear(_lightwell.daylight_year(study, page, checked_progress(progress)))


def daylight_at(
    scene: Scene,
    weather: Union[Weather, Path],
    when: Union[Time, Sequence[Time]],
    *,
    planes: Mapping[str, float] = {},
    surfaces: Sequence[str] = (),
    margin: Optional[float] = None,
    spacing: Optional[float] = None,
    points: Any = None,
    normals: Any = None,
    windows: Optional[Path] = None,
    north: float = 0.0,
    ground: float = 0.2,
    sky: Optional[int] = None,
    rays: Optional[int] = None,
    max_patch_size: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> Union[DaylightInstant, List[DaylightInstant]]:
    """The daylight of an instant, or of several, as `lightwell daylight --at` computes it.

    when: "2024-11-21 15:30" or a `datetime` without time zone, in standard time, 1950 to 2050. A list of them gives
        a list, and the exchange of light in the room is computed once for all.
    Others: those of `daylight`.

    Raises InputError, e.g. for an instant by night, and Interrupted after False.
    """
    asked = {name: value for name, value in locals().items() if name not in ("scene", "weather", "when", "progress")}
    return instants(_study(scene, weather, asked), when, progress)


def _study(scene: Scene, weather: Union[Weather, Path], options: Mapping[str, Any]) -> "_lightwell.DaylightStudy":
    """The inputs of a year or an instant; None stands for the default."""
    if not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    if not isinstance(weather, (Weather, str, os.PathLike)):
        raise InputError(f"weather is {weather!r}; give a lightwell.Weather, or a file, .epw or .wea")
    settings = _lightwell.DaylightSettings()
    asked = {name: value for name, value in options.items() if value is not None}
    _set_sensors(settings, asked)
    _set_people(settings, scene, asked)
    files = {name: os.fspath(asked[name]) for name in ("windows", "rooms", "rating_table") if name in asked}
    numbers = {name: asked[name] for name in ("sky", "rays", "max_patch_size") if name in asked}
    set_options(settings, {**files, **numbers})
    settings.north = _between("north", asked.get("north", 0.0), -360.0, 360.0)
    settings.ground = _between("ground", asked.get("ground", 0.2), 0.0, 1.0)
    year = weather if isinstance(weather, Weather) else read_weather(weather)
    return _lightwell.daylight_study(scene._data, year._data, settings)


def _set_sensors(settings: "_lightwell.DaylightSettings", asked: Mapping[str, Any]) -> None:
    planes = asked.get("planes", {})
    if not isinstance(planes, Mapping):
        raise InputError(f"planes is {planes!r}; give heights by the name of the surface, such as {{'floor': 0.8}}")
    for name, height in planes.items():
        settings.add_plane(str(name), at_least_zero(f"the height above {name}", height))
    settings.surfaces = _names("surfaces", asked.get("surfaces", ()))
    if "margin" in asked:
        settings.margin = at_least_zero("margin", asked["margin"])
    if "spacing" in asked:
        set_options(settings, {"spacing": asked["spacing"]})
    if "points" in asked:
        places = points_of("points", asked["points"])
        settings.set_points(places, directions_of("normals", asked.get("normals", (0.0, 0.0, 1.0)), len(places)))
    elif "normals" in asked:
        raise InputError("normals are given without points; give both, or planes")


def _set_people(settings: "_lightwell.DaylightSettings", scene: Scene, asked: Mapping[str, Any]) -> None:
    observers = asked.get("observers", ())
    for eye in [observers] if isinstance(observers, (str, Camera)) else observers:
        if isinstance(eye, Camera):
            settings.add_observer(eye._compiled(scene._data))
        elif isinstance(eye, str):
            settings.add_observer_named(scene._data, eye)
        else:
            raise InputError(f"an observer is {eye!r}; give a lightwell.Camera or a camera's name")
    if "sun_points" in asked:
        settings.set_sun_points(points_of("sun_points", asked["sun_points"]))
    settings.set_sun_day(str(asked.get("sun_day", "03-21")), _between("least_sun", asked.get("least_sun", 0.0), 0.0, 89.0))
    settings.ratings = _names("ratings", asked.get("ratings", ()))
    occupied = asked.get("occupied", (8, 18))
    if not isinstance(occupied, str):
        if np.ndim(occupied) != 1:
            raise InputError(f"occupied is {occupied!r}; two hours such as (8, 18) are needed")
        occupied = "-".join(str(hour) for hour in occupied)
    settings.set_occupied(occupied)


def _names(name: str, values: Any) -> List[str]:
    listed = [values] if isinstance(values, str) else list(values)
    if not all(isinstance(value, str) for value in listed):
        raise InputError(f"{name} is {values!r}; a list of names is needed")
    return listed


def _between(name: str, value: Any, least: float, most: float) -> float:
    number = real_number(name, value)
    if not least <= number <= most:
        raise InputError(f"{name} is {number:g}; a number from {least:g} to {most:g} is needed")
    return number
