"""A browser for the tests of pages, and what everybody who opens one may ask of it."""

import contextlib
import io
import shutil
from importlib.resources import files

import numpy as np
from PIL import Image

CHROMIUM = next(
    (
        found
        for name in ("chromium", "chromium-browser", "google-chrome", "chrome")
        if (found := shutil.which(name))
    ),
    None,
)
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
#: For the slowest of machines, in ms.
PATIENCE = 300_000


@contextlib.contextmanager
def started():
    """A browser without a screen; None where there is none."""
    from playwright.sync_api import sync_playwright

    if CHROMIUM is None:
        yield None
        return
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS, timeout=PATIENCE)
        yield browser
        browser.close()


def listen(tab):
    """What a tab complains about and asks for from now on, as two lists of texts."""
    wrong, asked = [], []
    tab.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.on("request", lambda request: asked.append(request.url))
    return wrong, asked


def findings(tab):
    """What axe finds in the page: its rule, and the first place."""
    tab.evaluate((files("axe_playwright_python") / "axe.min.js").read_text(encoding="utf-8"))
    found = tab.evaluate("axe.run({preload: false})")  # style sheets are no files to be asked for again
    assert len(found["passes"]) > 10
    return [(one["id"], one["nodes"][0]["html"]) for one in found["violations"]]


def greys(shown):
    """What a tab or a part of its page shows, 0 to 255."""
    return np.asarray(Image.open(io.BytesIO(shown.screenshot())).convert("L"))


def brightness(tab):
    """Median of all that is on the screen."""
    return float(np.median(greys(tab)))
