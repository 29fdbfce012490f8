"""Cameras."""

from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Sequence

from . import _lightwell
from ._arrays import real_number, whole_number
from ._errors import InputError
from ._toml import toml_text


@dataclass(frozen=True)
class Camera:
    """A place to look from. Lengths in metres, angles in degrees, sizes in pixels, times in seconds.

    Options that a projection has no use for are refused, as in a scene file (docs/cameras.md).
    """

    position: Sequence[float]
    target: Sequence[float]
    """A point that is seen in the middle of the picture."""
    up: Sequence[float] = (0.0, 0.0, 1.0)
    """The direction that is upwards in the picture."""
    fov: Optional[float] = None
    """Full horizontal angle, above 0 and below 180 for perspective; None: the usual one of the
    projection, 40 for perspective. Orthographic cameras and cubes have none."""
    width: Optional[int] = None
    height: Optional[int] = None
    """Size of the whole picture, 1 to 32768; None: 512, or the usual size of the projection if both
    are None."""
    projection: str = "perspective"
    """"perspective", "orthographic", "fisheye", "equisolid", "hemispherical", "stereographic",
    "cylindrical", "equirectangular", "stereo" or "cube"."""
    name: str = "camera"
    shift: Sequence[float] = (0.0, 0.0)
    """Shift of the lens to the right and upwards, in shares of the picture's width and height, -100
    to 100."""
    distortion: Sequence[float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    """Coefficients k1, k2, k3, p1, p2 of Brown's lens distortion, of perspective cameras."""
    view_width: Optional[float] = None
    """Width that an orthographic picture shows, above 0, which such a camera needs."""
    near: float = 0.0
    """Nothing nearer is seen, 0 or more: a plane at right angles to the view of perspective and
    orthographic cameras, which cuts rooms open; a sphere of others."""
    far: Optional[float] = None
    """Nothing farther is seen, above `near`; None: no end."""
    crop: Sequence[float] = (0.0, 0.0, 1.0, 1.0)
    """The part of the picture that is rendered: left, top, right and bottom, in shares of its width
    and height, 0 to 1."""
    circle: Optional[float] = None
    """Full angle of a fisheye's circle, beyond which the picture is black; None: `fov`."""
    eye_separation: Optional[float] = None
    """Distance between the eyes of a "stereo" panorama, 0 or more; None: 0.063."""
    f_number: Optional[float] = None
    """Aperture of a perspective camera with a film 36 mm wide, above 0: 2 blurs much, 16 little."""
    aperture_radius: Optional[float] = None
    """Radius of the lens of a perspective camera, above 0, in place of `f_number`; None of both: a
    pinhole, which shows everything sharp."""
    focus_distance: Optional[float] = None
    """Distance along the view to the plane that is sharp, above 0, which a lens needs."""
    blades: Optional[int] = None
    """Blades of the aperture, 3 to 64; None: round."""
    shutter: Optional[Sequence[float]] = None
    """Times at which the shutter opens and closes; None: the instant that light is solved for."""
    motion: Optional[str] = None
    """Name of the motion of the scene by which the camera moves; None: it stands still."""

    def _table(self) -> Dict[str, Any]:
        """The keys of a camera of the scene format; those left at their default are not given."""
        table: Dict[str, Any] = {
            "name": str(self.name),
            "position": _numbers("position", self.position, 3),
            "look_at": _numbers("target", self.target, 3),
            "up": _numbers("up", self.up, 3),
            "projection": str(self.projection),
            "size": self._size(),
            "motion": self.motion,
        }
        for key in ("view_width", "far", "circle", "eye_separation", "f_number", "aperture_radius", "focus_distance"):
            table[key] = _number_or_none(key, getattr(self, key))
        table["fov"] = _number_or_none("fov", self.fov)
        if self.near != 0.0:
            table["near"] = real_number("near", self.near)
        if self.blades is not None:
            table["blades"] = whole_number("blades", self.blades, 3, 64)
        if self.shutter is not None:
            table["shutter"] = _numbers("shutter", self.shutter, 2)
        shift, crop = _numbers("shift", self.shift, 2), _numbers("crop", self.crop, 4)
        table["shift"] = shift if any(shift) else None
        table["crop"] = crop if crop != [0.0, 0.0, 1.0, 1.0] else None
        lens = _numbers("distortion", self.distortion, 5)
        table["distortion"] = dict(zip(("k1", "k2", "k3", "p1", "p2"), lens)) if any(lens) else None
        return table

    def _size(self) -> Optional[List[int]]:
        if self.width is None and self.height is None:
            return None
        size = {"width": self.width, "height": self.height}
        return [512 if value is None else whole_number(key, value, 1, 32768) for key, value in size.items()]

    def _compiled(self, scene: Optional["_lightwell.SceneData"]) -> "_lightwell.Camera":
        """The camera in a picture of this scene."""
        return _lightwell.camera_of(scene, toml_text(self._table()))


def _numbers(name: str, values: Any, count: int) -> List[float]:
    try:
        numbers = [real_number(name, value) for value in values]
    except TypeError:
        raise InputError(f"{name} is {values!r}; {count} numbers are needed") from None
    if len(numbers) != count:
        raise InputError(f"{name} has {len(numbers)} numbers; {count} are needed")
    return numbers


def _number_or_none(name: str, value: Any) -> Optional[float]:
    return None if value is None else real_number(name, value)


def camera_of(compiled: "_lightwell.Camera", motions: Sequence[str]) -> Camera:
    """A camera that the library holds; `motions`: names of those of its scene."""
    ahead = zip(compiled.position, compiled.direction)
    return Camera(
        position=tuple(compiled.position),
        target=tuple(place + way for place, way in ahead),
        up=tuple(compiled.up),
        fov=compiled.fov_degrees,
        width=compiled.width,
        height=compiled.height,
        projection=compiled.projection,
        name=compiled.name,
        shift=tuple(compiled.shift),
        distortion=tuple(compiled.distortion),
        view_width=compiled.view_width,
        near=compiled.near_distance,
        far=compiled.far_distance,
        crop=tuple(compiled.crop),
        circle=compiled.circle,
        eye_separation=compiled.eye_separation,
        aperture_radius=compiled.aperture_radius,
        focus_distance=compiled.focus_distance,
        blades=compiled.blades,
        shutter=None if compiled.shutter is None else tuple(compiled.shutter),
        motion=motions[compiled.motion] if compiled.motion >= 0 else None,
    )
