"""Checks of arrays and numbers from users. Each raises InputError with a sentence."""

import operator
from typing import Any, Iterable, List, Mapping, Tuple

import numpy as np

from ._errors import InputError


def array_of(name: str, values: Any) -> np.ndarray:
    """The values as an array; not ragged lists, and not objects."""
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:
        raise InputError(f"{name} is no array of numbers: {error}") from None
    if array.dtype.kind not in "fiu":
        raise InputError(
            f"{name} has elements of type {array.dtype}; give real numbers, as float or integer"
        )
    return array


def points_of(name: str, values: Any) -> np.ndarray:
    """Points or directions: n x 3, float64, finite, in one piece of memory."""
    array = array_of(name, values)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(
            f"{name} has the shape {array.shape}; n points of three coordinates, (n, 3), are needed"
        )
    array = np.ascontiguousarray(array, dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise InputError(
            f"{name}: row {bad[0]} has a coordinate that is not a finite number"
            + (f", as have {bad.size - 1} others" if bad.size > 1 else "")
        )
    return array


def directions_of(name: str, values: Any, count: int) -> np.ndarray:
    """A direction for each of `count` points, or one for all: count x 3, none of them zero."""
    array = array_of(name, values)
    if array.ndim == 1:
        array = array[np.newaxis]
    array = points_of(name, array)
    if len(array) not in (1, count):
        raise InputError(f"{name} has {len(array)} rows for {count} points; give one for each, or one")
    if not (np.linalg.norm(array, axis=1) > 0.0).all():
        raise InputError(f"{name}: a direction is zero; give the direction that each point faces")
    return np.ascontiguousarray(np.broadcast_to(array, (count, 3)))


def unit_vector(name: str, direction: Any) -> Tuple[float, float, float]:
    """A direction of any length but 0 as a unit vector."""
    vector = directions_of(name, direction, 1)[0]
    x, y, z = vector / np.linalg.norm(vector)
    return float(x), float(y), float(z)


def integers_of(name: str, values: Any, dtype: type = np.int32) -> np.ndarray:
    """A list of integers within the range of `dtype`, in one piece of memory."""
    array = array_of(name, values)
    if array.ndim != 1:
        raise InputError(f"{name} has the shape {array.shape}; a list of integers, (n,), is needed")
    if array.dtype.kind == "f" and array.size:
        raise InputError(f"{name} has elements of type {array.dtype}; integers are needed")
    limits = np.iinfo(dtype)
    if array.size and (array.max() > limits.max or array.min() < limits.min):
        raise InputError(f"{name} has a number beyond {limits.max}")
    return np.ascontiguousarray(array, dtype=dtype)


def faces_of(faces: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Corners of all faces in a row (int32), and where each face begins (int64, one more)."""
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        if faces.ndim != 2 or faces.shape[1] < 3:
            raise InputError(
                f"faces has the shape {faces.shape}; m faces of k >= 3 corners, (m, k), are needed"
            )
        first = np.arange(len(faces) + 1, dtype=np.int64) * faces.shape[1]
        return integers_of("faces", faces.reshape(-1)), first
    corners: List[np.ndarray] = []
    try:
        for number, face in enumerate(faces):
            corners.append(integers_of(f"face {number}", face))
    except TypeError:
        raise InputError(
            "faces is no array of integers and no list of faces, each a list of vertex numbers"
        ) from None
    first = np.zeros(len(corners) + 1, dtype=np.int64)
    np.cumsum([len(face) for face in corners], out=first[1:])
    return (np.concatenate(corners) if corners else np.zeros(0, np.int32)), first


def whole_number(name: str, value: Any, least: int, most: int) -> int:
    """A whole number from `least` to `most`."""
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if not least <= number <= most:
        raise InputError(f"{name} is {value!r}; a whole number from {least} to {most} is needed")
    return number


def real_number(name: str, value: Any) -> float:
    """A finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {value!r}; a number is needed") from None
    if not np.isfinite(number):
        raise InputError(f"{name} is {number}; a finite number is needed")
    return number


def at_least_zero(name: str, value: Any) -> float:
    """A finite number of 0 or more."""
    number = real_number(name, value)
    if number < 0.0:
        raise InputError(f"{name} is {number:g}; a number of 0 or more is needed")
    return number


def share_text(value: Any) -> str:
    """A share as the library reads it: 0.01 as "0.01"; text as it is."""
    return value if isinstance(value, str) else repr(float(value))


def set_options(options: Any, asked: Mapping[str, Any], shares: Iterable[str] = ()) -> None:
    """Sets those options that are not None on a compiled set of options."""
    for name, value in asked.items():
        if value is None:
            continue
        try:
            setattr(options, name, share_text(value) if name in shares else value)
        except (TypeError, ValueError, OverflowError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"{name} is {value!r}, which is of the wrong type or too large") from None


def checked_progress(progress: Any) -> Any:
    """None, or a callable."""
    if progress is None or callable(progress):
        return progress
    raise InputError(
        f"progress is {progress!r}; give a function of the phase (text) and the share done (0 to 1)"
    )
