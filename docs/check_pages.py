"""Open pages of the built documentation in a browser: no error, no finding of axe, nothing beside the screen.

Run after the build: python docs/check_pages.py docs/_build/html
Without ``--all`` it opens one page of each folder and those that are made otherwise; where there is no
browser, it says so.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

import browsing

#: Those that are made otherwise than the others, where they are there.
ODD = ("index", "search", "genindex", "gallery", "verification/closed_forms", "howto/read_results")
SCREENS = (("light", 400, 800), ("dark", 1200, 900))


def chosen(root: Path, whole: bool) -> list[Path]:
    """Pages to open."""
    pages = sorted(path for path in root.rglob("*.html") if "_static" not in path.parts)
    if whole:
        return pages
    first = {path.parent: path for path in reversed(pages)}
    return sorted({*first.values(), *(page for page in pages if name_of(root, page) in ODD)})


def name_of(root: Path, page: Path) -> str:
    """Name of a page below the root, without its ending."""
    return page.relative_to(root).with_suffix("").as_posix()


def wrong(browser: Any, page: Path) -> Iterator[str]:
    """What is wrong with a page, on each screen."""
    tab = browser.new_page(viewport={"width": SCREENS[0][1], "height": SCREENS[0][2]})
    tab.set_default_timeout(browsing.PATIENCE)
    said, asked = browsing.listen(tab)
    tab.goto(page.resolve().as_uri())
    for scheme, width, height in SCREENS:
        tab.set_viewport_size({"width": width, "height": height})
        tab.emulate_media(color_scheme=scheme)
        for rule, place in browsing.findings(tab):
            yield f"{scheme}, {width}: {rule}: {place[:120]}"
        if tab.evaluate("document.documentElement.scrollWidth") > width:
            yield f"{scheme}, {width}: wider than the screen"
    yield from said
    yield from (f"asks for {url}" for url in asked if not url.startswith(("file:", "data:", "blob:")))
    tab.close()


def main(arguments: list[str]) -> int:
    """Print what is wrong; 1 if anything is, or if there are no pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="docs/_build/html", type=Path)
    parser.add_argument("--all", action="store_true", help="every page, which takes minutes")
    given = parser.parse_args(arguments)
    pages, count = chosen(given.folder, given.all), 0
    if not pages:
        print("0 pages")
        return 1
    with browsing.started() as browser:
        if browser is None:
            print("no Chromium or Chrome: no page was opened")
            return 0
        for page in pages:
            for line in wrong(browser, page):
                count += 1
                print(f"{name_of(given.folder, page)}: {line}")
    print(f"{len(pages)} pages, {count} findings")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
