"""Python and the command line give the same bits."""

import json
import os
import unittest

import numpy as np

import lightwell as lw
from scenes import CORNELL, ROOM, SOURCE, assert_same_solutions, run_program, scratch

class SameBits(unittest.TestCase):
    def test_solution_of_a_file(self):
        file = os.path.join(scratch(self), "cornell.vtp")
        run_program("solve", CORNELL, "-o", file, "--max-patch-size", "80", "--rays", "256")
        scene = lw.read(CORNELL)
        # 80 units of the file.
        made = lw.solve(scene, max_patch_size=80 * scene.metres_per_unit, rays=256)
        assert_same_solutions(self, made, lw.load(file))
        assert_same_solutions(self, made, lw.load(file, scene))

    def test_solution_for_an_accuracy_by_another_solver(self):
        file = os.path.join(scratch(self), "room.vtp")
        run_program("solve", ROOM, "-o", file, "--accuracy", "5%", "--solver", "gauss-seidel")
        made = lw.solve(lw.read(ROOM), accuracy=0.05, solver="gauss-seidel")
        assert_same_solutions(self, made, lw.load(file))
        self.assertLessEqual(made.error, 0.05)

    def test_picture(self):
        folder = scratch(self)
        vtp, theirs, ours = (os.path.join(folder, name) for name in ("c.vtp", "theirs.exr", "ours.exr"))
        scene = lw.read(CORNELL)
        solution = lw.solve(scene, max_patch_size=0.1)
        solution.save(vtp)
        run_program("render", CORNELL, vtp, "--size", "64x48", "--quality", "draft", "-o", theirs)
        picture = solution.render(width=64, height=48, quality="draft")
        self.assertEqual(picture.shape, (48, 64, 3))
        self.assertEqual(picture.dtype, np.float32)
        lw.write_picture(ours, picture)
        said = json.loads(run_program("compare", theirs, ours, "--json"))
        self.assertEqual(said["rmse"], 0.0)

    def test_form_factors(self):
        stl = os.path.join(SOURCE, "examples", "room", "room.stl")
        for options, arguments in (
            ({}, []),
            ({"method": "ray-cast", "target_error": 0.01}, ["--method", "ray-cast", "--target-error", "0.01"]),
            ({"two_sided": True, "max_patch_size": 2.0}, ["--two-sided", "--max-patch-size", "2"]),
        ):
            mtx = os.path.join(scratch(self), "room.mtx")
            run_program("form-factors", stl, "-o", mtx, *arguments)
            theirs = np.loadtxt(mtx, comments="%", skiprows=0)
            rows, columns, entries = (int(n) for n in theirs[0])
            F, report = lw.form_factors(lw.read(stl), **options)
            self.assertEqual((rows, columns, entries), (*F.shape, F.nnz))
            ours = F.tocoo()
            order = np.lexsort((theirs[1:, 1], theirs[1:, 0]))
            body = theirs[1:][order]
            self.assertEqual(body[:, 0].tolist(), (ours.coords[0] + 1).tolist())
            self.assertEqual(body[:, 1].tolist(), (ours.coords[1] + 1).tolist())
            # Nine digits name a float32.
            self.assertEqual(body[:, 2].astype(np.float32).tobytes(), ours.data.tobytes())
            with open(mtx.replace(".mtx", ".json")) as file:
                beside = json.load(file)
            for key in ("facets", "rows", "patches", "rays", "closure_max_error", "reciprocity_max_error"):
                self.assertEqual(beside[key], report[key], key)

    def test_thread_count_does_not_matter(self):
        scene = lw.read(CORNELL)
        one = lw.solve(scene, max_patch_size=0.1)
        for threads in (1, 3):
            with lw.thread_limit(threads):
                self.assertLessEqual(lw.thread_count(), threads)
                assert_same_solutions(self, one, lw.solve(scene, max_patch_size=0.1))


if __name__ == "__main__":
    unittest.main()
