"""The gallery: every script runs and saves its picture, is on the page, and its picture is there."""

import runpy
import sys

import pytest

from places import DOCS

sys.path.insert(0, str(DOCS))

import code_blocks
import gallery_pictures

PAGE = (DOCS / "gallery.md").read_text(encoding="utf-8")
SCRIPTS = gallery_pictures.SCRIPTS
#: What is shorter here: as a script has it, and what runs instead.
SHORT = {
    "falling_cantilever": [("t_end=0.4", "t_end=0.05")],
    "pendulum_path": [("t_end=4.0", "t_end=0.05")],
    "slack_cables": [("(10.1, 10.5, 12.0)", "(10.5,)"), ("elements=20", "elements=8")],
    "roll_up": [("(0.25, 0.5, 0.75, 1.0)", "(0.25,)"), ("elements=16", "elements=4")],
    "elastica": [("(1.02, 1.05, 1.1, 1.2, 1.4, 1.7, 2.0)", "(1.4,)")],
    "convergence": [("[2, 4, 8, 16]", "[2, 4]"), ("tip(64)", "tip(8)")],
    "energy_of_methods": [("t_end=1.5", "t_end=0.05")],
    "spin_up": [("t_end=15.0", "t_end=0.1")],
    "slider_crank": [("t_end=0.84", "t_end=0.01")],
    "ropeway": [("t_end=6.0", "t_end=0.1")],
    "winch": [("t_end=12.0", "t_end=0.1")],
    "crossed_cables": [("t_end=1.0", "t_end=0.02")],
    "mooring_line": [("(90.0, 105.0, 115.0)", "(105.0,)")],
    "swell": [("t_end=40.0", "t_end=0.5")],
    "wind_on_a_conductor": [("t_end=60.0", "t_end=0.5")],
    "overhead_force": [("spans[:5]", "spans[:3]"), ("(120.0, 240.0)", "(70.0, 120.0)")],
    "elasticity": [("points=25", "points=2")],
    "sweep": [("1e5, 50)", "1e5, 2)")],
    "motion_from_csv": [("t_end=10.0", "t_end=0.1")],
    "two_results": [("t_end=3.0", "t_end=0.05")],
    "sensitivity_band": [("t_end=1.0", "t_end=0.02")],
    "twist": [("load_steps=8", "load_steps=2"), ("4 * np.pi", "0.4 * np.pi")],
}


@pytest.mark.parametrize("name", SCRIPTS)
@pytest.mark.filterwarnings("default::UserWarning")
def test_runs_and_saves_its_picture(name, tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    code_blocks.link_examples(tmp_path)
    text = SCRIPTS[name].read_text(encoding="utf-8")
    for long, short in SHORT.get(name, []):
        assert text.count(long) == 1, f"{name}.py: {long} is not there once"
        text = text.replace(long, short)
    script = tmp_path / f"{name}.py"
    script.write_text(text, encoding="utf-8")
    runpy.run_path(str(script), run_name="__main__")
    assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_each_is_on_the_page_with_its_picture():
    assert len(SCRIPTS) >= 20
    assert set(SHORT) <= set(SCRIPTS)
    for name, script in SCRIPTS.items():
        assert f"```{{literalinclude}} gallery/{name}.py\n" in PAGE
        assert f"(_static/gallery/{name}.png)" in PAGE
        assert (gallery_pictures.TARGET / f"{name}.png").exists()
        assert 7 <= len(script.read_text(encoding="utf-8").splitlines()) <= 42, name
