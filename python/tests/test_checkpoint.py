"""Checkpoints of a solve, and effort on what is looked at."""

import os
import unittest

import numpy as np

import lightwell as lw
from scenes import ROOM, assert_same_solutions, lit_room, run_program, scratch


class Checkpoints(unittest.TestCase):
    OPTIONS = {"max_patch_size": 0.25, "refine": "off", "gather_rays": 256}

    def setUp(self):
        self.file = os.path.join(scratch(self), "room.checkpoint")

    def stopped_solve(self, scene, phase, **options):
        """A solve that is stopped half way through a phase."""

        def stop(name, share):
            return not (name == phase and share > 0.2)

        with self.assertRaises(lw.Interrupted):
            lw.solve(scene, checkpoint=self.file, progress=stop, **self.OPTIONS, **options)

    def test_a_resumed_solve_has_the_bits_of_one_that_was_not_stopped(self):
        scene = lit_room()
        whole = lw.solve(scene, **self.OPTIONS)
        self.stopped_solve(scene, "gather")
        self.assertGreater(os.path.getsize(self.file), 0)
        resumed = lw.solve(scene, checkpoint=self.file, resume=True, **self.OPTIONS)
        assert_same_solutions(self, whole, resumed)
        self.assertFalse(os.path.exists(self.file))
        self.assertFalse([note for note in resumed.notes if note.startswith("Checkpoint")])

    def test_finished_work_is_not_lost_by_chance(self):
        scene = lit_room()
        self.stopped_solve(scene, "gather")
        for options, sentence in (
            ({}, "holds finished work already"),
            ({"resume": True, "solver": "jacobi"}, "options"),
        ):
            with self.subTest(options), self.assertRaises(lw.InputError) as caught:
                lw.solve(scene, checkpoint=self.file, **self.OPTIONS, **options)
            self.assertIn(sentence, str(caught.exception))
        other = lit_room(title="other", cameras=lw.Camera((1, 1, 1), (2, 2, 1)))
        moved = lw.Scene.from_arrays(np.array(other.vertices) * 1.5, other.faces, emission=1.0)
        with self.assertRaises(lw.InputError):
            lw.solve(moved, checkpoint=self.file, resume=True, **self.OPTIONS)
        self.assertGreater(os.path.getsize(self.file), 0)

    def test_a_kept_checkpoint_serves_another_solve(self):
        scene = lit_room()
        whole = lw.solve(scene, checkpoint=self.file, keep_checkpoint=True, every=0.5, **self.OPTIONS)
        self.assertGreater(os.path.getsize(self.file), 0)
        phases = set()
        again = lw.solve(
            scene, reuse=self.file, solver="jacobi", progress=lambda phase, share: phases.add(phase) or True, **self.OPTIONS
        )
        assert_same_solutions(self, lw.solve(scene, solver="jacobi", **self.OPTIONS), again)
        self.assertEqual(whole.elements.tobytes(), again.elements.tobytes())

    def test_wrong_input_is_a_sentence(self):
        scene = lit_room()
        text = os.path.join(os.path.dirname(self.file), "text")
        with open(text, "w") as file:
            file.write("no checkpoint\n")
        for options, sentence in (
            ({"resume": True}, "resume needs checkpoint"),
            ({"keep_checkpoint": True}, "keep_checkpoint needs checkpoint"),
            ({"checkpoint": self.file, "reuse": self.file}, "exclude each other"),
            ({"checkpoint": self.file, "seconds": 1.0}, "exclude each other"),
            ({"checkpoint": self.file, "every": 0.0}, "every is 0"),
            ({"checkpoint": self.file, "every": float("nan")}, "every is"),
            ({"checkpoint": text}, "text"),
            ({"checkpoint": os.path.join(os.path.dirname(self.file), "no", "folder")}, "folder"),
            ({"reuse": self.file}, "room.checkpoint"),
            ({"look_from": 3}, "look_from has 3"),
            ({"look_from": np.zeros((2, 3))}, "look_from has"),
            ({"look_from": np.zeros((2, 6))}, "a direction is zero"),
            ({"look_from": np.full((2, 6), np.nan)}, "look_from: row 0"),
            ({"look_from": "door"}, "no camera"),
            ({"look_from": "missing.csv"}, "missing.csv"),
        ):
            with self.subTest(options), self.assertRaises(lw.Error) as caught:
                lw.solve(scene, max_patch_size=1.0, **options)
            self.assertIn(sentence, str(caught.exception))
        self.assertFalse(os.path.exists(self.file))


class LookFrom(unittest.TestCase):
    def test_has_the_bits_of_the_command_line(self):
        folder = scratch(self)
        places = os.path.join(folder, "desk.csv")
        with open(places, "w") as file:
            file.write("x,y,z,nx,ny,nz\n2,2.5,0.75,0,0,1\n2.5,2.5,0.75,0,0,1\n")
        scene = lw.read(ROOM)
        desk = np.array([[2, 2.5, 0.75, 0, 0, 1], [2.5, 2.5, 0.75, 0, 0, 1]], float)
        vtp = os.path.join(folder, "room.vtp")
        run_program("solve", ROOM, "-o", vtp, "--accuracy", "5%", "--look-from", "door", "--look-from", places)
        theirs = lw.load(vtp, scene)
        door = next(camera for camera in scene.cameras if camera.name == "door")
        for look_from in (["door", places], ["door", desk], [door, desk]):
            with self.subTest(look_from):
                assert_same_solutions(self, theirs, lw.solve(scene, accuracy="5%", look_from=look_from))
        self.assertEqual(theirs.looked_from, ["door", places])
        everywhere = lw.solve(scene, accuracy="5%", look_from=["door", "everywhere"])
        assert_same_solutions(self, everywhere, lw.solve(scene, accuracy="5%"))
        self.assertEqual(everywhere.looked_from, [])


if __name__ == "__main__":
    unittest.main()
