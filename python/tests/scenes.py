"""Scenes and places that several tests share."""

import os
import subprocess
import tempfile

import numpy as np

import lightwell as lw

SOURCE = os.environ["LIGHTWELL_SOURCE"]  # the repository
PROGRAM = os.environ["LIGHTWELL_PROGRAM"]  # the command line
CORNELL = os.path.join(SOURCE, "cornell", "cornell.toml")
ROOM = os.path.join(SOURCE, "examples", "room", "room.toml")

FLOAT = 2.0**-24  # half a unit in the last place of a float32 near 1, relative

# Three hours of a year with light, of which two are clear.
WEATHER = """place Testville
latitude 50
longitude 0
time_zone 0
site_elevation 0
weather_data_file_units 1
6 21 9.5 500 150
6 21 12.5 700 150
12 21 12.5 0 50
"""


def box(low=(0, 0, 0), high=(1, 1, 1)):
    """Vertices and faces of a box whose faces are seen from inside."""
    vertices = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)], float)
    faces = np.array(
        [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]]
    )
    return vertices, faces


def lit_room(**options):
    """A box of 4 m x 3 m x 2.5 m with a panel of light below its ceiling."""
    vertices, faces = box(high=(4, 3, 2.5))
    panel = [[1.5, 1, 2.4], [1.5, 2, 2.4], [2.5, 2, 2.4], [2.5, 1, 2.4]]
    return lw.Scene.from_arrays(
        np.vstack([vertices, panel]),
        np.vstack([faces, [8, 9, 10, 11]]),
        surface=[0] * 6 + [1],
        names=["room", "panel"],
        reflectance=[0.5, 0.0],
        emission=[0.0, 30.0],
        **options,
    )


def run_program(*arguments):
    """Runs the command line; fails the test with its messages if it fails."""
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: exit {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def scratch(test):
    """A folder that is removed after the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return folder.name


_SOLUTION_ARRAYS = [
    "vertices",
    "normals",
    "elements",
    "element_area",
    "element_patch",
    "patch_area",
    "patch_surface",
    "direct_irradiance",
    "indirect_irradiance",
    "patch_radiosity",
    "patch_reflectance",
    "patch_emission",
    "element_error",
]


def assert_same_solutions(test, one, other):
    """Fails the test unless all arrays of two solutions have the same bits."""
    for name in _SOLUTION_ARRAYS:
        a, b = getattr(one, name), getattr(other, name)
        test.assertEqual(a.dtype, b.dtype, name)
        test.assertGreater(a.size, 0, name)
        test.assertEqual(a.tobytes(), b.tobytes(), name)
