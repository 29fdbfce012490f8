"""The code of docs/python.md runs as it is printed there."""

import os
import re
import shutil
import unittest

from scenes import SOURCE, scratch


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
        names = {}
        for number, block in enumerate(blocks):
            with self.subTest(block=number):
                exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
        self.assertAlmostEqual(names["exchange"].heat.sum(), names["exchange"].to_surroundings, delta=1e-9)
        self.assertTrue(os.path.exists("door.png") and os.path.exists("evening.html"))


if __name__ == "__main__":
    unittest.main()
