"""Every kind of page that the package writes, in a browser: for everybody, narrow, in the dark, on paper."""

from functools import cache

import numpy as np
import pytest

import browsing
import html_pages
from helpers import some

WIDE, NARROW = (1200, 900), (400, 800)
#: Those that have what others have too.
SLOW = ("train", "indices", "long_names", "calibration")
#: Grey of the page's ground in the dark, 0 to 255.
GROUND = 23


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The page of a name, made once: it is only looked at."""
    return cache(lambda name: html_pages.written(name, tmp_path_factory.mktemp(name)))


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in html_pages.PAGES],
)
def test_everybody_can_read_it(browser, pages, name):
    """No finding of axe, no error, nothing asked of a network, nothing beside the screen.

    The ground is the screen's, that of pictures too; paper is white.
    """
    page = pages(name)
    tab = browser.new_page(viewport={"width": NARROW[0], "height": NARROW[1]}, color_scheme="light")
    tab.set_default_timeout(browsing.PATIENCE)
    wrong, asked = browsing.listen(tab)
    tab.goto(page.as_uri())
    for size, scheme in ((NARROW, "light"), (WIDE, "dark")):
        tab.set_viewport_size({"width": size[0], "height": size[1]})
        tab.emulate_media(color_scheme=scheme)
        assert browsing.findings(tab) == []
        assert tab.evaluate("document.documentElement.scrollWidth") <= size[0]
        light = browsing.brightness(tab)
        assert light > 200 if scheme == "light" else light == pytest.approx(GROUND, abs=1)
    for picture in tab.locator("figure img").all()[:1]:
        seen = browsing.greys(picture)
        assert np.median(seen) == pytest.approx(GROUND, abs=6)
        assert seen.max() > 140  # its lines
    tab.emulate_media(media="print", color_scheme="dark")
    assert browsing.brightness(tab) > 200
    assert wrong == []
    assert all(url.startswith(("file:", "data:")) for url in asked), asked
    tab.close()


@pytest.mark.parametrize("name", ["study", "long_names"])
@pytest.mark.parametrize("width", some([1200, 1600]))
def test_tables_take_the_room_that_there_is(browser, pages, name, width):
    """None is cut while the window is wide enough for it."""
    page = pages(name)
    tab = browser.new_page(viewport={"width": width, "height": 900})
    tab.goto(page.as_uri())
    found = tab.evaluate(
        """[...document.querySelectorAll(".scroll")].filter(e => e.offsetParent)
           .map(e => [e.scrollWidth, e.clientWidth, e.getBoundingClientRect().left])"""
    )
    assert len(found) > 3
    for needed, given, left in found:  # from the left edge of the headings on
        assert needed <= given or given >= width - left - 70
    tab.close()


@pytest.mark.parametrize("name", ["study", "long_names", "comparison", "calibration"])
@pytest.mark.parametrize("width", some([400, 320, 600]))
def test_narrow_screens_scroll_within_tables_and_figures(browser, pages, name, width):
    """Names of rows stay in sight while the columns pass, letters of figures stay as large as text."""
    page = pages(name)
    tab = browser.new_page(viewport={"width": width, "height": 800})
    tab.goto(page.as_uri())
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    wide = tab.evaluate(
        "[...document.querySelectorAll('figure img')].map(e => e.getBoundingClientRect().width)"
    )
    most = tab.evaluate(
        "[...document.querySelectorAll('figure img')].map(e => parseFloat(e.style.maxWidth) || 1e4)"
    )
    assert all(w >= min(544, m) - 1 for w, m in zip(wide, most, strict=True))
    moved = tab.evaluate(
        """[...document.querySelectorAll(".scroll")]
           .filter(e => e.querySelector("thead th:first-child:not(.number)"))
           .filter(e => e.scrollWidth > e.clientWidth + 40).map(e => {
             const [head, cell] = ["thead th", "tbody td"].map(x => e.querySelector(`${x}:first-child`));
             const last = e.querySelector("tbody td:last-child");
             const places = () => [head, cell, last].map(x => x.getBoundingClientRect().left);
             const before = places(); e.scrollLeft = 40; const after = places();
             return before.map((x, k) => after[k] - x);
           })"""
    )
    assert moved or name != "study" or width > 400
    for head, cell, last in moved:
        assert (abs(head), abs(cell)) < (1, 1)
        assert last < -39
    tab.close()
