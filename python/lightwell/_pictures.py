"""Pictures: tone mapping, and files."""

import os
from typing import Any, Union

import numpy as np

from . import _lightwell
from ._arrays import array_of, real_number
from ._errors import InputError


def _picture(values: Any) -> np.ndarray:
    array = array_of("picture", values)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape:
        raise InputError(
            f"picture has the shape {array.shape}; (height, width, 3), as of Solution.render, is needed"
        )
    if max(array.shape) > 32768:
        raise InputError(f"picture has the shape {array.shape}; 32768 pixels along an edge are the most")
    return np.ascontiguousarray(array, dtype=np.float32)


def tone_map(picture: Any, exposure: float = 0.0) -> np.ndarray:
    """A picture for screens: (height, width, 3) uint8, sRGB.

    picture: linear radiance, (height, width, 3), as of `Solution.render`.
    exposure: stops, added to the automatic exposure.
    """
    return _lightwell.tone_map(_picture(picture), real_number("exposure", exposure))


def write_picture(path: Union[str, "os.PathLike[str]"], picture: Any, exposure: float = 0.0) -> None:
    """Writes a picture: .exr (32-bit radiance), .hdr (RADIANCE) or .png (see `tone_map`)."""
    _lightwell.write_picture(os.fspath(path), _picture(picture), real_number("exposure", exposure))
