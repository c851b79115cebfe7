"""One import dialect, one home for the kinds of arrays, one scalar product."""

import ast
import re
from functools import cache
from pathlib import Path

import ancf

ROOT = Path(ancf.__file__).parent
MODULES = sorted(ROOT.rglob("*.py"))
ARRAYS = {"FloatArray", "IntArray", "BoolArray"}


@cache
def imports(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]


def place(path):
    return path.relative_to(ROOT).as_posix()


def test_imports_are_relative():
    """`import ancf` is the public face; what a module has is imported by where it stands."""
    whole = [(place(path), node) for path in MODULES for node in imports(path) if not node.level]
    assert [(file, node.lineno) for file, node in whole if node.module.split(".")[0] == "ancf"] == []


def test_arrays_have_one_home():
    home = ROOT / "arrays.py"
    assert set(re.findall(r"^(\w+) = NDArray", home.read_text(encoding="utf-8"), re.M)) == ARRAYS
    for path in (path for path in MODULES if path != home):
        text = path.read_text(encoding="utf-8")
        assert re.findall(r"^(?:FloatArray|IntArray|BoolArray) = .*", text, re.M) == [], place(path)
        for node in imports(path):
            if ARRAYS & {alias.name for alias in node.names}:
                assert (node.module or "").split(".")[-1] == "arrays", (place(path), node.lineno)


def test_one_scalar_product():
    defined = [place(path) for path in MODULES if '"""Scalar product."""' in path.read_text(encoding="utf-8")]
    assert defined == ["vectors.py"]
