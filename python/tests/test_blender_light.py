"""The light of a solve in the Blender add-on, without Blender: arrays, dimming, colours, the program."""

import os
import signal
import subprocess
import sys
import time
import unittest
from collections import Counter

import numpy as np
from scenes import PROGRAM, ROOM, SOURCE, run_program, scratch

import lightwell as lw

sys.path.insert(0, os.path.join(SOURCE, "python", "blender"))

from logic import colours, program  # noqa: E402
from logic.solution import SolutionError, dark_limit, element_areas, read_solution  # noqa: E402


class Solved(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = scratch(cls)
        cls.path = os.path.join(cls.folder, "room.vtp")
        options = ["--rays", "128", "--refine", "off", "--channels", "per-luminaire"]
        run_program("solve", ROOM, "-o", cls.path, *options)
        cls.light = read_solution(cls.path)

    @classmethod
    def addCleanup(cls, function):
        cls.addClassCleanup(function)

    def by_place(self, points, normals, values):
        """Values by place and side of their surface; without places that several vertices of one side share."""
        keys = [(*map(float, p), *(round(float(c), 3) + 0.0 for c in n)) for p, n in zip(points, normals)]
        count = Counter(keys)
        return {key: value for key, value in zip(keys, values) if count[key] == 1}

    def pairs(self, ours, solution, theirs):
        """Values of both where the places agree; sides with light before and behind them are moved apart."""
        mine = self.by_place(self.light.points, self.light.normals, ours)
        other = self.by_place(solution.vertices, solution.normals, theirs)
        shared = sorted(set(mine) & set(other))
        self.assertGreater(len(shared), len(mine) / 2)
        return np.array([mine[key] for key in shared]), np.array([other[key] for key in shared])

    def test_arrays_are_those_of_the_package(self):
        solution = lw.load(self.path)
        self.assertEqual(set(self.light.channels), set(solution.channels))
        every = [1.0] * len(self.light.channels)
        # Sums of a few channels and three bands in floats: some units in the last place.
        np.testing.assert_allclose(*self.pairs(self.light.lux(every), solution, solution.lux), rtol=1e-6, atol=1e-9)

    def test_dimming_is_that_of_the_program(self):
        dim = os.path.join(self.folder, "dim.vtp")
        levels = [0.25 + 0.5 * i for i in range(len(self.light.channels))]
        settings = [f"{name}={level}" for name, level in zip(self.light.channels, levels)]
        run_program("relight", self.path, "-o", dim, *(w for s in settings for w in ("--channel", s)))
        relit = lw.load(dim)
        np.testing.assert_allclose(*self.pairs(self.light.lux(levels), relit, relit.lux), rtol=1e-6, atol=1e-9)
        # B = M + rho E, where M is hundreds of times as large at lamps.
        pair = self.pairs(self.light.light(levels), relit, relit.radiosity)
        np.testing.assert_allclose(*pair, rtol=1e-6, atol=1e-9)

    def test_bright_lamps_hide_no_lit_walls(self):
        # A wall of 1 m^2 in 1 lx beside 10 000 elements of lamps of 1 mm^2 in 1e5 lx, and a side in 1e-5 lx.
        lux = np.array([1.0] + [1e5] * 10000 + [1e-5, 0.0])
        areas = np.array([1.0] + [1e-6] * 10000 + [1.0, 1.0])
        self.assertEqual((lux <= dark_limit(lux, areas)).tolist(), [False] * 10001 + [True, True])

    def test_areas_of_elements(self):
        points = np.array([[0, 0, 1], [2, 0, 1], [2, 3, 1], [0, 3, 1], [2, 0, 5]], float)
        corners, first = np.array([0, 1, 2, 3, 1, 4, 2]), np.array([0, 4, 7])
        np.testing.assert_allclose(element_areas(points, corners, first), [6.0, 6.0])

    def test_files_that_are_no_solution(self):
        path = os.path.join(self.folder, "bad.vtp")
        with open(self.path, "rb") as file:
            whole = file.read()
        spectral = whole.replace(b'Name="band_names"', b'Name="other_name"')
        for content in (b"", b"<?xml?>", whole[: len(whole) // 2], spectral):
            with open(path, "wb") as file:
                file.write(content)
            with self.subTest(length=len(content)):
                with self.assertRaisesRegex(SolutionError, "solve again"):
                    read_solution(path)
        with self.assertRaisesRegex(SolutionError, "cannot be read"):
            read_solution(path + "x")


class Colours(unittest.TestCase):
    def test_scale_has_round_ends_and_steps_within(self):
        scale = colours.scale_of(np.array([0.0, 12.0, 180.0, 430.0]))
        self.assertEqual((scale.low, scale.high), (10.0, 200.0))
        self.assertEqual(scale.steps(), [10.0, 20.0, 50.0, 100.0, 200.0])
        self.assertEqual(colours.Scale(0.0, 500.0).steps(), [0.0, 100.0, 200.0, 300.0, 400.0, 500.0])
        self.assertEqual(colours.scale_of(np.zeros(3)), colours.Scale(0.0, 1.0))

    def test_colours_at_the_ends(self):
        found = colours.false_colours(np.array([1.0, 10.0, 1e4]), colours.Scale(10.0, 1000.0))
        np.testing.assert_allclose(found, colours.STOPS[[0, 0, -1]])
        self.assertTrue((colours.light_colours(np.array([[0.0, 0, 0], [1e9, 1, 1]])) <= 1.0).all())

    def test_weights_of_a_place(self):
        corners = np.array([[0, 0, 1], [2, 0, 1], [3, 2, 1], [0, 1, 1]], float)
        for s, t in ((0.0, 0.0), (0.3, 0.8), (1.0, 0.5)):
            weights = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
            np.testing.assert_allclose(colours.bilinear(corners, weights @ corners), weights, atol=1e-9)
        triangle = corners[:3]
        np.testing.assert_allclose(colours.bilinear(triangle, triangle.mean(axis=0)), [1 / 3] * 3)

    def test_words(self):
        self.assertEqual([colours.lux_text(v) for v in (0.1234, 318.4, 10234.0)], ["0.123 lx", "318 lx", "10200 lx"])


class Program(unittest.TestCase):
    def test_version(self):
        self.assertTrue(program.find_program(PROGRAM))
        with self.assertRaisesRegex(program.ProgramError, "is Lightwell 9.3, and this add-on is made for"):
            program.check_version("p", "lightwell 9.3.1")
        with self.assertRaisesRegex(program.ProgramError, "is not Lightwell"):
            program.check_version("p", "ls (GNU coreutils) 9.1")
        with self.assertRaisesRegex(program.ProgramError, "no program"):
            program.find_program("/nowhere/lightwell")

    def test_run_has_progress_and_can_be_cancelled(self):
        folder = scratch(self)
        out = os.path.join(folder, "s.vtp")
        job = program.Job([PROGRAM, "solve", ROOM, "-o", out, "--accuracy", "0.1%"], folder)
        seen = set()
        while not any(share is not None for _, share in seen):
            self.assertIsNone(job.poll(), "the solve ended before it told how far it was")
            seen.add((job.phase, job.share))
            time.sleep(0.01)
        job.cancel()
        code = job.wait()
        self.assertNotEqual(code, 0)
        self.assertIn("stopped", job.failure(code))
        self.assertEqual(os.listdir(folder), [])

    def test_run_that_the_system_ends_is_said(self):
        folder = scratch(self)
        job = program.Job([PROGRAM, "solve", ROOM, "-o", "s.vtp", "--accuracy", "0.1%"], folder)
        while job.poll() is None and job.share is None:
            time.sleep(0.01)
        os.kill(job._process.pid, signal.SIGKILL)
        self.assertIn("ended by signal 9 of the system", job.failure(job.wait()))

    def test_run_ends_with_the_process_that_began_it(self):
        folder = scratch(self)
        code = (
            "import os, sys, time\nsys.path.insert(0, sys.argv[1])\nfrom logic import program\n"
            "job = program.Job(sys.argv[2:], '.')\n"
            "while job.poll() is None and job.share is None: time.sleep(0.01)\n"
            "print(job._process.pid if job.poll() is None else 0, flush=True)\nos.abort()"
        )
        arguments = [PROGRAM, "solve", ROOM, "-o", "s.vtp", "--accuracy", "0.1%"]
        add_on = os.path.join(SOURCE, "python", "blender")
        crashed = subprocess.run(
            [sys.executable, "-c", code, add_on, *arguments], cwd=folder, capture_output=True, text=True, check=False
        )
        pid = int(crashed.stdout)
        self.assertGreater(pid, 0, "the solve ended before it told how far it was")
        for _ in range(500):  # the solve itself takes minutes
            if not _is_alive(pid):
                return
            time.sleep(0.01)
        os.kill(pid, signal.SIGKILL)
        self.fail("the program outlived the process that began it")

    def test_folder_that_is_missing(self):
        with self.assertRaisesRegex(program.ProgramError, "the folder /nowhere is missing"):
            program.Job([PROGRAM, "--version"], "/nowhere")

    def test_error_of_the_program_is_the_message(self):
        folder = scratch(self)
        job = program.Job([PROGRAM, "solve", "missing.toml", "-o", "s.vtp"], folder)
        self.assertIn("missing.toml", job.failure(job.wait()))


def _is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="latin-1") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


if __name__ == "__main__":
    unittest.main()
