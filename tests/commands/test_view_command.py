"""``ancf view`` as a command, and what it says of wrong input."""

import shutil
import sys

import h5py
import pytest

import ancf
import viewed
from ancf.viz.view import Options, view_page, write_view
from viewed import array_of, data_of


@pytest.fixture(scope="module")
def cantilever(tmp_path_factory):
    return viewed.cantilever(tmp_path_factory.mktemp("cantilever"))


class TestErrors:
    def test_plotly_is_missing(self, cantilever, monkeypatch):
        monkeypatch.setitem(sys.modules, "plotly.offline", None)
        with pytest.raises(ancf.ModelError, match="plotly is not installed") as caught:
            view_page(cantilever)
        assert caught.value.hint == "pip install 'ancf[view]'"

    def test_nothing_was_stored(self, cantilever, tmp_path):
        copy = tmp_path / "empty.h5"
        cantilever.save(copy)
        with h5py.File(copy, "r+", libver="latest") as file:
            file["time"].resize(0, axis=0)
        with pytest.raises(ancf.ModelError, match=r"empty\.h5: no state was stored"):
            view_page(ancf.load(copy), file="empty.h5")

    @pytest.mark.parametrize(
        ("option", "says"),
        [
            ({"color": "red"}, "view.color"),
            ({"frames": 0}, "view.frames"),
            ({"trace": ["nobody.end"]}, "nobody"),
            ({"start": 3.0}, "no state is stored between"),
            ({"start": 0.2, "end": 0.1}, "behind the end"),
        ],
    )
    def test_wrong_options(self, cantilever, option, says):
        with pytest.raises(ancf.ModelError, match=says):
            view_page(cantilever, **option)

    def test_state_has_no_trace_to_ask_for(self, cantilever):
        with pytest.raises(ancf.ModelError, match=r"view\.trace"):
            view_page(cantilever.state(0), trace=["beam.end"])

    def test_colour_of_a_page(self):
        with pytest.raises(ancf.ModelError, match=r"view\.color"):
            Options(color="blue")

    def test_file_that_cannot_be_written(self, cantilever, tmp_path):
        (tmp_path / "taken").write_text("x")
        with pytest.raises(ancf.ModelError, match="cannot be written"):
            write_view(cantilever, tmp_path / "taken" / "view.html")


class TestCommand:
    @pytest.fixture
    def call(self, call, cantilever):
        cantilever.save("out/results.h5")
        return lambda *arguments: call("view", *arguments)

    def test_page_beside_the_results(self, call, tmp_path):
        assert call("out/results.h5") == (0, "out/view.html\n", "")
        data = data_of((tmp_path / "out/view.html").read_text(encoding="utf-8"))
        assert len(array_of(data, data["scene"]["t"])) == 201

    def test_folder_and_options(self, call, tmp_path):
        options = ("--frames", 5, "--color", "speed", "--trace", "beam.at(0.5)", "-o", "movie.html")
        assert call("out", *options) == (0, "movie.html\n", "")
        data = data_of((tmp_path / "movie.html").read_text(encoding="utf-8"))
        assert len(array_of(data, data["scene"]["t"])) == 5
        assert data["color"] == "speed"
        assert [trace["name"] for trace in data["traces"]] == ["beam.at(0.5)"]

    def test_open(self, call, tmp_path, monkeypatch):
        opened = []
        monkeypatch.setattr("webbrowser.open", opened.append)
        call("out/results.h5", "--no-open")
        assert opened == []
        call("out/results.h5", "--open")
        assert opened == [(tmp_path / "out/view.html").as_uri()]

    def test_live_names_runs_that_may_be_meant(self, call, tmp_path, monkeypatch):
        """Where it waits for a file; what it waits for is that of the folder, as long as it is not there."""
        waited = []

        def sleep(seconds):
            waited.append(seconds)
            raise KeyboardInterrupt

        monkeypatch.setattr("ancf.cli.view.time.sleep", sleep)
        (tmp_path / "empty").mkdir()
        assert call("--live", "empty").out == "waiting for empty/results.h5\n"
        (tmp_path / "runs/first").mkdir(parents=True)
        for name in ("runs/first/results.h5", "runs/second.h5"):
            shutil.copy(tmp_path / "out/results.h5", tmp_path / name)
        said = "waiting for runs/results.h5; other runs are in runs/first, runs/second.h5\n"
        assert call("--live", "runs").out == said
        assert call("--live", "runs/third.h5").out == "waiting for runs/third.h5\n"
        assert len(waited) == 3

    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (["nothing.h5"], "nothing.h5: there is no such file"),
            (["notes.txt"], "notes.txt: is not a results file of ancf"),
            (["out/results.h5", "--trace", "mast"], '"mast" is no point'),
            (["out/results.h5", "--color", "red"], '"tension", "curvature", "speed"'),
            (["out/results.h5", "-o", "view.pdf"], "give view.html"),
            (["out/results.h5", "-o", "results.h5"], "is not the name of an HTML file"),
        ],
    )
    def test_wrong_input(self, call, arguments, says, tmp_path):
        (tmp_path / "notes.txt").write_text("nothing")
        code, out, err = call(*arguments)
        assert (code, out) == (2, "")
        assert err.startswith("error: ")
        assert says in err

    def test_plotly_is_missing(self, call, monkeypatch):
        monkeypatch.setitem(sys.modules, "plotly.offline", None)
        code, _, err = call("out/results.h5")
        assert code == 2
        assert "plotly is not installed" in err
        assert "pip install 'ancf[view]'" in err
