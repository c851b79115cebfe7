"""``ancf docs``: the list of pages, the page about a word, the copy."""

import re
from pathlib import Path

import pytest

from ancf.cli import docs
from places import ROOT

#: What users ask for, and the page on which they should land.
ASKED = {
    "Campbell diagram": "howto/statics_and_modes",
    "rotordynamics": "howto/statics_and_modes",
    "elevator": "howto/winch",
    "dead time": "howto/lead_a_run",
    "winch": "howto/winch",
    "joints": "howto/joints",
    "mooring": "tutorials/mooring",
    "howto/studies": "howto/studies",
    "limits": "limits",
    "Excel": "howto/export",
    "seabed": "howto/water_wind_ground",
    "units": "howto/model_file",
    "restart": "howto/read_results",
    "Knot": "howto/touching",
    "Monte Carlo": "howto/studies",
    "how to cite": "index",
    "cite": "index",
    "GPU": "limits",
    "gravity off": "howto/statics_and_modes",
    "large deformation": "howto/choose_element",
    "motor": "howto/supports_and_loads",
    "reaction moment": "howto/supports_and_loads",
    "prestress": "howto/supports_and_loads",
    "pretension": "howto/supports_and_loads",
    "buckling": "howto/statics_and_modes",
    "arch": "howto/statics_and_modes",
    "torsion": "howto/choose_element",
    "moving load": "howto/joints",
    "touch down": "howto/water_wind_ground",
    "VIV": "limits",
    "strumming": "limits",
    "diffraction": "limits",
    "double pendulum": "howto/joints",
    "sliding mass": "howto/joints",
    "telescopic": "howto/joints",
    "rotating frame": "howto/statics_and_modes",
    "rotating": "howto/statics_and_modes",
    "modal analysis": "howto/statics_and_modes",
    "convergence study": "howto/verify_a_run",
    "mesh refinement": "howto/verify_a_run",
    "scipy.optimize": "howto/sensitivities",
    "L-BFGS": "howto/sensitivities",
    "gradient-based": "howto/sensitivities",
    "multiprocess": "howto/studies",
    "resume": "howto/read_results",
    "interrupted run": "howto/read_results",
    "netcdf": "howto/read_results",
    "touch-down point": "howto/water_wind_ground",
    "TDP": "howto/water_wind_ground",
    "touchdown point": "howto/water_wind_ground",
    "bottom friction": "howto/water_wind_ground",
    "anchor uplift": "howto/water_wind_ground",
    "suspended length": "howto/water_wind_ground",
    "clump weight": "howto/water_wind_ground",
    "static offset": "tutorials/mooring",
    "offset curve": "tutorials/mooring",
    "restoring force": "tutorials/mooring",
    "rope breaks": "howto/joints",
    "line break": "howto/joints",
    "cut the rope": "howto/joints",
    "quick release": "howto/joints",
    "line failure": "howto/joints",
    "payout": "howto/winch",
    "spooling": "howto/surfaces",
    "dropper tolerance": "howto/overhead_line",
    "blow-off": "howto/overhead_line",
    "Seitenhalter": "howto/overhead_line",
    "Nachspannung": "howto/overhead_line",
    "Stützpunkt": "howto/overhead_line",
}


def test_the_list_has_all_pages_with_their_titles(call):
    ran = call("docs")
    assert ran.code == 0
    there = {f.relative_to(ROOT / "docs").with_suffix("").as_posix() for f in (ROOT / "docs").rglob("*.md")}
    there = {name for name in there if not name.startswith(("reference/", "_build/"))}
    said = dict(re.split(r"\s{2,}", line, maxsplit=1) for line in ran.out.splitlines() if "  " in line)
    assert set(said) == there
    assert said["howto/joints"] == "Join bodies, let points slide"


@pytest.mark.parametrize(("word", "page"), ASKED.items())
def test_a_word_finds_its_page(call, word, page):
    ran = call("docs", word)
    assert ran.code == 0
    assert docs.ranked(word)[0] == page
    assert ran.out.startswith(f"# {docs.title(docs.pages()[page])}")
    assert "<!--" not in ran.out
    for mark in ("{index}", "{figure}", "[](", "\n% "):
        assert mark not in ran.out


def test_several_words_need_no_quotes(call):
    assert call("docs", "capstan", "friction").out == call("docs", "capstan friction").out


def test_words_are_whole(tmp_path, monkeypatch):
    """A word is looked for at its beginning, a short one alone; of several the page with most."""
    (tmp_path / "limits.md").write_text("# One\n\nit is excited by a command\n", encoding="utf-8")
    (tmp_path / "two.md").write_text("# Two\n\nwho cites it, in mm, of springs, a rope\n", encoding="utf-8")
    (tmp_path / "three.md").write_text("# Three\n\nof a spring in the middle of a hinge\n", encoding="utf-8")
    monkeypatch.setattr(docs, "PLACES", (tmp_path,))
    assert docs.ranked("cite") == ["two"]
    assert docs.ranked("mm") == ["two"]
    assert docs.ranked("spring") == ["three", "two"]
    assert docs.ranked("the hinge of a spring") == ["three", "two"]
    assert docs.ranked("rope with a winch") == ["two"]


@pytest.mark.parametrize("word", ["warpdrive", "", "  "])
def test_a_word_on_no_page(call, word):
    ran = call("docs", word)
    assert ran.code == 2
    assert "is on no page" in ran.said


def test_a_link_without_words_has_the_title_of_its_page(tmp_path, monkeypatch):
    (tmp_path / "limits.md").write_text("# What it cannot do\n", encoding="utf-8")
    (tmp_path / "howto").mkdir()
    page = tmp_path / "howto" / "one.md"
    page.write_text(
        "% a note\n# One\n\nsee [](../limits.md#torsion) and [](gone.md),\n"
        "[words](../limits.md), [](#two-words).\n"
        "\n"
        "```{figure} ../a.png\n:alt: What is seen\n\nA caption.\n```\nend\n",
        encoding="utf-8",
    )
    monkeypatch.setattr(docs, "PLACES", (tmp_path,))
    assert docs.plain(page) == (
        '# One\n\nsee "What it cannot do" (`ancf docs limits`) and gone.md,\n'
        '[words](../limits.md), "Two words".\n'
        "\n"
        "A caption.\nend\n"
    )


def test_a_copy_and_what_was_changed(call):
    assert call("docs", "--copy", "pages").code == 0
    assert Path("pages/howto/joints.md").read_bytes() == (ROOT / "docs/howto/joints.md").read_bytes()
    Path("pages/limits.md").write_text("mine", encoding="utf-8")
    assert call("docs", "--copy", "pages").code == 2
    assert Path("pages/limits.md").read_text(encoding="utf-8") == "mine"
