"""Plots along bodies, clicked points, compared and live runs, what is saved; light, dark and narrow."""

import csv
import io
import re
import shutil
import threading

import h5py
import numpy as np
import pytest
from PIL import Image
from test_view_browser import Opened, coloured

import ancf
import browsing
import viewed
from ancf.viz import style
from ancf.viz.view import write_view
from ancf.viz.view.live import LiveView

FRAMES = 40


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """The cantilever, and a softer one that runs for half of the time."""
    folder = tmp_path_factory.mktemp("runs")
    first = viewed.cantilever(folder)
    model = ancf.Model(gravity=(0.0, 0.0, -9.81), title="soft")
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=3e7, rho=500.0)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=6, section=section)
    model.clamp(beam.start)
    return {"stiff": first, "soft": ancf.simulate(model, t_end=0.1, step=1e-3)}


@pytest.fixture(scope="module")
def opened(browser, runs, tmp_path_factory):
    path = write_view(runs["stiff"], tmp_path_factory.mktemp("page") / "view.html", frames=FRAMES)
    shown = Opened(browser, path)
    yield shown
    shown.quiet()
    shown.tab.close()


def line(opened, panel, k=0):
    """What a panel has drawn: x and y of a line."""
    drawn = f"panels[{panel}].curves.data.at({k})"
    return [np.array(opened.ask(f"Array.from({drawn}.{axis})"), dtype=float) for axis in "xy"]


def choose(opened, panel, name):
    opened.tab.locator(".panel select").nth(panel).select_option(name)
    opened.wait(f"panels[{panel}].shown.name === {name!r}")
    opened.settle()


def table(download):
    rows = list(csv.reader(io.StringIO(download.path().read_text(encoding="utf-8-sig"))))
    return rows[0], np.array([[float(cell or "nan") for cell in row] for row in rows[1:]])


def between_middles(result, point):
    """Tension of a cable over time, straight between the middles of its elements."""
    nodes = point.body.node_x
    x = 0.5 * (nodes[1:] + nodes[:-1])
    known = np.stack([result.tension(point.body.at(float(s))) for s in x], axis=1)
    return np.array([np.interp(point.x, x, row) for row in known])


class TestScale:
    @pytest.mark.parametrize("scales", [[[-1.0, 3.0]], [[0.5, 0.5]], [None, [-2.0, 9.0]], [None]])
    def test_is_what_a_curve_says_or_all_that_it_has(self, opened, scales):
        """A curve may leave parts of it out; where none does, the plot chooses."""
        choose(opened, 0, "energy, potential from the start")
        free = opened.ask("panels[0].curves._fullLayout.yaxis.range")
        everything = [np.concatenate([line(opened, 0, k)[1] for k in range(4)])]
        opened.ask(
            f"{scales!r}.forEach((s, i) => {{ panels[0].shown.lines[i].scale = s; }})".replace("None", "null")
        )
        told = [scale for scale in scales if scale]
        others = [line(opened, 0, k)[1] for k in range(4) if k >= len(scales) or scales[k] is None]
        low, high = (f(np.concatenate([*others, *told])) for f in (np.min, np.max))
        opened.ask("panels[0].show()")
        shown = opened.ask("panels[0].curves._fullLayout.yaxis.range")
        if told:
            room = 0.06 * (high - low)
            assert shown == pytest.approx([low - room, high + room], rel=1e-6)
        else:
            assert shown == pytest.approx(free)
            assert shown[0] <= np.min(everything)
            assert shown[1] >= np.max(everything)
        opened.ask("panels[0].shown.lines.forEach((l) => { l.scale = null; }); panels[0].show()")


