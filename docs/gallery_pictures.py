"""Make the pictures of the gallery in docs/_static/gallery: each is what its script in docs/gallery saves.

Run from the repository root: python docs/gallery_pictures.py [NAMES]
"""

from __future__ import annotations

import contextlib
import io
import runpy
import shutil
import sys
import tempfile
from pathlib import Path

from code_blocks import link_examples

DOCS = Path(__file__).resolve().parent
SCRIPTS = {path.stem: path for path in sorted((DOCS / "gallery").glob("*.py"))}
TARGET = DOCS / "_static" / "gallery"


def make(name: str) -> None:
    """Run a script in a folder of its own and keep its picture."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        link_examples(Path(folder))
        with contextlib.redirect_stdout(io.StringIO()):
            runpy.run_path(str(SCRIPTS[name]), run_name="__main__")
        shutil.copy(f"{name}.png", TARGET / f"{name}.png")


if __name__ == "__main__":
    TARGET.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[1:] or SCRIPTS:
        make(name)
