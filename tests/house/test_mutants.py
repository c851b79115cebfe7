"""The lists of mutants: every folder has some, each can be made, and its tests are there."""

import ast

import pytest

from mutants.listing import PACKAGE, folders, read, without_mutants
from places import TESTS

MUTANTS = read()
#: So many at least, over all folders.
LEAST = 120


def names_in(path):
    """Tests of a file, as pytest writes them: functions, classes, methods."""
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        if isinstance(node, ast.ClassDef):
            found |= {f"{node.name}::{part.name}" for part in node.body if isinstance(part, ast.FunctionDef)}
    return found


def test_every_folder_has_some():
    assert without_mutants() == []
    assert {"model", "system", "viz", "."} <= set(folders())
    assert len(MUTANTS) >= LEAST
    assert sum(mutant.short for mutant in MUTANTS) >= len(folders()) - 2


def test_none_is_listed_twice():
    assert len({(m.file, m.old, m.new) for m in MUTANTS}) == len(MUTANTS)


@pytest.mark.parametrize("folder", folders())
def test_can_be_made(folder):
    """The old text stands once in its file, and what it becomes is Python still."""
    for mutant in (m for m in MUTANTS if m.folder == folder):
        changed = mutant.changed()
        assert changed != (PACKAGE / mutant.file).read_text(encoding="utf-8"), mutant
        ast.parse(changed)


def test_their_tests_are_there():
    known = {}
    for mutant in MUTANTS:
        assert mutant.tests, mutant
        for test in mutant.tests:
            file, _, name = test.partition("::")
            if file not in known:
                known[file] = names_in(TESTS / file)
            assert not name or name.partition("[")[0] in known[file], test
