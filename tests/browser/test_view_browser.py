"""The page that ``ancf view`` writes in a real browser: it draws, plays, seeks and colours."""

import io
import re

import numpy as np
import pytest
from PIL import Image

import browsing
import viewed
from ancf.viz.scene import Link, Marker, Scene, Strip, Thread, Triad
from ancf.viz.view import Curve, Part, page, write_view
from helpers import rotation

NO_WEBGL = """
const original = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind.startsWith("webgl") ? null : original.call(this, kind, ...more);
};
"""


@pytest.fixture(scope="module")
def cantilever(tmp_path_factory):
    return viewed.cantilever(tmp_path_factory.mktemp("cantilever"))


@pytest.fixture(scope="module")
def bead():
    return viewed.bead()


class Opened:
    """A page in the browser, with all that it complained about and asked for."""

    def __init__(self, browser, path, script=None):
        self.tab = browser.new_page(viewport={"width": 900, "height": 560})
        self.tab.set_default_timeout(browsing.PATIENCE)
        self.wrong, self.asked = browsing.listen(self.tab)
        if script:
            self.tab.add_init_script(script)
        self.tab.goto(path if isinstance(path, str) else path.as_uri())
        self.wait("window.__ancf && (window.__ancf.ready || window.__ancf.errors.length)")

    def wait(self, condition):
        self.tab.wait_for_function(condition)

    def ask(self, expression):
        return self.tab.evaluate(expression)

    def seek(self, k):
        self.ask(f"__ancf.seek({k})")
        self.settle()

    def settle(self):
        """Until the picture shows the present state."""
        self.wait("player.drawn === __ancf.frame")
        self.ask("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def picture(self):
        """Pixels of the picture in three dimensions, without what the mouse does."""
        shot = self.tab.locator("#stage").screenshot()
        return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)

    def quiet(self):
        assert self.wrong == []
        assert self.ask("__ancf.errors") == []
        assert all(url.startswith(("file:", "data:", "blob:")) for url in self.asked), self.asked


def coloured(pixels):
    """Where a picture is neither white nor grey."""
    return np.ptp(pixels, axis=2) > 60


@pytest.fixture(scope="module")
def opened(browser, cantilever, tmp_path_factory):
    """The page of the cantilever, for all tests of what one can do with it."""
    path = write_view(cantilever, tmp_path_factory.mktemp("page") / "view.html", frames=60)
    shown = Opened(browser, path)
    yield shown
    shown.quiet()
    shown.tab.close()


