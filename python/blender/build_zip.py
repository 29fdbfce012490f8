#!/usr/bin/env python3
"""Makes lightwell-VERSION.zip, which Blender installs: `blender --command extension build` without Blender.

    python/blender/build_zip.py [FOLDER]
"""

import os
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
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
                full = os.path.join(place, name)
                packed.write(full, os.path.relpath(full, HERE))
        packed.write(os.path.join(HERE, "..", "..", "LICENSE"), "LICENSE")
    os.replace(path + ".part", path)
    return path


if __name__ == "__main__":
    print(build_zip(sys.argv[1] if len(sys.argv) > 1 else "."))
