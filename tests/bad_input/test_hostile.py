"""Every file of tests/data/hostile is right, or refused with exit code 2 and its place: hostile_files.py."""

import re

import pytest

import ancf
import hostile_files
from hostile_files import FOLDER

#: Files in which nothing is wrong, whatever they look like.
RIGHT = {
    "explicit_very_stiff.toml",
    "joint_formulas.toml",
    "joint_names.toml",
    "killed.h5",
    "line_droppers_many.toml",
    "line_right.toml",
    "line_span_bare.toml",
    "line_title_with_escapes.toml",
    "mark.toml",
    "name_long.toml",
    "output_step_endless.toml",
    "output_step_overflow.toml",
    "path_back.toml",
    "path_uneven.toml",
    "right.h5",
    "stiffness_overflow.toml",
    "title_with_escapes.toml",
}
FILES = sorted(path for path in FOLDER.iterdir() if path.is_file())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_check(call, path):
    ran = call("check", path)
    assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]", ran.out + ran.err)
    if path.name in RIGHT:
        assert (ran.code, ran.err) == (0, "")
        assert ran.out.startswith(f"{path}: right; ")
    else:
        assert (ran.code, ran.out) == (2, "")
        assert re.match(r"error: [^\n:]+: \S", ran.err), ran.err
        assert len(ran.err) < 3000


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("external_data", '"q" keeps its data in another file'),
        ("virtual_data", '"q" keeps its data in another file'),
        ("external_link", '"v" is a link to another place or file'),
        ("external_body", '"bodies" is a link to another place or file'),
        ("soft_link", '"energy" is a link to another place or file'),
    ],
)
def test_data_elsewhere_are_not_looked_for(name, said):
    """They are refused for where they are, whatever is there."""
    path = FOLDER / f"{name}.h5"
    with pytest.raises(ancf.ModelError) as caught:
        ancf.load(path)
    assert (caught.value.where, caught.value.what) == (str(path), f"is refused: {said}")


def test_all_files_are_there():
    """What the generator writes and what is kept have the same names and, but for results, the same bytes."""
    texts = {
        f"{name}.toml": text.encode() for name, text in (*hostile_files.models(), *hostile_files.lines())
    }
    for name, data in (*texts.items(), *hostile_files.raw()):
        assert (FOLDER / name).read_bytes() == data, name
    assert {path.name for path in FILES} > RIGHT | set(texts)