class TestInBrowser:
    def test_the_beam_is_drawn_and_moves(self, opened):
        opened.seek(0)
        first = opened.picture()
        assert coloured(first).sum() > 500
        opened.seek(59)
        last = opened.picture()
        assert (coloured(first) != coloured(last)).sum() > 500
        opened.seek(0)
        assert (coloured(first) != coloured(opened.picture())).sum() < 50

    def test_play_goes_on_and_pauses(self, opened):
        opened.seek(0)
        opened.tab.click("#play")
        opened.wait("__ancf.frame >= 3 && player.drawn > 0")
        assert opened.ask("__ancf.playing")
        opened.tab.click("#play")
        stopped = opened.ask("__ancf.frame")
        assert not opened.ask("__ancf.playing")
        opened.settle()
        assert opened.ask("__ancf.frame") == stopped

    def test_keys(self, opened):
        opened.seek(10)
        opened.tab.keyboard.press("ArrowRight")
        assert opened.ask("__ancf.frame") == 11
        opened.tab.keyboard.press("Shift+ArrowLeft")
        assert opened.ask("__ancf.frame") == 1
        opened.tab.keyboard.press("End")
        assert opened.ask("__ancf.frame") == 59
        opened.tab.keyboard.press(" ")
        assert opened.ask("__ancf.playing")
        opened.tab.keyboard.press(" ")
        assert not opened.ask("__ancf.playing")

    def test_without_loop_it_stops_at_the_end(self, opened):
        opened.tab.uncheck("#loop")
        opened.seek(57)
        opened.tab.click("#play")
        opened.wait("!__ancf.playing")
        assert opened.ask("__ancf.frame") == 59
        opened.tab.check("#loop")

    def test_slider_seeks(self, opened, cantilever):
        opened.tab.fill("#time", "30")
        opened.settle()
        assert opened.ask("__ancf.frame") == 30
        t = opened.ask("TIMES[30]")
        assert opened.tab.inner_text("#now") == f"t = {t:.4f} s"
        tip = opened.ask("picture.div.data.find((d) => d.kind === undefined && d.customdata).z.at(-2)")
        k = int(np.argmin(np.abs(cantilever.t - t)))
        assert tip == pytest.approx(cantilever.position("beam.end")[k, 2], abs=1e-6)

    def test_click_on_a_plot_seeks(self, opened):
        box = opened.tab.locator(".plot").first.bounding_box()
        inside = opened.ask("(({_offset: o, _length: l}) => [o, l])(panels[0].curves._fullLayout.xaxis)")
        opened.tab.mouse.click(box["x"] + inside[0] + 0.5 * inside[1], box["y"] + 0.4 * box["height"])
        assert opened.ask("Math.abs(TIMES[__ancf.frame] - 0.1)") < 0.005

    def test_colour(self, opened):
        bar = "picture.div.data.find((d) => d.line?.showscale).line.colorbar.title.text"
        opened.seek(40)
        assert opened.ask(bar) == "tension [N]"
        before = opened.picture()
        opened.tab.select_option("#color", "speed")
        opened.wait(f"{bar} === 'speed [m/s]'")
        opened.settle()
        assert np.abs(opened.picture() - before).max(axis=2).astype(bool).sum() > 300
        opened.tab.select_option("#color", "plain")
        opened.wait("!picture.div.data.some((d) => d.line?.showscale)")
        opened.tab.select_option("#color", "tension")
        opened.wait(f"{bar} === 'tension [N]'")

    def test_legend_hides_and_shows(self, opened):
        opened.seek(59)
        box = opened.tab.get_by_label("path of beam.end")
        before = coloured(opened.picture()).sum()
        box.uncheck()
        opened.wait("picture.div.data.filter((d) => d.visible === false).length === 2")
        opened.seek(58)
        opened.seek(59)
        assert coloured(opened.picture()).sum() < before - 100
        box.check()
        opened.wait("picture.div.data.every((d) => d.visible !== false)")

    def test_panels(self, opened):
        texts = opened.tab.locator(".panel select").first.locator("option").all_inner_texts()
        along = [f"{name} along beam" for name in ("tension", "curvature", "speed")]
        along += [f"{axis} displacement along beam" for axis in "xz"]
        assert texts == ["energy, potential from the start", "x, z of beam.end", *along]
        opened.seek(59)
        assert re.fullmatch(r"\s*x 0\.\d+ m", opened.ask("panels[1].keys.children[0].textContent"))


