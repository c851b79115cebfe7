"""The suite itself: patient on a busy machine, dealt out to workers page by page, helpers written once."""

import ast
import os
from collections import defaultdict
from functools import cache
from types import SimpleNamespace

import pytest

import dealing
from pages import WITH_CODE, alone
from places import TESTS

FILES = sorted(TESTS.rglob("*.py"))
FIVE_MINUTES = 300
#: Shorter helpers may look the same by chance.
FEW_LINES = 3


@cache
def trees():
    return [(path, ast.parse(path.read_text(encoding="utf-8"))) for path in FILES]


def test_no_timeout_is_shorter_than_five_minutes():
    """What takes a second alone takes minutes beside eight busy processes."""
    for path, node in ((path, node) for path, tree in trees() for node in ast.walk(tree)):
        if isinstance(node, ast.keyword) and node.arg == "timeout" and isinstance(node.value, ast.Constant):
            # a browser counts in milliseconds
            assert node.value.value >= FIVE_MINUTES, f"{path.name}, line {node.value.lineno}"
        if (
            isinstance(node, ast.BinOp)
            and isinstance(node.op, ast.Add)
            and "monotonic()" in ast.unparse(node)
        ):
            least = node.right.value if isinstance(node.right, ast.Constant) else FIVE_MINUTES
            assert least >= FIVE_MINUTES, f"{path.name}, line {node.lineno}"


@pytest.mark.parametrize("tried", [1, 2, 3, 7])
def test_some_cases_of_long_families_are_tried(monkeypatch, tried):
    monkeypatch.setattr(dealing, "families", lambda: {"tests/test_it.py::test_a": tried})
    before = set()
    for count in range(1, 40):
        names = [f"test_a[{k}-{k % 2}]" for k in range(count)]
        cases = [SimpleNamespace(name=name, nodeid=f"tests/test_it.py::{name}") for name in names]
        others = [
            SimpleNamespace(name=name, nodeid=f"tests/test_it.py::{name}") for name in ("test_b[1]", "c")
        ]
        left_out = [case.name for case in dealing.other_cases([*cases, *others])]
        now = set(names) - set(left_out)
        assert len(now) == min(tried, count)
        assert len(left_out) == count - len(now)
        # another case takes the place of one at most
        assert len(before - now) <= 1
        before = now


def test_families_of_which_some_cases_are_tried_are_there():
    functions = defaultdict(set)
    for path, tree in trees():
        for node in tree.body:
            inner = node.body if isinstance(node, ast.ClassDef) else [node]
            prefix = f"{node.name}::" if isinstance(node, ast.ClassDef) else ""
            found = {prefix + one.name for one in inner if isinstance(one, ast.FunctionDef)}
            functions[f"tests/{path.relative_to(TESTS).as_posix()}"] |= found
    known = {f"{file}::{name}" for file, names in functions.items() for name in names}
    assert set(dealing.families()) <= known
    assert list(dealing.families()) == sorted(dealing.families())
    assert min(dealing.families().values()) >= 1


def test_no_two_files_of_tests_have_one_name():
    """They are modules by their name alone, of which each worker imports one."""
    names = defaultdict(list)
    for path in FILES:
        if path.name.startswith("test_"):
            names[path.name].append(str(path.relative_to(TESTS)))
    assert not [paths for paths in names.values() if len(paths) > 1]


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


def test_pages_are_units_of_their_own():
    units = {dealing.unit_of(f"tests/docs/test_docs.py::test_code[{alone(page).id}]") for page in WITH_CODE}
    assert len(units) == len(WITH_CODE)
    assert dealing.unit_of("tests/a/test_b.py::TestC::test_d[1.0-x]") == "tests/a/test_b.py"
    assert dealing.unit_of("tests/a/test_b.py::test_d") == "tests/a/test_b.py"


@pytest.mark.parametrize("number", range(20))
def test_the_tests_of_a_file_share_a_worker(number, tmp_path_factory):
    """Whatever versions of pytest and its plugin are installed: else each worker makes each fixture."""
    worker_id = os.environ.get("PYTEST_XDIST_WORKER", "none")
    base = tmp_path_factory.getbasetemp()
    seen = (base if worker_id == "none" else base.parent) / "workers_of_this_file.txt"
    with seen.open("a", encoding="utf-8") as file:
        file.write(f"{worker_id}\n")
    assert set(seen.read_text(encoding="utf-8").split()) == {worker_id}
