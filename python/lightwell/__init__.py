"""Lightwell: radiosity with a ray-traced second pass.

    import lightwell as lw

    scene = lw.read("room.toml")                      # or lw.Scene.from_arrays(vertices, faces, ...)
    F, report = lw.form_factors(scene)                # scipy.sparse.csr_array of view factors
    solution = lw.solve(scene, accuracy="1%")         # arrays of light on a mesh
    lux = solution.lux_at(points, normals)
    picture = solution.render("camera", width=640)    # height x width x 3, float32

Lengths are metres, irradiance and radiosity W/m^2 per band, and angles degrees, whatever the unit of
a scene's file. Exceptions are sentences: `InputError` for wrong input, `Interrupted` where a progress
callback said stop, and `Error`, the base of both, for everything else.

Functions that take long let other Python threads run, and several may run at once in several threads.
Those that take `progress`, except `read`, end within about a second after Ctrl-C. Results have the
same bits for any number of threads.
"""

from ._errors import Error, InputError, Interrupted  # isort: skip  (the compiled module needs it)
from ._camera import Camera
from ._daylight import daylight, daylight_at
from ._daylight_year import DaylightGlare, DaylightInstant, DaylightMeasures, DaylightRoom, DaylightYear
from ._form_factors import FormFactors, form_factors
from ._ifc import convert_ifc, from_ifc
from ._lightwell import thread_count
from ._lightwell import version as __version__
from ._lightmaps import Lightmap, Lightmaps
from ._material import Material
from ._pictures import tone_map, write_picture
from ._radiation import Radiation, radiation
from ._scene import Scene, read
from ._shortwave import PointLight, Shortwave, shortwave
from ._solution import Readings, Solution
from ._solve import load, solve
from ._threads import thread_limit
from ._weather import Weather, read_weather

__all__ = [
    "Camera",
    "DaylightGlare",
    "DaylightInstant",
    "DaylightMeasures",
    "DaylightRoom",
    "DaylightYear",
    "Error",
    "FormFactors",
    "InputError",
    "Interrupted",
    "Lightmap",
    "Lightmaps",
    "Material",
    "PointLight",
    "Radiation",
    "Readings",
    "Scene",
    "Shortwave",
    "Solution",
    "Weather",
    "__version__",
    "convert_ifc",
    "daylight",
    "daylight_at",
    "form_factors",
    "from_ifc",
    "load",
    "radiation",
    "read",
    "read_weather",
    "shortwave",
    "solve",
    "thread_count",
    "thread_limit",
    "tone_map",
    "write_picture",
]
