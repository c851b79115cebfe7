"""The command of docs/howto/write_a_command.md: its module and a function in a copy of the package."""

import json
import re

import numpy as np
import pytest

import ancf
from additions import Addition
from commands import Ran
from places import HOWTO

PAGE = (HOWTO / "write_a_command.md").read_text(encoding="utf-8")
MODULE, APP = "cli/compare.py", "cli/app.py"
#: The page's code stands behind the last command.
LAST = "        validate_case(case, speed, output, report, quiet)\n"
CODE = re.search(r"```\{code-block\} python\n(.*?)```", PAGE, re.S)[1]


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("command")
    return Addition(folder, {"compare.py": MODULE}, {APP: {LAST: "\n\n" + CODE}})


def fallen(step, elements=4, name="pendulum", length=1.0, t_end=0.2):
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=50.0, EI=0.1, rhoA=0.1)
    ends = {"start": (0, 0, 0), "end": (length, 0, 0)}
    rope = model.add_beam(name, **ends, elements=elements, section=section)
    model.pin(rope.start)
    model.connect(rope.end, model.add_point_mass("stone", at=ends["end"], mass=0.02))
    return ancf.simulate(model, t_end=t_end, step=step)


@pytest.fixture(scope="module")
def results(copy):
    """Coarse and fine; another body; other times: as files in the folder of the copy."""
    made = {"coarse": fallen(0.02), "fine": fallen(0.005, elements=6)}
    for name, result in made.items():
        result.save(copy.folder / f"{name}.h5")
    still = ancf.Model()
    still.add_point_mass("someone", at=(0, 0, 0), mass=1.0)
    ancf.simulate(still, t_end=0.02, step=0.02, file=copy.folder / "else.h5")
    fine = made["fine"]
    later = ancf.simulate(fine.model, t_end=0.19, step=0.0201, start=fine.state(3))  # from t = 0.015 s
    later.save(copy.folder / "later.h5")
    return made


#: What does not fit, as the other file, and what is said of it.
REFUSED = {
    "nothing.h5": "nothing.h5",
    "model.toml": "is a model file, not a results file",
    "else.h5": "else.h5: has no body in common with coarse.h5",
    "later.h5": "later.h5: has no time in common with coarse.h5",
    ".": "is a folder",
}
LINES = [
    ["compare", "--help"],
    ["compare", "coarse.h5", "fine.h5"],
    ["compare", "fine.h5", "fine.h5"],
    ["compare", "fine.h5"],
    *(["compare", "coarse.h5", other] for other in REFUSED),
]
TOGETHER = """
import contextlib
import io
import json
import sys
from ancf.cli.app import app

ran = []
for line in json.loads(sys.argv[1]):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            app(line, prog_name="ancf")
        except SystemExit as stop:
            code = int(stop.code or 0)
    ran.append([code, out.getvalue(), err.getvalue()])
print(json.dumps(ran))
"""


@pytest.fixture(scope="module")
def ran(copy, results):
    """What each line leaves: one process runs them all."""
    (copy.folder / "model.toml").write_text("title = 'x'\n", encoding="utf-8")
    done = copy.python("-c", TOGETHER, json.dumps(LINES))
    assert done.code == 0, done.err
    found = [Ran(*left) for left in json.loads(done.out)]
    return {tuple(line): left for line, left in zip(LINES, found, strict=True)}


def test_touches_two_files(copy):
    assert copy.touched() == [APP, MODULE]
    assert "{literalinclude} compare.py" in PAGE
    assert all(f"`{name}`" in PAGE for name in copy.touched())


def test_is_in_the_help(copy, ran):
    whole, own = copy.python("-m", "ancf", "--help"), ran["compare", "--help"]
    assert whole.code == own.code == 0
    assert re.search(r"compare +Say how far the bodies of two results are apart", whole.out)
    assert re.search(r"RESULTS.h5\W+OTHER.h5", own.out)
    assert "Meshes and steps may differ." in " ".join(own.out.split())


def test_says_the_largest_distance(ran, results):
    """At the times of the coarse run, every fourth of the fine one."""
    coarse, fine = results["coarse"], results["fine"]
    places = np.linspace(0.0, 1.0, 9)
    gaps = np.array([distance(coarse, fine, f"pendulum.at({x:.17g})") for x in places])
    place, k = np.unravel_index(np.argmax(gaps), np.shape(gaps))
    told = ran["compare", "coarse.h5", "fine.h5"]
    assert (told.code, told.err) == (0, "")
    head, rope, stone = (re.split(r"\s{2,}", line.strip()) for line in told.out.splitlines())
    assert head == ["body", "distance [m]", "t [s]", "at"]
    assert rope[0] == "pendulum"
    assert float(rope[1]) == pytest.approx(gaps[place][k], rel=1e-2)
    assert float(rope[2]) == pytest.approx(coarse.t[k])
    assert rope[3] == f"pendulum.at({places[place]:g})" or places[place] in (0.0, 1.0)
    assert stone[0] == "stone"
    assert float(stone[1]) == pytest.approx(distance(coarse, fine, "stone").max(), rel=1e-2, abs=1e-14)


def distance(coarse, fine, point):
    return np.linalg.norm(coarse.position(point) - fine.position(point)[::4], axis=1)


def test_prints_what_the_page_shows(ran):
    told = ran["compare", "coarse.h5", "fine.h5"].out
    shown = re.search(r"\$ ancf compare coarse.h5 fine.h5\n(.*?)```", PAGE, re.S)[1]
    for printed, written in zip(told.splitlines(), shown.splitlines(), strict=True):
        for word, wanted in zip(printed.split(), written.split(), strict=True):
            if re.fullmatch(r"[\d.e+-]+", wanted):
                assert float(word) == pytest.approx(float(wanted), rel=0.02)
            else:
                assert word == wanted


def test_a_result_is_where_it_is(ran):
    told = ran["compare", "fine.h5", "fine.h5"]
    assert told.code == 0
    assert [line.split()[1] for line in told.out.splitlines()[1:]] == ["0", "0"]


@pytest.mark.parametrize("other", REFUSED)
def test_refuses_what_does_not_fit(ran, other):
    """One message, exit code 2, no traceback."""
    told = ran["compare", "coarse.h5", other]
    assert told.code == 2
    assert told.out == ""
    assert told.err.startswith("error: ")
    assert REFUSED[other] in told.said
    assert "Traceback" not in told.err


def test_both_files_are_asked_for(ran):
    told = ran["compare", "fine.h5"]
    assert told.code == 2
    assert "OTHER.h5" in told.err
    assert "Traceback" not in told.err
