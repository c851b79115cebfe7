"""The pages: every code block runs or parses and prints what the page says; every link has a target."""

import contextlib
import importlib.util
import json
import re
import shlex
import tomllib
from pathlib import Path

import pytest
import typer
from pydantic import ValidationError
from typer.testing import CliRunner

from ancf import catenary
from ancf.cli.app import app
from ancf.model.file import parse_study
from ancf.model.file.entries import FileEntry
from pages import DOCS, PAGES, ROOT, WITH_CODE, alone, code_blocks, name_of

#: A block that is left out needs a reason, and there may not be many.
MOST_LEFT_OUT = 40
#: Commands of minutes: their arguments are checked, nothing is computed.
LONG = (
    ["reproduce"],
    ["validate"],
    ["catenary", "run", "examples/line.toml"],
    ["catenary", "elasticity", "examples/line.toml"],
)
NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
ELLIPSIS = re.compile(r"(?<![\[(])\.\.\.")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


code = code_blocks()


# --- code


@pytest.mark.filterwarnings("default::UserWarning")  # a page may show one
@pytest.mark.parametrize("page", [alone(page) for page in WITH_CODE])
def test_code_runs_and_prints_what_the_page_says(page, tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    code.link_examples(tmp_path)
    namespace = {"__name__": "__main__"}
    for block in code.blocks(page):
        with named(block):
            code.save(block)
            if "not run" in block.comments:
                assert len(block.comments["not run"]) > 5, "give the reason"
                continue
            printed = KINDS.get(block.language, ignored)(block, namespace)
            if block.output is not None:
                compare(printed, block.output)


@contextlib.contextmanager
def named(block):
    """An error in a block names the page and the line where the block starts."""
    try:
        yield
    except BaseException as error:
        error.add_note(f"in the {block.language} block of {block.place}")
        raise


def ignored(block, namespace):
    return ""


def check_json(block, namespace):
    json.loads(block.text)
    return ""


def check_toml(block, namespace):
    """A whole model is read; of a part of one every key and value is checked."""
    data = tomllib.loads(block.text)
    if "contact_wire" in data:
        Path("line to check.toml").write_text(block.text, encoding="utf-8")
        catenary.read_line("line to check.toml")
    elif "title" in data or "file" in block.comments:
        parse_study(data)
    else:
        try:
            FileEntry.model_validate(data)
        except ValidationError as error:
            wrong = [problem for problem in error.errors() if problem["type"] != "missing"]
            assert not wrong, wrong
    return ""


def run_console(block, namespace):
    """What the last command prints; lines without ``$`` are output when another line has one."""
    lines = block.text.splitlines()
    if any(line.startswith("$ ") for line in lines):
        lines = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    printed = ""
    for line in lines:
        for command in shlex.split(line, comments=True) and line.split("#")[0].split("&&"):
            printed = run_command(shlex.split(command))
    return printed


def run_command(words):
    kind, *arguments = words
    if kind == "ancf":
        return run_ancf(arguments)
    if kind == "pip":
        check_install(arguments)
    elif kind == "python" and arguments[0].endswith(".py"):
        assert (ROOT / arguments[0]).exists() or Path(arguments[0]).exists(), arguments[0]
    elif words[:2] == ["python", "-m"]:
        assert importlib.util.find_spec(arguments[1]) is not None, arguments[1]
    else:
        assert kind in ("pytest", "git", "cd", "ruff", "mypy"), f"what does the test make of {kind}?"
    return ""


def run_ancf(arguments):
    if any(arguments[: len(start)] == start for start in LONG):
        parse(arguments)
        return ""
    done = CliRunner().invoke(app, arguments, env={"NO_COLOR": "1"})
    assert done.exit_code == 0, f"ancf {shlex.join(arguments)}: {done.output}"
    return done.stdout


def parse(arguments):
    """Check the arguments of a command as the command line does."""
    command, words = typer.main.get_command(app), list(arguments)
    while hasattr(command, "commands"):
        command = command.commands[words.pop(0)]
    command.make_context(command.name, words)


def check_install(arguments):
    known = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert arguments[0] == "install"
    for extras in re.findall(r"\[([\w,]+)\]", " ".join(arguments)):
        assert set(extras.split(",")) <= known["optional-dependencies"].keys()


KINDS = {
    "python": code.run_python,
    "json": check_json,
    "toml": check_toml,
    "console": run_console,
}


# --- output


def compare(printed, expected):
    """Texts are equal but for spaces, and for numbers within the tolerance; ``...`` stands for anything."""
    tolerance = float(expected.comments.get("tolerance", "1e-3"))
    rest = tokens(printed)
    parts = [tokens(part) for part in ELLIPSIS.split(expected.text)]
    position = 0
    for k, part in enumerate(parts):
        found = find(rest, part, position, tolerance, anywhere=k > 0)
        assert found is not None, f"{expected.place} does not show what is printed:\n{printed}"
        position = found + len(part)
    complete = position == len(rest) or not parts[-1]
    assert complete, f"{expected.place}: more is printed:\n{printed}"


def tokens(text):
    return [part for word in text.split() for part in NUMBER.split(word) if part]


def find(whole, part, start, tolerance, anywhere):
    last = len(whole) - len(part) if anywhere else start
    for k in range(start, last + 1):
        pairs = zip(part, whole[k : k + len(part)], strict=False)
        if len(whole) - k >= len(part) and all(same(a, b, tolerance) for a, b in pairs):
            return k
    return None


def same(wanted, found, tolerance):
    if not NUMBER.fullmatch(wanted) or not NUMBER.fullmatch(found):
        return wanted == found
    return float(found) == pytest.approx(float(wanted), rel=tolerance, abs=1e-12)


# --- pages


def test_few_blocks_are_left_out():
    reasons = [b.place for page in WITH_CODE for b in code.blocks(page) if "not run" in b.comments]
    assert len(reasons) <= MOST_LEFT_OUT, reasons


@pytest.mark.parametrize("page", [*PAGES, ROOT / "README.md"], ids=name_of)
def test_links_have_targets(page):
    text = prose(page)
    for target in LINK.findall(text):
        if target.startswith(("http://", "https://", "mailto:")):
            continue
        path, _, anchor = target.partition("#")
        goal = (page.parent / path).resolve() if path else page
        assert goal.exists(), f"{name_of(page)}: {target} does not exist"
        if anchor and goal.suffix == ".md":
            assert anchor in anchors(goal), f"{name_of(page)}: {target} has no such heading"


@pytest.mark.parametrize("page", [*PAGES, ROOT / "README.md"], ids=name_of)
def test_nothing_is_left_to_do(page):
    assert not re.search(r"\b(TODO|FIXME|XXX|TBD)\b", page.read_text(encoding="utf-8"))


def test_every_page_is_in_the_contents():
    listed = set()
    for page in PAGES:
        for block in code.blocks(page):
            if block.language == "{toctree}":
                entries = [line for line in block.text.splitlines() if line and line[0] != ":"]
                listed |= {(page.parent / f"{entry}.md").resolve() for entry in entries}
    missing = {page.resolve() for page in PAGES} - listed - {(DOCS / "index.md").resolve()}
    assert not missing
    assert all(page.exists() for page in listed)


def test_pictures_are_used():
    text = "".join(page.read_text(encoding="utf-8") for page in [*PAGES, ROOT / "README.md"])
    kinds = (".png", ".svg", ".gif")
    unused = [p.name for p in (DOCS / "_static").rglob("*") if p.suffix in kinds and p.name not in text]
    assert not unused


def prose(page):
    """A page without its code."""
    text = re.sub(r"^(`{3,}).*?^\1", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(page):
    """Anchors that the headings of a page get."""
    heads = re.findall(r"^#+ (.*)$", prose_with_ticks(page), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def prose_with_ticks(page):
    text = page.read_text(encoding="utf-8")
    return re.sub(r"^(`{3,}).*?^\1", "", text, flags=re.DOTALL | re.MULTILINE)
