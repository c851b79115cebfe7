"""The joint of docs/howto/write_a_joint.md: two files and a line in a copy of the package."""

import math

import pytest

from additions import Addition
from places import HOWTO

#: What the page adds: files, and lines behind a line of the registry.
FILES = {"rod.py": "model/joints/rod.py", "rod_rows.py": "connections/rod.py"}
REGISTRY = "model/kinds.py"
LINES = {
    "from .joints.rigid_joints import GUIDE, UNIVERSAL, WELD\n": "from .joints.rod import ROD\n",
    "CONNECTIONS: list[Kind] = [\n": "    ROD,\n",
}

SCRIPT = """
import json
import numpy as np
import ancf
from ancf.model.file import parse_study, schema
from shown import shown

def model():
    made = ancf.Model(gravity=(0, 0, -9.81), title="pendulum")
    one = made.add_point_mass("one", at=(1, 0, 0), mass=1.0)
    two = made.add_point_mass("two", at=(1.8, 0.6, 0), mass=2.0)
    made.rod(one, (0, 0, 0), name="upper")
    made.rod(two, one, name="lower")
    return made

made = model()
found = shown(made, ".", t_end=0.05, step=1e-3, sensors=["upper"])
found["dir"] = "rod" in dir(made)
study = {"bodies": [
    {"type": "point_mass", "name": n, "at": [x, 0.0, 0.0], "mass": 1.0}
    for n, x in (("one", 1.0), ("two", 3.0))],
    "connections": [{"type": "rod", "a": "one", "b": [0, 0, 0]}, {"type": "rod", "a": "two", "b": "one"}]}
found["file"] = [type(c).__name__ for c in parse_study(study).model.connections]
study["connections"][0]["b"] = [1.0, 0.0, 0.0]
try:
    parse_study(study)
except ancf.ModelError as error:
    found["refused"] = str(error)
try:
    double = model()
    double.rod("one", "two")
except ancf.ModelError as error:
    found["repeated"] = str(error)
found["schema"] = "RodEntry" in schema()["$defs"]
run = ancf.load("run.h5")
found["multiplier"] = run.multiplier("upper").shape
found["lengths"] = [float(np.abs(np.linalg.norm(x, axis=1) - 1.0).max())
                    for x in (run.position("one"), run.position("two") - run.position("one"))]
state = ancf.Model(gravity=(0, 0, -9.81))
bob = state.add_point_mass("bob", at=(0, 0, -2), mass=3.0)
rod = state.rod(bob, (0, 0, 0))
found["pull"] = float(2 * 2.0 * ancf.equilibrium(state).multiplier(rod)[0])
found["hertz"] = float(ancf.modes(state, about=ancf.equilibrium(state), count=1).frequencies_hz[0])
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package with the joint of the page."""
    return Addition(tmp_path_factory.mktemp("joint"), FILES, {REGISTRY: LINES})


@pytest.fixture(scope="module")
def added(copy):
    """What a script finds there."""
    return copy.found(SCRIPT)


def test_touches_three_files(copy):
    assert copy.touched() == sorted([*FILES.values(), REGISTRY])


def test_page_shows_the_files_and_the_lines():
    page = (HOWTO / "write_a_joint.md").read_text(encoding="utf-8")
    assert all(f"{{literalinclude}} {name}" in page for name in FILES)
    assert all(f"`{place}`" in page for place in (*FILES.values(), REGISTRY))
    assert all(line.strip() in page for line in LINES.values())


def test_is_a_method_of_a_model_and_is_printed(added):
    assert added["dir"]
    assert "length 1 m" in added["printed"][0]


def test_is_read_from_files_and_refused_there(added):
    assert added["file"] == ["Rod", "Rod"]
    assert added["refused"].startswith("connections[0].b: coincides with a: a rod needs a length")
    assert added["repeated"].endswith('"lower" connects two and one already') or added["repeated"].endswith(
        '"lower" connects one and two already'
    )
    assert added["schema"]


def test_keeps_its_length_and_carries_the_weight(added):
    """The lengths stay; at rest it pulls with the weight, and the pendulum has its frequency."""
    assert max(added["lengths"]) < 1e-12
    assert added["multiplier"] == [51, 1]
    assert abs(added["pull"]) == pytest.approx(3.0 * 9.81)
    assert added["hertz"] == pytest.approx(math.sqrt(9.81 / 2.0) / (2 * math.pi), rel=1e-9)


def test_is_drawn_exported_and_sampled(added):
    """In the plot, the page, the file of ParaView and the tables."""
    assert "rod" in added["legend"]
    assert added["markers"]["upper"] == "rod"
    assert ["upper", "rod"] in added["parts"]
    assert added["sensors"] == ["upper"]
    assert any(name.startswith("upper") for name in added["columns"])
