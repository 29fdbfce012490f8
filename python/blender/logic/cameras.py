"""Cameras of a scene file from Blender's lens, sensor and shift."""

import math
from dataclasses import dataclass
from typing import Dict, Optional, Tuple

Vector = Tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A camera as Blender has it: millimetres of lens and sensor, metres in the world."""

    name: str
    position: Vector
    direction: Vector
    up: Vector
    is_orthographic: bool = False
    lens: float = 50.0
    sensor: Tuple[float, float] = (36.0, 24.0)
    fit: str = "AUTO"
    """"AUTO", "HORIZONTAL" or "VERTICAL": the side of the picture that the sensor's size is that of."""
    shift: Tuple[float, float] = (0.0, 0.0)
    """In shares of the fitted side."""
    view: float = 6.0
    """Of an orthographic camera: metres along the fitted side."""
    pixels: Tuple[int, int] = (1920, 1080)
    pixel_aspect: float = 1.0
    """Width of a pixel by its height."""
    near: float = 0.0
    far: float = math.inf
    f_number: Optional[float] = None
    focus: float = 10.0


def camera_table(camera: Camera) -> Dict[str, object]:
    """Keys of `[[cameras]]`; pixels are square, so other pixels change the picture's height."""
    width = camera.pixels[0]
    height = max(1, round(camera.pixels[1] / camera.pixel_aspect))
    is_wide = camera.fit == "HORIZONTAL" or (camera.fit == "AUTO" and width >= height)
    fitted = width if is_wide else height
    table: Dict[str, object] = {
        "name": camera.name,
        "position": list(camera.position),
        "direction": list(camera.direction),
        "up": list(camera.up),
        "size": [width, height],
    }
    if camera.is_orthographic:
        table["projection"] = "orthographic"
        table["view_width"] = camera.view * width / fitted
    else:
        # AUTO has the sensor's width on the longer side.
        sensor = camera.sensor[1] if camera.fit == "VERTICAL" else camera.sensor[0]
        half = 0.5 * sensor * width / fitted / camera.lens
        table["fov"] = math.degrees(2 * math.atan(half))
    if camera.shift != (0.0, 0.0):
        table["shift"] = [camera.shift[0] * fitted / width, camera.shift[1] * fitted / height]
    if camera.near > 0.0:
        table["near"] = camera.near
    if math.isfinite(camera.far):
        table["far"] = camera.far
    if camera.f_number and not camera.is_orthographic:
        table["aperture_radius"] = camera.lens / 1000.0 / (2.0 * camera.f_number)
        table["focus_distance"] = camera.focus
    return table


def metres_per_unit(system: str, scale_length: float) -> float:
    """Metres in one unit of length of a Blender scene; without a system of units, one metre."""
    return 1.0 if system == "NONE" else float(scale_length)
