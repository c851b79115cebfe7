"""Make docs/_static/view.png: the viewer in a browser, half way through the run of examples/line.toml.

Run from the repository root: python docs/viewer_picture.py (needs playwright, and chromium or chrome)
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import ancf
from ancf.viz.view import write_view

DOCS = Path(__file__).resolve().parent
LINE = DOCS.parent / "examples" / "line.toml"
TARGET = DOCS / "_static" / "view.png"
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
#: What draws the picture in three dimensions where there is no graphics card.
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SIZE = {"width": 1280, "height": 720}
#: State of those on the page, and a second is long enough for plots to follow.
STATE, SETTLED = 120, 1000


def run(folder: Path) -> Path:
    """The page of a pantograph that passes."""
    command = [sys.executable, "-m", "ancf", "catenary", "run", str(LINE), "--speed", "280"]
    subprocess.run([*command, "--no-report", "-q", "-o", str(folder)], check=True)
    return write_view(ancf.load(folder / "results.h5"), folder / "view.html")


def shoot(page: Path, target: Path, browser: str) -> None:
    """What a browser shows of it."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=browser, args=FLAGS)
        tab = opened.new_page(viewport=SIZE)
        tab.goto(page.as_uri())
        tab.wait_for_function("window.__ancf && window.__ancf.ready")
        tab.evaluate(f"__ancf.seek({STATE})")
        tab.wait_for_function("player.drawn === __ancf.frame")
        tab.wait_for_timeout(SETTLED)
        tab.screenshot(path=target)
        opened.close()


if __name__ == "__main__":
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        sys.exit(f"none of {', '.join(BROWSERS)} is installed")
    with tempfile.TemporaryDirectory() as made:
        shoot(run(Path(made)), TARGET, found)
