"""Values as text of a TOML file."""

import json
from typing import Any, Dict, List, Mapping, Set


def quoted(text: str) -> str:
    """A basic string; characters that TOML does not allow are escaped."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def value_text(value: Any) -> str:
    """A value in one line. Floats keep all their digits."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {value_text(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    return repr(float(value))


def table_text(head: str, table: Mapping[str, Any]) -> str:
    """A table under its heading, such as `[bands]` or `[[surfaces]]`, a line for each key."""
    return "\n".join([head, *(f"{key} = {value_text(value)}" for key, value in table.items())]) + "\n"


def plain_names(names: List[str]) -> Dict[int, str]:
    """Names without what patterns of channels read otherwise (`* ? [ ] \\`), no two alike, by their place."""
    taken: Set[str] = set()
    counts: Dict[str, int] = {}  # so that equal names do not try all numbers again
    result: Dict[int, str] = {}
    for place, name in enumerate(names):
        plain = "".join("_" if c in "*?[]\\" or not c.isprintable() else c for c in name).strip() or "unnamed"
        plain = _cut(plain, 180)
        unique, count = plain, counts.get(plain, 1)
        while unique in taken:
            count += 1
            unique = f"{plain} {count}"
        taken.add(unique)
        counts[plain] = count
        result[place] = unique
    return result


def _cut(text: str, most: int) -> str:
    return text.encode("utf-8")[:most].decode("utf-8", "ignore")


def channel_name(name: str) -> str:
    """A name that the command line takes before '='."""
    return name.replace("=", "_").replace(",", "_")


