"""One import dialect, one home for the kinds of arrays, one scalar product."""

import ast
import re
from pathlib import Path

import pytest

import ancf

ROOT = Path(ancf.__file__).parent
MODULES = sorted(ROOT.rglob("*.py"))
ARRAYS = {"FloatArray", "IntArray", "BoolArray"}


def imports(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]


def place(path):
    return path.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("path", MODULES, ids=place)
def test_imports_are_relative(path):
    """`import ancf` is the public face; what a module has is imported by where it stands."""
    whole = [node for node in imports(path) if not node.level]
    assert [node.lineno for node in whole if node.module.split(".")[0] == "ancf"] == []


@pytest.mark.parametrize("path", MODULES, ids=place)
def test_arrays_have_one_home(path):
    text = path.read_text(encoding="utf-8")
    if path == ROOT / "arrays.py":
        assert set(re.findall(r"^(\w+) = NDArray", text, re.M)) == ARRAYS
        return
    assert re.findall(r"^(?:FloatArray|IntArray|BoolArray) = .*", text, re.M) == []
    for node in imports(path):
        if ARRAYS & {alias.name for alias in node.names}:
            assert (node.module or "").split(".")[-1] == "arrays", node.lineno


def test_one_scalar_product():
    defined = [place(path) for path in MODULES if '"""Scalar product."""' in path.read_text(encoding="utf-8")]
    assert defined == ["vectors.py"]
