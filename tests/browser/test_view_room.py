"""Room for words in the page that ``ancf view`` writes: labels beside what is drawn, titles, long names."""

import numpy as np
import pytest
from scipy.ndimage import binary_dilation
from test_view_browser import Opened

from ancf.viz.scene import Marker, Scene, Thread
from ancf.viz.view import page
from helpers import some

#: Sum over the colours of letters; lines of the grid are lighter.
DARK = 300
#: Width of the list of what can be followed, and of what is chosen in it, pixels.
ROOM = """(() => {
    const list = document.getElementById("follow"), pen = document.createElement("canvas").getContext("2d");
    pen.font = getComputedStyle(list).font;
    return [list.clientWidth, pen.measureText(list.value).width];
})()"""
VIEWS = {"front (x, z)": (0, 2), "side (y, z)": (1, 2), "top (x, y)": (0, 1)}


def hung(view, aside):
    """A rope of 6 m along what is up in a view, and a mass at each metre of it, aside of it."""
    t, x = np.arange(2.0), np.linspace(0.0, 6.0, 13)
    across, up = VIEWS[view]
    rope = np.zeros((2, 13, 3))
    rope[..., up] = -x
    masses = []
    for k in range(1, 7):
        place = np.zeros((2, 3))
        place[:, across], place[:, up] = aside, -k
        masses.append(Marker(f"mass {k}", "point mass", place))
    return Scene("hung", t, [Thread("rope", "cable", x, rope, {})], markers=masses, stored=2)


def opened(browser, folder, scene, size=(900, 560)):
    path = folder / "view.html"
    path.write_text(page(scene, "Hung"), encoding="utf-8")
    found = Opened(browser, path)
    found.tab.set_viewport_size({"width": size[0], "height": size[1]})
    found.tab.wait_for_timeout(300)
    found.settle()
    return found


@pytest.mark.parametrize("view", VIEWS)
class TestFlatViews:
    @pytest.mark.parametrize("aside", some([1.2, 0.8]))
    def test_labels_lie_beside_what_is_drawn(self, browser, tmp_path, view, aside):
        shown = opened(browser, tmp_path, hung(view, aside))
        assert shown.ask("picture.view") == view
        before = shown.picture()
        shown.tab.get_by_label("point mass").uncheck()
        shown.wait("picture.div.data.some((d) => d.visible === false)")
        shown.settle()
        after = shown.picture()
        changed = np.abs(after - before).sum(axis=2) > DARK
        assert changed.sum() > 200
        around = binary_dilation(changed, iterations=3)
        assert (after[around].sum(axis=1) > DARK).all()  # no letters below them
        shown.quiet()
        shown.tab.close()

    @pytest.mark.parametrize(
        "size", [(900, 560), *(pytest.param((1200, y), marks=pytest.mark.slow) for y in (700, 480))]
    )
    def test_title_of_the_axis_is_whole(self, browser, tmp_path, view, size):
        shown = opened(browser, tmp_path, hung(view, 1.2), size)
        dark = shown.picture().sum(axis=2) < DARK
        rows = np.flatnonzero(dark.any(axis=1))
        assert rows[-1] < len(dark) - 4
        # the last line of letters is the title below the labels, three letters and more
        last = rows[np.concatenate([[True], np.diff(rows[::-1]) == -1]).cumprod().astype(bool)[::-1]]
        assert 6 < len(last) < 30
        shown.tab.close()


@pytest.mark.parametrize("name", ["bob", "counterweight of car 12", "the counterweight of the upper cabin"])
def test_names_to_follow_are_whole(browser, tmp_path, name):
    t = np.arange(3.0)
    place = np.stack([10 * t, 0 * t, 0 * t], axis=1)
    shown = opened(browser, tmp_path, Scene("runs", t, markers=[Marker(name, "point mass", place)], stored=3))
    shown.tab.select_option("#follow", name)
    room, needed = shown.ask(ROOM)
    assert room > needed
    shown.tab.close()
