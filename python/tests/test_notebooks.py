"""Notebooks run from their first cell to their last, in which they check their own numbers."""

import importlib.util
import os
import unittest

from scenes import SOURCE

FOLDER = os.path.join(SOURCE, "examples", "notebooks")
NEEDS = ("nbformat", "nbclient", "ipykernel", "matplotlib")
MISSING = [name for name in NEEDS if importlib.util.find_spec(name) is None]
MOST_BYTES = 300_000
"""Of a notebook with its pictures, so that pages with it open at once."""


@unittest.skipIf(MISSING, f"{', '.join(MISSING)} not installed")
class Notebooks(unittest.TestCase):
    def notebooks(self):
        import nbformat

        names = sorted(name for name in os.listdir(FOLDER) if name.endswith(".ipynb"))
        self.assertGreaterEqual(len(names), 5)
        for name in names:
            path = os.path.join(FOLDER, name)
            notebook = nbformat.read(path, as_version=4)
            nbformat.validate(notebook)
            yield name, path, notebook

    def test_run_as_they_stand(self):
        from nbclient import NotebookClient

        for name, _, notebook in self.notebooks():
            with self.subTest(name):
                # A cell that fails raises, with its text and its error.
                NotebookClient(notebook, timeout=600, resources={"metadata": {"path": FOLDER}}).execute()

    def test_keep_their_outputs_and_check_their_numbers(self):
        for name, path, notebook in self.notebooks():
            with self.subTest(name):
                self.assertLess(os.path.getsize(path), MOST_BYTES)
                code = [cell for cell in notebook.cells if cell.cell_type == "code"]
                kinds = {kind for cell in code for output in cell.outputs for kind in output.get("data", {})}
                self.assertIn("image/png", kinds, "run examples/notebooks/execute.py, which stores outputs")
                self.assertFalse([output for cell in code for output in cell.outputs if output.output_type == "error"])
                self.assertEqual([cell.execution_count for cell in code], list(range(1, len(code) + 1)))
                self.assertTrue(any("assert " in cell.source for cell in code))


if __name__ == "__main__":
    unittest.main()
