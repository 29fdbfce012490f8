#!/usr/bin/env python3
"""Makes lightwell-VERSION.zip, which Blender installs: `blender --command extension build` without Blender.

    python/blender/build_zip.py [FOLDER]
"""

import os
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
BEGIN_OF_TIME = (1980, 1, 1, 0, 0, 0)  # the same sources give the same file
LEFT_OUT = {"tests", "__pycache__", "README.md", "build_zip.py"}


def build_zip(folder: str) -> str:
    """Writes the zip into the folder and returns its path."""
    with open(os.path.join(HERE, "blender_manifest.toml"), encoding="utf-8") as file:
        version = re.search(r'^version = "(.*)"', file.read(), re.MULTILINE)[1]
    path = os.path.join(folder, f"lightwell-{version}.zip")
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as packed:
        for place, folders, names in os.walk(HERE):
            folders[:] = sorted(set(folders) - LEFT_OUT)
            for name in sorted(set(names) - LEFT_OUT):
                if not name.endswith((".zip", ".part")):
                    _pack(packed, os.path.join(place, name), os.path.relpath(os.path.join(place, name), HERE))
        _pack(packed, os.path.join(HERE, "..", "..", "LICENSE"), "LICENSE")
    os.replace(path + ".part", path)
    return path


def _pack(packed: zipfile.ZipFile, path: str, name: str) -> None:
    entry = zipfile.ZipInfo(name, BEGIN_OF_TIME)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = 0o644 << 16
    with open(path, "rb") as file:
        packed.writestr(entry, file.read())


if __name__ == "__main__":
    print(build_zip(sys.argv[1] if len(sys.argv) > 1 else "."))
