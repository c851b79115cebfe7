"""Code blocks of the pages: find them, run the Python ones of a page in order.

A comment in the line above a block says what a reader need not see:

``<!-- not run: reason -->`` or ``% not run: reason``
    It is a fragment.
``% file: name.toml``
    The block is saved under this name before the next one runs.
``% short: (1, 2, 3) -> (1,)``
    What the tests run instead, where the block takes minutes.
``% tolerance: 0.5 of 9e-06, 3e-07: reason``
    Relative tolerance of these numbers in a block of output, or of all without ``of``, and why they are not
    the same everywhere. Without it counts are the same, and other numbers agree to one unit of the last digit
    that the page shows.

A ``text`` block right behind a ``python`` or ``console`` block is what that one prints. What stands
between ``<!-- python`` and ``-->`` runs like a block and is not shown: what a fragment needs.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

COMMENT = re.compile(r"^(?:%|<!--)\s*(not run|short|file|tolerance):\s*(.*?)\s*(?:-->)?$")
HIDDEN = "<!-- python"
FENCE = re.compile(r"^(`{3,})\s*(\{[\w-]+\}|[\w-]*)\s*(.*)$")


@dataclass
class Block:
    """A fenced block; `line` is that of its first line of content, `output` what it should print."""

    page: Path
    line: int
    language: str
    text: str
    comments: dict[str, str] = field(default_factory=dict)
    output: Block | None = None
    adjacent: bool = False  # nothing but blank lines and comments since the last block

    @property
    def place(self) -> str:
        return f"{self.page.name}, line {self.line}"


def blocks(page: Path) -> list[Block]:
    """All fenced blocks of a page, in order."""
    found: list[Block] = []
    for block in _fenced(page):
        if block.language == "text" and found and block.adjacent and found[-1].output is None:
            found[-1].output = block
        else:
            found.append(block)
    return found


def run_python(block: Block, namespace: dict[str, Any]) -> str:
    """Run a block and return what it prints; tracebacks name the page and its line."""
    text = block.text
    if "short" in block.comments:
        long, short = block.comments["short"].split(" -> ")
        assert text.count(long) == 1, f"{block.place}: {long} is not there once"
        text = text.replace(long, short)
    code = compile("\n" * (block.line - 1) + text, str(block.page), "exec")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, namespace)
    return printed.getvalue()


def run_page(page: Path, folder: Path) -> dict[str, Any]:
    """Run the Python blocks of a page up to its figure, in a folder; return the names that they define."""
    namespace: dict[str, Any] = {"__name__": "__main__"}
    with contextlib.chdir(folder):
        for block in blocks(page):
            if block.language == "{figure}":
                break
            save(block)
            if block.language == "python" and "not run" not in block.comments:
                run_python(block, namespace)
    return namespace


def save(block: Block) -> None:
    """Write a block that has a file name into the current folder."""
    if name := block.comments.get("file"):
        Path(name).write_text(block.text, encoding="utf-8")


def link_examples(folder: Path) -> None:
    """Make ``examples/`` of the sources available in a folder."""
    os.symlink(Path(__file__).resolve().parent.parent / "examples", folder / "examples")


def _fenced(page: Path) -> Iterator[Block]:
    lines = page.read_text(encoding="utf-8").splitlines()
    comments: dict[str, str] = {}
    adjacent, i = False, 0
    while i < len(lines):
        if lines[i] == HIDDEN:
            end = lines.index("-->", i)
            yield Block(page, i + 2, "python", "\n".join(lines[i + 1 : end]) + "\n")
            i = end
        elif found := COMMENT.match(lines[i]):
            comments[found[1]] = found[2]
        elif fence := FENCE.match(lines[i]):
            end = next(k for k in range(i + 1, len(lines)) if lines[k].startswith(fence[1]))
            text = "\n".join(lines[i + 1 : end]) + "\n"
            yield Block(page, i + 2, fence[2], text, comments, None, adjacent)
            comments, adjacent, i = {}, True, end
        elif lines[i].strip():
            comments, adjacent = {}, False
        i += 1
