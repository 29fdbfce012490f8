"""Processor time of the Python package beside that of the program, for the same work.

    python_overhead.py PROGRAM [SCENE]

The package must be on the path: PYTHONPATH=build/release/python.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

import lightwell as lw


def spent(who):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def seconds_of_process(*arguments):
    before = spent(resource.RUSAGE_CHILDREN)
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return spent(resource.RUSAGE_CHILDREN) - before


def seconds_of(work):
    before = spent(resource.RUSAGE_SELF)
    result = work()
    return spent(resource.RUSAGE_SELF) - before, result


def solve_both(program, scene, folder):
    """Seconds of reading, solving and writing by the program and here, the least of three each."""

    def here():
        lw.solve(lw.read(scene)).save(os.path.join(folder, "here.vtp"))

    there = min(
        seconds_of_process(program, "solve", scene, "-o", os.path.join(folder, "there.vtp")) for _ in range(3)
    )
    return there, min(seconds_of(here)[0] for _ in range(3))


def main():
    program = sys.argv[1]
    scene = sys.argv[2] if len(sys.argv) > 2 else "cornell/cornell.toml"
    with tempfile.TemporaryDirectory() as folder:
        there, here = solve_both(program, scene, folder)
        print(f"read, solve, write: program {there:.2f} s, Python {here:.2f} s")
        solution = lw.load(os.path.join(folder, "here.vtp"))
    start = time.perf_counter()
    arrays = solution.vertices, solution.elements, solution.direct_irradiance, solution.patch_radiosity
    taken = time.perf_counter() - start
    print(f"four views of {sum(array.nbytes for array in arrays)} bytes: {1e6 * taken:.0f} us")
    print(f"start: program {seconds_of_process(program, '--version'):.3f} s, "
          f"'import lightwell' {seconds_of_process(sys.executable, '-c', 'import lightwell'):.3f} s, "
          f"of which 'import numpy' {seconds_of_process(sys.executable, '-c', 'import numpy'):.3f} s")
    count = 100_000
    vertices = np.random.default_rng(1).uniform(size=(3 * count, 3))
    faces = np.arange(3 * count).reshape(count, 3)
    taken, _ = seconds_of(lambda: lw.Scene.from_arrays(vertices, faces))
    print(f"a scene of {count} triangles in arrays, cleaned up: {taken:.1f} s")


if __name__ == "__main__":
    main()
