"""Films of results and modes, as files and in notebooks: their frames are the states."""

import itertools
import subprocess
import sys
import types

import numpy as np
import pytest
from PIL import Image

import ancf
from ancf.viz.pictures.movie import ffmpeg, write_movie
from ancf.viz.scene import make_scene


class TestMovies:
    def test_gif_has_the_frames(self, result, tmp_path):
        path = result.animate(trace=["ball"], frames=5).save(tmp_path / "rope.gif", fps=20, width=301)
        with Image.open(path) as movie:
            assert movie.n_frames == 5
            assert movie.size[0] == 300
            assert movie.info["duration"] == 50
            frames = []
            for k in range(5):
                movie.seek(k)
                frames.append(np.asarray(movie.convert("L"), dtype=float))
        assert all(np.abs(a - b).max() > 50 for a, b in itertools.pairwise(frames))
        assert frames[0].std() > 10

    def test_mode(self, model, tmp_path):
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=2)
        path = modes.animate(1, frames=4).save(tmp_path / "mode.gif", width=200)
        with Image.open(path) as movie:
            assert movie.n_frames == 4

    def test_space(self, spatial, tmp_path):
        path = write_movie(make_scene(spatial, frames=2), tmp_path / "arm.gif", color="speed", width=300)
        with Image.open(path) as movie:
            assert movie.n_frames == 2

    @pytest.mark.skipif(not ffmpeg(), reason="no ffmpeg, and no imageio-ffmpeg for this machine")
    @pytest.mark.parametrize("width", [333, 480])
    def test_mp4_has_the_frames(self, result, tmp_path, width):
        """They are read again, and are those of the GIF."""
        scene = make_scene(result, frames=4)
        path = write_movie(scene, tmp_path / "rope.mp4", fps=10, width=width)
        assert path.read_bytes()[4:8] == b"ftyp"
        raw = ["-f", "rawvideo", "-pix_fmt", "gray", "-fps_mode", "passthrough", "-"]
        done = subprocess.run(
            [ffmpeg(), "-v", "error", "-i", str(path), *raw], capture_output=True, check=True
        )
        with Image.open(write_movie(scene, tmp_path / "rope.gif", fps=10, width=width)) as movie:
            wide, high = movie.size
            found = np.frombuffer(done.stdout, dtype=np.uint8).reshape(4, high, wide).astype(float)
            for k, frame in enumerate(found):
                movie.seek(k)
                assert np.mean(np.abs(frame - np.asarray(movie.convert("L"), dtype=float))) < 4.0
        assert all(np.abs(a - b).max() > 50 for a, b in itertools.pairwise(found))

    def test_mp4_by_the_program_that_a_package_brings(self, result, tmp_path, monkeypatch):
        """A stand-in keeps what it was told and the pictures that it was given."""
        program = tmp_path / "brought"
        program.write_text('#!/bin/sh\nfor last; do :; done\nexec /bin/cat > "$last"\n')
        program.chmod(0o700)
        brings = types.SimpleNamespace(get_ffmpeg_exe=lambda: str(program))
        monkeypatch.setitem(sys.modules, "imageio_ffmpeg", brings)
        monkeypatch.setenv("PATH", str(tmp_path))
        path = write_movie(make_scene(result, frames=3), tmp_path / "rope.mp4", width=300)
        with_sides = path.stat().st_size / 3 / 4 / 300
        assert with_sides == int(with_sides) > 100  # three pictures of four bytes for each place

    def test_mp4_without_ffmpeg(self, result, tmp_path, monkeypatch):
        monkeypatch.setenv("PATH", str(tmp_path))
        monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
        with pytest.raises(ancf.ModelError, match=r"needs the program ffmpeg.*write a .gif"):
            result.animate().save(tmp_path / "rope.mp4")

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"fps": 0}, "movie.fps"),
            ({"width": 10}, "movie.width"),
            ({"view": "xq"}, "movie.view"),
            ({"color": "heat"}, "movie.color"),
        ],
    )
    def test_wrong_options(self, result, tmp_path, options, message):
        with pytest.raises(ancf.ModelError, match=message):
            write_movie(make_scene(result, frames=2), tmp_path / "a.gif", **options)

    def test_wrong_file(self, result, tmp_path):
        with pytest.raises(ancf.ModelError, match=r"use .html, .mp4, .gif"):
            result.animate().save(tmp_path / "a.avi")
        with pytest.raises(ancf.ModelError, match=r"use .mp4 or .gif"):
            write_movie(make_scene(result, frames=2), tmp_path / "a.mov")
        (tmp_path / "file").write_text("")
        with pytest.raises(ancf.ModelError, match="cannot be written"):
            result.animate(frames=1).save(tmp_path / "file" / "a.gif")


class TestAnimation:
    @pytest.fixture
    def asked(self, monkeypatch):
        """A stand-in for the viewer that keeps what it was asked."""
        given = {}

        def view_page(source, **options):
            given.update(options, source=source)
            return '<p title="a & b">page</p>'

        def write_view(source, path, **options):
            path.write_text(view_page(source, **options), encoding="utf-8")
            return path

        stand_in = types.ModuleType("ancf.viz.view")
        stand_in.view_page, stand_in.write_view = view_page, write_view
        monkeypatch.setitem(sys.modules, "ancf.viz.view", stand_in)
        return given

    def test_notebook(self, result, model, asked):
        found = result.animate(
            "speed", trace=[model.bodies["ball"], "rope.end"], frames=7, end=0.1
        )._repr_html_()
        assert 'srcdoc="&lt;p title=&quot;a &amp; b&quot;&gt;page&lt;/p&gt;"' in found
        assert asked["source"] is result
        assert (asked["color"], asked["frames"], asked["end"]) == ("speed", 7, 0.1)
        assert asked["trace"] == ("ball", "rope.end")

    def test_page(self, result, asked, tmp_path):
        path = result.animate().save(str(tmp_path / "rope.html"))
        assert path.read_text() == '<p title="a & b">page</p>'
        assert asked["trace"] is None

    def test_mode(self, model, asked):
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=3)
        modes.animate(2)._repr_html_()
        assert (asked["mode"], asked["color"]) == (2, "plain")
        with pytest.raises(ancf.ModelError, match=r"animate.mode: must be between 0 and 2"):
            modes.animate(3)

    def test_wrong_trace(self, result):
        with pytest.raises(ancf.ModelError, match="unknown body 'rop'"):
            result.animate(trace=["rop.end"])

    def test_repr_is_one_line(self, result):
        assert repr(result.animate()).startswith("Animation(Result('Rope', 101 states")