class TestAlong:
    @pytest.mark.parametrize("quantity", ["tension", "curvature", "speed", "z displacement"])
    def test_extremes_are_those_of_all_states(self, opened, runs, quantity):
        """Not only of those on the page: asked of the result, point by point."""
        choose(opened, 1, f"{quantity} along beam")
        result = runs["stiff"]
        ask = {
            "speed": lambda p: np.linalg.norm(result.velocity(p), axis=1),
            "z displacement": lambda p: result.position(p)[:, 2] - result.position(p)[0, 2],
            "tension": lambda p: between_middles(result, p),
        }.get(quantity, lambda p: getattr(result, quantity)(p))
        (x, low), (_, high) = line(opened, 1, 0), line(opened, 1, 1)
        beam = result.bodies["beam"]
        wanted = np.array([[v.min(), v.max()] for v in (ask(beam.at(float(s))) for s in x)])
        size = np.abs(wanted).max()
        assert np.abs(low - wanted[:, 0]).max() < 1e-6 * size
        assert np.abs(high - wanted[:, 1]).max() < 1e-6 * size
        assert "201 states" in opened.tab.locator(".panel").nth(1).inner_text()

    def test_the_line_is_that_of_the_time(self, opened, runs):
        choose(opened, 1, "z displacement along beam")
        opened.seek(25)
        result, t = runs["stiff"], opened.ask("TIMES[25]")
        k = int(np.argmin(np.abs(result.t - t)))
        opened.wait(
            f"Math.abs(panels[1].curves.data[2].y.at(-1) - {result.position('beam.end')[k, 2]}) < 1e-5"
        )

    def test_click_plots_the_place_over_time(self, opened, runs):
        choose(opened, 1, "curvature along beam")
        box = opened.tab.locator(".plot").nth(1).bounding_box()
        inside = opened.ask("(({_offset: o, _length: l}) => [o, l])(panels[1].curves._fullLayout.xaxis)")
        opened.tab.mouse.click(box["x"] + inside[0] + 0.25 * inside[1], box["y"] + 0.4 * box["height"])
        opened.wait("panels[0].shown.name.startsWith('curvature at beam, s = 0.25')")
        x, y = line(opened, 0)
        s = float(re.search(r"s = ([\d.]+)", opened.ask("panels[0].shown.name"))[1])
        wanted = runs["stiff"].curvature(f"beam.at({s})")
        steps = np.round(x / 1e-3).astype(int)
        assert y == pytest.approx(wanted[steps], abs=1e-4 * wanted.max())

    def test_click_on_the_body_plots_the_place(self, opened):
        choose(opened, 1, "energy, potential from the start")
        opened.seek(FRAMES - 1)
        rows, columns = np.nonzero(coloured(opened.picture()))
        box = opened.tab.locator("#stage").bounding_box()
        middle = np.median(columns[columns < 0.6 * columns.max()])
        row = np.median(rows[np.abs(columns - middle) < 2])
        opened.tab.mouse.move(box["x"] + middle, box["y"] + row)
        opened.wait("picture.aimed")
        opened.tab.mouse.click(box["x"] + middle, box["y"] + row)
        opened.wait("panels[1].shown.name.startsWith('tension at beam')")

    def test_nothing_can_be_sent_anywhere(self, opened):
        titles = opened.ask("Array.from(document.querySelectorAll('.modebar-btn'), (b) => b.dataset.title)")
        assert len(titles) == 4
        assert not [t for t in titles if re.search("share|cloud|edit|upload|studio", t, re.IGNORECASE)]


class TestSaved:
    def test_numbers(self, opened, runs):
        choose(opened, 0, "x, z of beam.end")
        with opened.tab.expect_download() as saved:
            opened.tab.locator(".panel .save", has_text="csv").first.click()
        head, rows = table(saved.value)
        assert head == ["t [s]", "x [m]", "z [m]"]
        np.testing.assert_allclose(rows[:, 1:], runs["stiff"].position("beam.end")[:, [0, 2]], atol=1e-6)

    def test_numbers_along_a_body(self, opened, runs):
        choose(opened, 1, "tension along beam")
        opened.seek(0)
        with opened.tab.expect_download() as saved:
            opened.tab.locator(".panel .save", has_text="csv").nth(1).click()
        head, rows = table(saved.value)
        assert head == ["s [m]", "tension at 0 s [N]", "least [N]", "greatest [N]"]
        assert (rows[:, 2] <= rows[:, 1] + 1e-4).all()
        assert (rows[:, 1] <= rows[:, 3] + 1e-4).all()

    @pytest.mark.parametrize("of", ["#save", ".panel .save >> nth=0"])
    def test_pictures(self, opened, of):
        opened.seek(30)
        with opened.tab.expect_download() as saved:
            opened.tab.click(of)
        assert saved.value.suggested_filename.endswith(".png")
        with Image.open(saved.value.path()) as picture:
            assert picture.width >= 1000
            assert coloured(np.asarray(picture.convert("RGB")).astype(int)).sum() > 500


class TestCompared:
    def test_two_runs(self, browser, runs, tmp_path):
        opened = Opened(browser, write_view(runs, tmp_path / "view.html", frames=FRAMES))
        names = opened.tab.locator("#legend label").all_inner_texts()
        assert names == ["stiff", "soft", "clamp", "path of stiff: beam.end", "path of soft: beam.end"]
        choose(opened, 0, "x, z of beam.end")
        found = {trace["name"]: trace["line"]["color"] for trace in opened.ask("panels[0].curves.data")}
        assert [*found] == ["stiff: x", "stiff: z", "soft: x", "soft: z"]
        assert found["stiff: x"] == found["stiff: z"] == style.LOOKS[0].color
        assert found["soft: x"] == found["soft: z"] == style.LOOKS[1].color
        opened.seek(FRAMES - 1)  # beyond the end of the softer one, which stays where it ended
        tips = opened.ask("picture.div.data.filter((d) => d.customdata === undefined && d.mode === 'lines'"
                          " && ['stiff', 'soft'].includes(d.name)).map((d) => d.z.at(-2))")  # fmt: skip
        wanted = [result.position("beam.end")[-1, 2] for result in runs.values()]
        assert tips == pytest.approx(wanted, abs=1e-6)
        choose(opened, 1, "tension along beam")
        assert len(opened.ask("panels[1].curves.data")) == 6
        opened.quiet()


