"""Tables of the scene format, given as dictionaries, in the text that the library reads; text files."""

import contextlib
import json
import os
from typing import Any, Iterator, Mapping, TextIO

import numpy as np

from ._errors import Error, InputError


def toml_text(tables: Mapping[str, Any]) -> str:
    """A document of TOML. Arrays of NumPy count as lists; keys whose value is None are left out."""
    return "".join(f"{_key(key)} = {_value(key, value)}\n" for key, value in tables.items() if value is not None)


def toml_string(text: str) -> str:
    """A string of TOML, which has JSON's escapes but for pairs of surrogates, and escapes DEL too."""
    if any("\ud800" <= character <= "\udfff" for character in text):
        raise InputError(f"the text {text!r} holds half of a pair of surrogates, which is no character")
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def mapping_of(name: str, value: Any) -> Mapping[str, Any]:
    """A dictionary with text as keys."""
    if isinstance(value, Mapping):
        return value
    raise InputError(f"{name} is {value!r}; a dictionary with the keys of the scene format is needed")


def mappings_of(name: str, values: Any) -> list:
    """A list of dictionaries; a dictionary alone counts as a list of one."""
    if isinstance(values, Mapping):
        return [values]
    if isinstance(values, str) or not hasattr(values, "__iter__"):
        raise InputError(f"{name} is {values!r}; a list of dictionaries is needed")
    return [mapping_of(f"{name}[{number}]", value) for number, value in enumerate(values)]


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise InputError(f"the key {key!r} is no text; keys are those of the scene format")
    return toml_string(key)


MOST_LEVELS = 100
"""Levels of lists and dictionaries in each other; tables of a scene have few."""


def _value(name: str, value: Any, level: int = 0) -> str:
    if level > MOST_LEVELS:
        raise InputError(f"{name} has more than {MOST_LEVELS} levels of lists and dictionaries")
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return toml_string(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise InputError(f"{name} has the number {value}, which is beyond 64 bits")
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, Mapping):
        pairs = (f"{_key(key)} = {_value(key, each, level + 1)}" for key, each in value.items() if each is not None)
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(name, each, level + 1) for each in value) + "]"
    raise InputError(
        f"{name} has a value of type {type(value).__name__}; numbers, text, lists, arrays and dictionaries are known"
    )


@contextlib.contextmanager
def whole_file(path: str) -> Iterator[TextIO]:
    """A text file that takes the place of `path` once it is whole."""
    part = path + ".part"
    try:
        with open(part, "w", encoding="utf-8", newline="\n") as file:
            yield file
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: cannot be written: {error}") from None
    finally:
        with contextlib.suppress(OSError):
            os.remove(part)
