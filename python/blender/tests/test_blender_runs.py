"""Runs of the add-on beside Blender: saved, renamed and cancelled meanwhile; lightmaps that come back."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
from rooms import InFolder, addon, cube_room, lux_at, notes, solve  # noqa: E402


class InTheBackground:
    """Runs go on beside Blender, as they do where it has a window, until the test waits for the one under way."""

    def __enter__(self):
        self.start = addon.solve.start
        addon.solve.start = lambda run: setattr(addon.solve.Run, "current", run)
        return self

    def wait(self):
        addon.solve.Run.current.job.wait()
        addon.solve._look()

    def __exit__(self, *_):
        addon.solve.start = self.start
        addon.solve._end_run()


class Runs(InFolder):
    """What a run leaves, and what it does not touch."""

    def test_lightmaps_come_back_with_a_picture(self):
        scene = cube_room()
        self.save()
        solve(scene)
        scene.lightwell.channels[0].level = 0.5
        bpy.ops.lightwell.lightmaps(size=128)
        found = [o for o in scene.objects if o.get(addon.read_scene.OWN) == addon.lightmaps.NAME]
        meshes = [o for o in found if o.type == "MESH"]
        self.assertTrue(meshes, scene.lightwell.message)
        nodes = meshes[0].data.materials[0].node_tree.nodes
        self.assertTrue(any(node.type == "TEX_IMAGE" and node.image.size[0] == 128 for node in nodes))
        solve(scene)
        self.assertNotIn("left out", notes())  # models of the light are no part of the scene

    def test_file_may_be_saved_and_its_scene_renamed_during_a_solve(self):
        scene = cube_room()
        before = addon.solve.folder_of(scene)
        with InTheBackground() as later:
            bpy.ops.lightwell.solve()
            self.save()
            scene.name = "renamed"
            bpy.ops.scene.new(type="EMPTY")
            scene.lightwell.folder = os.path.join(self.folder, "elsewhere")
            later.wait()
        self.assertRegex(scene.lightwell.message, r"^\d+ elements in")
        self.assertEqual(addon.show.path_of(scene.lightwell), os.path.join(before, "solution.vtp"))
        self.assertTrue(os.path.exists(os.path.join(before, "solution.vtp")))
        self.assertGreater(lux_at(scene, (0.3, 0.2, 1.0)), 0.0)

    def test_objects_of_the_user_stay_and_models_leave_nothing(self):
        scene = cube_room()
        mine = bpy.data.collections.new("Lightwell lightmaps of mine")
        scene.collection.children.link(mine)
        mine.objects.link(bpy.data.objects.new("mine", None))
        self.save()
        solve(scene)
        bpy.ops.lightwell.lightmaps(size=64)
        bpy.data.collections[addon.lightmaps.NAME].objects.link(bpy.data.objects.new("too", None))
        rooms = (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.images)
        counts = [len(room) for room in rooms]
        bpy.ops.lightwell.lightmaps(size=64)
        self.assertEqual([len(room) for room in rooms], counts)
        self.assertEqual([found.name for found in mine.objects], ["mine"])
        self.assertIn("too", scene.objects)

    def test_model_comes_into_the_scene_of_its_run(self):
        scene = cube_room()
        self.save()
        solve(scene)
        scene.lightwell.channels[0].level = 0.5
        with InTheBackground() as later:
            bpy.ops.lightwell.lightmaps(size=64)
            bpy.ops.scene.new(type="EMPTY")
            later.wait()
            later.wait()
        self.assertIn("lightmaps in the collection", scene.lightwell.message)
        self.assertTrue([found for found in scene.objects if found.get(addon.read_scene.OWN) == addon.lightmaps.NAME])
        self.assertFalse(bpy.context.scene.objects)

    def test_cancelled_run_keeps_earlier_light(self):
        scene = cube_room()
        solve(scene)
        before = lux_at(scene, (0.3, 0.2, 1.0))
        folder = addon.solve.folder_of(scene)
        files = {name: os.stat(os.path.join(folder, name)).st_ino for name in sorted(os.listdir(folder))}
        scene.objects["Area"].data.energy = 50.0
        with InTheBackground() as later:
            bpy.ops.lightwell.solve()
            self.assertFalse(bpy.ops.lightwell.export.poll())
            bpy.ops.lightwell.cancel()
            later.wait()
        self.assertIn("stopped", scene.lightwell.message)
        self.assertEqual(lux_at(scene, (0.3, 0.2, 1.0)), before)
        # The scene is still the one that belongs to the light.
        self.assertEqual(
            {name: os.stat(os.path.join(folder, name)).st_ino for name in sorted(os.listdir(folder))}, files
        )

    def test_bake_of_a_scene_that_was_not_solved(self):
        scene = cube_room()
        solve(scene)
        scene.objects["Area"].data.energy = 50.0
        bpy.ops.lightwell.export()
        with self.assertRaisesRegex(RuntimeError, "is not the one that was solved; solve again"):
            bpy.ops.lightwell.lightmaps(size=64)


if __name__ == "__main__":
    addon.register()
    unittest.main()
