"""The reference page names all that the package offers."""

import re
from importlib import import_module

import pytest

from places import DOCS

PAGE = DOCS / "reference.md"
DIRECTIVE = re.compile(r"^\.\. auto(?:class|function|method|data)::\s+(\S+)", re.MULTILINE)


@pytest.fixture(scope="module")
def documented():
    return DIRECTIVE.findall(PAGE.read_text(encoding="utf-8"))


@pytest.mark.parametrize("module", ["ancf", "ancf.catenary", "ancf.paper", "ancf.results"])
def test_every_public_name_is_there(module, documented):
    names = set(import_module(module).__all__) - {"__version__", "FIGURES"}
    told = {name.rpartition(".")[2] for name in documented}
    assert sorted(names - told) == []


def test_every_name_there_exists_and_stands_once(documented):
    assert len(set(documented)) == len(documented)
    for name in documented:
        module, _, last = name.rpartition(".")
        assert hasattr(import_module(module), last), name
