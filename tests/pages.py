"""The pages of the documentation, and how their tests are dealt out."""

import importlib.util
import sys

import pytest

from places import DOCS, ROOT

PAGES = sorted(p for p in DOCS.rglob("*.md") if "_build" not in p.parts)

WITH_CODE = [
    ROOT / "README.md",
    DOCS / "index.md",
    *sorted((DOCS / "tutorials").glob("*.md")),
    *sorted((DOCS / "howto").glob("*.md")),
]


def script(name):
    """The module docs/NAME.py, which is no part of a package."""
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def code_blocks():
    """What finds and runs the code of a page."""
    return script("code_blocks")


def name_of(page):
    return str(page.relative_to(ROOT))


def alone(page):
    """A page as a parameter with its name, which makes it a unit of its own for the workers (dealing.py)."""
    return pytest.param(page, id=name_of(page))
