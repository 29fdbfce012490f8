"""The code of docs/python.md runs as it is printed there."""

import os
import re
import shutil
import unittest

from scenes import SOURCE, WEATHER, box, run_program, scratch


class Guide(unittest.TestCase):
    def test_works_as_printed(self):
        with open(os.path.join(SOURCE, "docs", "python.md"), encoding="utf-8") as file:
            blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.MULTILINE | re.DOTALL)
        self.assertGreaterEqual(len(blocks), 4)
        folder, before = scratch(self), os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(folder)
        for example in ("room", "office"):
            shutil.copytree(os.path.join(SOURCE, "examples", example), os.path.join("examples", example))
        with open("year.wea", "w", encoding="utf-8") as file:
            file.write(WEATHER)
        names = {}
        for number, block in enumerate(blocks):
            with self.subTest(block=number):
                exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
        self.assertAlmostEqual(names["exchange"].heat.sum(), names["exchange"].to_surroundings, delta=1e-9)
        for made in ("door.png", "evening.html", "baked.glb", "year/year.json"):
            self.assertTrue(os.path.exists(made), made)

    def test_the_page_of_view_factors_works_as_printed(self):
        with open(os.path.join(SOURCE, "docs", "view-factors.md"), encoding="utf-8") as file:
            page = file.read()
        folder, before = scratch(self), os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(folder)
        (plates,) = re.findall(r"^```\n(T  .*?)^```", page, re.MULTILINE | re.DOTALL)
        with open("plates.vs3", "w", encoding="utf-8") as file:
            file.write(plates)
        # Models that the page leaves to the reader: the example's room, and a cube with its fronts inside.
        for name in ("model.stl", "city.stl", "geometry.stl"):
            shutil.copy(os.path.join(SOURCE, "examples", "room", "room.stl"), name)
        vertices, faces = box()
        for name in ("boundary.obj", "cavity.obj"):
            with open(name, "w", encoding="utf-8") as file:
                file.writelines(f"v {x} {y} {z}\n" for x, y, z in vertices)
                file.writelines(f"o side{i}\nf {' '.join(str(v + 1) for v in face)}\n" for i, face in enumerate(faces))
        os.makedirs("experiments/001")
        with open("experiments/001/facets.inp.001", "w", encoding="utf-8") as file:
            file.write("# type, normal\n" + "1 0 0 1\n" * 24)
        with open("experiments/001/factypes.inp.001", "w", encoding="utf-8") as file:
            file.write("# three\n# lines\n# of heading\n1 0 0.05 0.0004 0.5 0.85\n")
        lines = re.findall(r"^    lightwell (.*)$", page, re.MULTILINE)
        self.assertGreaterEqual(len(lines), 7)
        for line in lines:
            with self.subTest(line):
                run_program(*line.split())
        names = {}
        for number, block in enumerate(re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)):
            with self.subTest(block=number):
                exec(compile(block, f"docs/view-factors.md, block {number}", "exec"), names)
        # Reciprocity of a rectangle of 1 m^2 and a triangle of half of it; floats.
        self.assertAlmostEqual(names["F"][0, 1], 0.5 * names["F"][1, 0], delta=2.0**-24)


if __name__ == "__main__":
    unittest.main()
