"""``ancf examples``: the list, the copy, and what is not overwritten."""

import re
import tomllib
from pathlib import Path

import ancf
from ancf.cli import docs, examples
from ancf.model.file import read_study
from places import ROOT


def test_the_list_says_what_each_is(call):
    ran = call("examples")
    assert ran.code == 0
    said = dict(re.split(r"\s{2,}", line, maxsplit=1) for line in ran.out.splitlines() if "  " in line)
    assert set(said) == {
        file.name for file in (ROOT / "examples").iterdir() if file.suffix in examples.SUFFIXES
    }
    assert "cantilever" in said["cantilever.toml"]


def test_a_copy_runs_from_where_it_is(call):
    assert call("examples", "--copy", ".").code == 0
    assert read_study("cantilever.toml").model.bodies
    assert {f.name for f in Path().glob("*.toml")} == {f.name for f in (ROOT / "examples").glob("*.toml")}
    assert call("examples", "--copy", ".").code == 0


def test_a_file_that_is_not_there_is_said_to_come_with_the_package(call):
    """What the README runs, where the package was installed without its sources; the hint works."""
    ran = call("run", "examples/cantilever.toml", "-o", "out")
    assert ran.code == 2
    assert "ancf examples --copy examples" in ran.said
    assert call("examples", "--copy", "examples").code == 0
    assert Path("examples/cantilever.toml").is_file()
    assert "examples --copy" not in call("run", "mine.toml", "-o", "out").said


def test_what_was_changed_stays(call):
    call("examples", "--copy", "mine")
    Path("mine/line.toml").write_text("mine", encoding="utf-8")
    ran = call("examples", "--copy", "mine")
    assert ran.code == 2
    assert "mine/line.toml is there and has changed" in ran.said.replace(":", "")
    assert Path("mine/line.toml").read_text(encoding="utf-8") == "mine"


def test_the_wheel_takes_them_along():
    plain = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    taken = plain["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]
    assert taken["examples"] == "ancf/examples"
    pages = {page.relative_to(ROOT / "docs") for page in map(Path, docs.pages().values())}
    assert {Path("docs") / (page if len(page.parts) == 1 else page.parts[0]) for page in pages} == {
        Path(source) for source in taken if source not in ("examples", "docs/gallery")
    }
    assert all(target == f"ancf/{source}" for source, target in taken.items())
    assert Path(ancf.__file__).parent / "examples" == examples.PLACES[0]


def test_names_that_are_offered():
    """What tab completion shows: all public names and nothing else."""
    assert dir(ancf) == sorted(ancf.__all__)
    assert all(getattr(ancf, name) is not None for name in dir(ancf))


def test_completion_of_a_shell(call):
    assert "--install-completion" in call("--help").out
