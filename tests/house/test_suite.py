"""The suite itself: patient on a busy machine, dealt out to workers page by page, helpers written once."""

import ast
import tomllib
from collections import defaultdict
from pathlib import Path

import pytest

from pages import WITH_CODE, alone
from places import ROOT, TESTS

FILES = sorted(TESTS.rglob("*.py"))
FIVE_MINUTES = 300
#: Shorter helpers may look the same by chance.
FEW_LINES = 3


def trees():
    return ((path, ast.parse(path.read_text(encoding="utf-8"))) for path in FILES)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(TESTS)))
def test_no_timeout_is_shorter_than_five_minutes(path):
    """What takes a second alone takes minutes beside eight busy processes."""
    text = path.read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.keyword) and node.arg == "timeout" and isinstance(node.value, ast.Constant):
            # a browser counts in milliseconds
            assert node.value.value >= FIVE_MINUTES, f"{path.name}, line {node.value.lineno}"
        if (
            isinstance(node, ast.BinOp)
            and isinstance(node.op, ast.Add)
            and "monotonic()" in ast.unparse(node)
        ):
            assert not isinstance(node.right, ast.Constant) or node.right.value >= FIVE_MINUTES, node.lineno


def test_helpers_are_written_once():
    found = defaultdict(list)
    for path, tree in trees():
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef) or node.name.startswith("test_"):
                continue
            body = [part for part in node.body if not ast.unparse(part).startswith(("'", '"'))]
            if node.end_lineno - node.lineno >= FEW_LINES and len(body) > 1:
                text = ast.unparse(node.args) + "".join(map(ast.unparse, body))
                found[text].append(f"{path.name}: {node.name}")
    assert [names for names in found.values() if len(names) > 1] == []


def test_workers_get_the_pages_one_by_one():
    marks = [alone(page).marks[0] for page in WITH_CODE]
    assert len({mark.args[0] for mark in marks}) == len(WITH_CODE)
    options = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["pytest"]
    assert "--dist loadgroup" in options["ini_options"]["addopts"]


def test_other_tests_of_a_file_stay_together(request):
    assert request.node.get_closest_marker("xdist_group").args == (Path(__file__).name,)
