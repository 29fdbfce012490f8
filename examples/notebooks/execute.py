"""Runs notebooks and stores their outputs in them: execute.py [NOTEBOOK.ipynb ...]; all by default.

Needs nbclient, ipykernel and matplotlib, and the package lightwell.
"""

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

here = Path(__file__).resolve().parent
for path in map(Path, sys.argv[1:] or sorted(map(str, here.glob("*.ipynb")))):
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, resources={"metadata": {"path": str(here)}}).execute()
    for cell in notebook.cells:
        # Times of execution are left out, so that a notebook without changes stays as it is.
        cell.metadata.pop("execution", None)
    notebook.metadata.pop("language_info", None)
    nbformat.write(notebook, path)
    print(path.name)
