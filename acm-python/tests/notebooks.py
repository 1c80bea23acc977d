"""Executes every notebook of a folder as Jupyter does, in a folder of its own, and keeps what came out.

    python notebooks.py NOTEBOOKS OUT
"""

import pathlib
import sys
import tempfile
import time

import nbformat
from nbclient import NotebookClient


def execute(path, out):
    notebook = nbformat.read(path, as_version=4)
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
    out.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, out / path.name)
    cells = sum(cell.cell_type == "code" for cell in notebook.cells)
    print(f"{path.name}: {cells} cells executed in {time.monotonic() - began:.0f} s")


if __name__ == "__main__":
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.ipynb")):
        execute(path, pathlib.Path(sys.argv[2]))
