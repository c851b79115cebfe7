"""The pages: every code block runs or parses and prints what the page says; every link has a target."""

import contextlib
import importlib.util
import json
import re
import shlex
import tomllib
from decimal import Decimal
from pathlib import Path

import pytest
import typer
from pydantic import ValidationError
from typer.testing import CliRunner

from ancf import catenary
from ancf.cli.app import app
from ancf.design.file import StudyEntry
from ancf.model.file import parameters, parse_study
from ancf.model.file.entries import FileEntry
from ancf.model.functions import inputs
from pages import DOCS, PAGES, ROOT, WITH_CODE, alone, code_blocks, name_of

#: A block that is left out needs a reason, and there may not be many.
MOST_LEFT_OUT = 40
#: Commands of minutes: their arguments are checked, nothing is computed.
LONG = (
    ["reproduce"],
    ["validate"],
    ["catenary", "sweep"],
    ["catenary", "run", "examples/line.toml"],
    ["catenary", "elasticity", "examples/line.toml"],
)
#: Examples of which a page shows no numbers: a hundred steps; test_examples.py runs them whole with --slow.
SHOWN_ELSEWHERE = ("belt", "hoist", "spool", "tackle", "knot")
#: Pages that docs/reference_pages.py makes when the site is built (tests/docs/test_reference.py).
MADE = "reference/"
NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
#: Comment of a tolerance: its size, the numbers that it is for, the reason.
TOLERANCE = re.compile(r"([\d.e+-]+)(?: of ([^:]+))?: (.{8,})")
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
    elif "sampling" in data:
        StudyEntry.model_validate(data)
    elif "title" in data or "file" in block.comments:
        parse_study(data)
    else:
        try:
            first = inputs.first_values(data.get("inputs"))
            with inputs.named(first), parameters.given(data, first):
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
    if arguments[0] == "run" and (example := Path(arguments[1])).stem in SHOWN_ELSEWHERE:
        step = tomllib.loads(example.read_text(encoding="utf-8"))["simulation"]["step"]
        arguments = [*arguments, "--set", f"simulation.t_end={100 * step}"]
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
    """Texts are equal but for spaces, numbers within what the page shows; ``...`` stands for anything."""
    tolerance = tolerance_of(expected)
    rest = tokens(printed)
    parts = [tokens(part) for part in ELLIPSIS.split(expected.text)]
    position = 0
    for k, part in enumerate(parts):
        found = find(rest, part, position, tolerance, anywhere=k > 0)
        assert found is not None, f"{expected.place} does not show what is printed:\n{printed}"
        position = found + len(part)
    complete = position == len(rest) or not parts[-1]
    assert complete, f"{expected.place}: more is printed:\n{printed}"


def tolerance_of(block):
    """Relative tolerance of the numbers of a block that its comment names, or of all of them.

    Returns
    -------
    dict of str to float
        By number as the page shows it, None for all others; empty: the digits that are shown count.
    """
    if "tolerance" not in block.comments:
        return {}
    found = TOLERANCE.fullmatch(block.comments["tolerance"])
    assert found, f'{block.place}: write "0.5 of 9e-06, 3e-07: reason" or "0.5: reason"'
    named = [name.strip() for name in (found[2] or "").split(",") if name.strip()]
    missing = [name for name in named if name not in tokens(block.text)]
    assert not missing, f"{block.place}: does not show {missing}"
    return dict.fromkeys(named or [None], float(found[1]))


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
    """Equal texts; a count is the same, any other number agrees to one unit of its last digit on the page."""
    if not NUMBER.fullmatch(wanted) or not NUMBER.fullmatch(found):
        return wanted == found
    relative = tolerance.get(wanted, tolerance.get(None))
    if relative is not None:
        return float(found) == pytest.approx(float(wanted), rel=relative, abs=1e-12)
    unit = 0.0 if re.fullmatch(r"[-+]?\d+", wanted) else 10.0 ** Decimal(wanted).as_tuple().exponent
    return abs(float(found) - float(wanted)) <= 1.0001 * unit


@pytest.mark.parametrize(
    ("wanted", "found", "agree"),
    [
        ("0.4312", "0.4313", True),
        ("0.4312", "0.4314", False),
        ("0.4312", "0.43", False),
        ("-1.50", "-1.51", True),
        ("1.2e-05", "1.3e-05", True),
        ("1.2e-05", "1.4e-05", False),
        ("120", "121", False),
        ("120", "120", True),
        ("N", "N", True),
        ("N", "1", False),
    ],
)
def test_numbers_agree_to_the_digits_that_are_shown(wanted, found, agree):
    assert same(wanted, found, {}) is agree


@pytest.mark.parametrize(
    ("comment", "agree"), [("0.5 of 2e-06: round-off", True), ("0.5 of 7: round-off", False)]
)
def test_a_tolerance_is_of_the_numbers_that_it_names(comment, agree):
    block = code.Block(Path("page.md"), 1, "text", "2e-06 and 7\n", {"tolerance": comment})
    tolerance = tolerance_of(block)
    assert same("2e-06", "2.9e-06", tolerance) is True  # one unit of the last digit
    assert same("2e-06", "1.1e-06", tolerance) is True
    assert same("7", "8", tolerance) is not agree


@pytest.mark.parametrize("comment", ["0.5", "0.5 of 3: round-off", "much: round-off", "0.5 of 7:"])
def test_a_tolerance_without_its_reason_is_refused(comment):
    block = code.Block(Path("page.md"), 1, "text", "2e-06 and 7\n", {"tolerance": comment})
    with pytest.raises(AssertionError, match=r"page\.md"):
        tolerance_of(block)


def test_every_tolerance_has_its_reason():
    for page in WITH_CODE:
        for block in code.blocks(page):
            if block.output is not None:
                tolerance_of(block.output)


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
                entries = [entry for entry in entries if not entry.startswith(MADE)]
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