def shorter(source, target, rows):
    """The file as it was while its run went on."""
    shutil.copy(source, target)
    with h5py.File(target, "r+", libver="latest") as file:
        file["status"][()] = 0
        for name in ("time", "q", "v", "work", "energy"):
            file[name].resize(rows, axis=0)


class TestLive:
    def test_the_page_follows_the_file(self, browser, runs, tmp_path):
        path, whole = tmp_path / "results.h5", runs["stiff"]._store.path
        shorter(whole, path, 31)
        view = LiveView(path, {"frames": 500})
        serving = threading.Thread(target=view.serve)
        serving.start()
        try:
            opened = Opened(browser, view.url)
            assert opened.ask("LAST") == 30
            assert opened.ask("__ancf.frame") == 30
            opened.tab.get_by_label("path of beam.end").uncheck()
            shorter(whole, tmp_path / "more.h5", 61)
            (tmp_path / "more.h5").replace(path)
            opened.wait("LAST === 60 && __ancf.frame === 60")
            opened.seek(10)
            shutil.copy(whole, tmp_path / "more.h5")
            (tmp_path / "more.h5").replace(path)
            opened.wait("LAST === 200 && document.querySelector('.badge').textContent === 'complete'")
            assert opened.ask("__ancf.frame") == 10
            assert not opened.tab.get_by_label("path of beam.end").is_checked()
            assert opened.tab.inner_text("#foot") == "results.h5: 201 states"
            assert opened.ask("fetch('/data', {headers: {}}).then((r) => r.status)") == 200
            assert [text for text in opened.wrong if "favicon" not in text] == []
            assert opened.ask("__ancf.errors") == []
            assert all(url.startswith((view.url, "data:", "blob:")) for url in opened.asked)
        finally:
            view.close()
            serving.join()

    def test_others_are_not_answered(self, runs):
        """A page from elsewhere that has its name point to this machine."""
        import http.client

        view = LiveView(runs["stiff"]._store.path, {})
        serving = threading.Thread(target=view.serve)
        serving.start()
        try:
            asked = http.client.HTTPConnection(view.url.removeprefix("http://").rstrip("/"))
            asked.request("GET", "/data", headers={"Host": "evil.example:80"})
            assert asked.getresponse().status == 403
        finally:
            view.close()
            serving.join()


def test_in_a_notebook(browser, runs, tmp_path):
    """In a frame without rights in the notebook's page."""
    framed = runs["soft"].view(frames=5, height=400)
    assert re.fullmatch(r"<page of \d\.\d MB: .*>", repr(framed))
    (tmp_path / "book.html").write_text(f"<!DOCTYPE html><p>cell</p>{framed._repr_html_()}", encoding="utf-8")
    tab = browser.new_page()
    tab.set_default_timeout(browsing.PATIENCE)
    tab.goto((tmp_path / "book.html").as_uri())
    inner = tab.frames[1]
    inner.wait_for_function("window.__ancf && (window.__ancf.ready || window.__ancf.errors.length)")
    assert inner.evaluate("__ancf.errors") == []
    assert inner.evaluate("LAST") == 4
    assert framed.save(tmp_path / "alone.html").read_text(encoding="utf-8") == framed.text
    tab.close()


WIDE, NARROW = (1400, 900), (400, 800)


@pytest.mark.parametrize(
    ("scheme", "size"),
    [
        ("light", NARROW),
        ("dark", WIDE),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in (("light", WIDE), ("dark", NARROW))),
    ],
)
def test_everybody_can_read_it(browser, runs, tmp_path, size, scheme):
    """No finding of axe, nothing beside the screen, a background as the screen's."""
    path = write_view(runs, tmp_path / "view.html", frames=5)
    tab = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
    tab.set_default_timeout(browsing.PATIENCE)
    tab.goto(path.as_uri())
    tab.wait_for_function("window.__ancf && (window.__ancf.ready || window.__ancf.errors.length)")
    assert tab.evaluate("__ancf.errors") == []
    assert browsing.findings(tab) == []
    assert tab.evaluate("document.documentElement.scrollWidth") <= size[0]
    light = browsing.brightness(tab)
    assert light > 200 if scheme == "light" else light < 60
    tab.close()
