"""What pages call by a whole name in a line, ``ancf.catenary.run(...)``, is there after ``import ancf``."""

import re
import subprocess
import sys

import pytest

from places import DOCS

CALL = re.compile(r"(?<!`)`(?!`)[^`\n]*?\b(ancf(?:\.[A-Za-z_]\w*)+)\(")
PAGES = [DOCS.parent / "README.md", *sorted(DOCS.rglob("*.md"))]
DEEP = sorted(
    {name for page in PAGES for name in CALL.findall(page.read_text("utf-8")) if name.count(".") > 1}
)


def test_there_are_such_names():
    assert "ancf.catenary.read_line" in DEEP


@pytest.mark.parametrize("name", DEEP)
def test_is_there(name):
    done = subprocess.run([sys.executable, "-c", f"import ancf; {name}"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr.splitlines()[-1]
