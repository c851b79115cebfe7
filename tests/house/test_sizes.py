"""Sizes of files and functions, and names that stand for one thing in the whole package."""

import ast
import re

from test_layers import ROOT

FILES = sorted(path for path in ROOT.rglob("*") if path.suffix in (".py", ".js", ".css", ".html"))
SOURCES = [path for path in FILES if path.suffix == ".py"]
#: Lines of a file, and of a function that says nothing.
LONGEST_FILE, LONGEST_SILENT = 400, 60


def name(path):
    return path.relative_to(ROOT).as_posix()


def functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node, node.end_lineno - node.lineno + 1


def silent(text):
    """Long functions without a docstring."""
    return [f.name for f, lines in functions(text) if lines > LONGEST_SILENT and not ast.get_docstring(f)]


def test_files_are_short():
    lines = {name(path): len(path.read_text(encoding="utf-8").splitlines()) for path in FILES}
    assert {file: count for file, count in lines.items() if count > LONGEST_FILE} == {}


def test_long_functions_say_what_they_do():
    found = {name(path): silent(path.read_text(encoding="utf-8")) for path in SOURCES}
    assert {file: functions for file, functions in found.items() if functions} == {}


def test_the_rule_can_fail():
    body = "    x = 1\n" * LONGEST_SILENT
    assert silent("def f():\n" + body) == ["f"]
    assert silent('def f():\n    """It does."""\n' + body) == []
    assert silent("def f():\n" + body[: -len("    x = 1\n")]) == []


def test_arrays_of_floats_have_one_name():
    """``FloatArray`` of ancf.arrays; kernels have one scalar product, that of ancf.vectors."""
    spelt = [name(p) for p in SOURCES if "NDArray[np.float64]" in p.read_text(encoding="utf-8")]
    assert spelt == ["arrays.py"]
    product = re.compile(r"@\w+\ndef (?:dot|inner|scalar)\w*\(")
    assert [name(p) for p in SOURCES if product.search(p.read_text(encoding="utf-8"))] == ["vectors.py"]