class TestOtherPages:
    def test_everything_at_once(self, browser, bead, tmp_path):
        """A sliding joint, a mass, supports, a string that goes slack or not; from memory."""
        opened = Opened(browser, write_view(bead, tmp_path / "view.html", frames=20))
        opened.seek(19)
        names = opened.tab.locator("#legend label").all_inner_texts()
        assert names == ["wire", "springs", "slack springs", "point mass", "pin", "slide", "path of bead"]
        mass = opened.ask("picture.div.data.find((d) => d.name === 'point mass').x[0]")
        assert mass == pytest.approx(bead.position("bead")[-1, 0], abs=1e-6)
        opened.tab.select_option("#camera", "3-D")
        opened.tab.select_option("#aspect", "stretched")
        opened.wait("document.getElementById('stretch').textContent.startsWith('not to scale')")
        opened.quiet()

    def test_one_state_has_no_player(self, browser, bead, tmp_path):
        opened = Opened(browser, write_view(bead.state(-1), tmp_path / "view.html"))
        assert not opened.tab.is_visible("#player")
        assert opened.ask("panels.map((panel) => panel.shown.name)")[0] == "tension along wire"
        assert coloured(opened.picture()).sum() > 300
        opened.quiet()

    def test_window_follows_a_strip(self, browser, tmp_path):
        opened = Opened(browser, self.line(tmp_path))
        assert opened.ask("document.getElementById('follow').value") == "contact"
        assert opened.ask("picture.stretched")
        assert re.fullmatch(r"not to scale: y × \d+, z × \d+", opened.tab.inner_text("#stretch"))
        for k in (0, 4):
            opened.seek(k)
            x = opened.ask("picture.div.layout.scene.xaxis.range")
            assert x == pytest.approx([100 * k + 40, 100 * k + 160])
        assert "contact 140 N" in opened.tab.inner_text("#now")
        opened.tab.select_option("#follow", "")
        opened.wait("picture.div.layout.scene.xaxis.range[1] > 600")
        opened.quiet()

    def line(self, folder):
        """A wire of 600 m, and a strip that passes under it at 100 m/s."""
        t, x = np.arange(5.0), np.linspace(0, 600, 61)
        wire = np.zeros((5, 61, 3))
        wire[..., 0], wire[..., 2] = x, 1.0 + 0.1 * np.sin(x / 20)
        place = np.stack([100 + 100 * t, 0 * t, 1 + 0 * t], axis=1)
        half = np.array([0, 0.5, 0])
        ends = np.stack([place - half, place + half], axis=1)
        tension = {"tension": 1e4 + np.zeros((5, 61))}
        scene = Scene(
            "line",
            t,
            [Thread("wire", "cable", x, wire, tension)],
            [Link("dropper", ends + np.array([0, 0, 1]), 1.0 + t, t > 2)],
            strips=[Strip("contact", ends, 100 + 10 * t)],
            stored=5,
        )
        curve = Curve("contact", "N", t, 100 + 10 * t, "contact force")
        path = folder / "line.html"
        path.write_text(page(Part(scene, curves=[curve]), "Line"), encoding="utf-8")
        return path

    def test_body_axes_are_columns(self, browser, tmp_path):
        """From the centre along the columns of the rotation, the first axis first."""
        t, turn = np.arange(3.0), rotation((1, 2, -0.5), 2.1)
        centre = np.stack([t, 0 * t, 1 + 0 * t], axis=1)
        triad = Triad("body", centre, np.stack([np.eye(3), turn, turn @ turn]), 0.5)
        scene = Scene("body", t, triads=[triad], markers=[Marker("body", "rigid body", centre)], stored=3)
        path = tmp_path / "body.html"
        path.write_text(page(scene, "Body"), encoding="utf-8")
        opened = Opened(browser, path)
        for k, wanted in enumerate((np.eye(3), turn, turn @ turn)):
            opened.seek(k)
            drawn = opened.ask(
                "(({x, y, z}) => [x, y, z])(picture.div.data.find((d) => d.name === 'body axes'))"
            )
            ends = np.array(drawn, dtype=float).reshape(3, 3, 3)[..., :2]  # xyz, axis, from and to
            assert ends[..., 1] - ends[..., 0] == pytest.approx(0.5 * wanted, abs=1e-6)
        opened.quiet()

    def test_without_webgl_a_message_is_seen(self, browser, cantilever, tmp_path):
        opened = Opened(browser, write_view(cantilever, tmp_path / "view.html", frames=5), NO_WEBGL)
        assert "no WebGL" in opened.tab.inner_text("#stage")
        assert opened.tab.is_visible(".plot")
        opened.tab.keyboard.press("End")
        assert opened.ask("__ancf.frame") == 4
        opened.quiet()
