"""The joint of docs/howto/write_a_joint.md: two files and a line in a copy of the package."""

import pytest

from additions import Addition
from places import HOWTO

#: What the page adds: files, and lines behind a line of the registry.
FILES = {"universal.py": "model/universal.py", "universal_rows.py": "connections/universal.py"}
REGISTRY = "model/kinds.py"
LINES = {
    "from .supports import Clamp, Hold, Pin\n": "from .universal import UNIVERSAL\n",
    "CONNECTIONS: list[Kind] = [\n": "    UNIVERSAL,\n",
}

SCRIPT = """
import json
import numpy as np
import ancf
from ancf.model.file import parse_study, schema
from shown import shown

def model():
    made = ancf.Model(title="shafts")
    one = made.add_rigid_body("one", at=(0.5, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.2))
    two = made.add_rigid_body("two", at=(1.5, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.2))
    made.hinge(one.at(-0.5, 0, 0), (0, 0, 0), axis=(1, 0, 0))
    made.universal(one.at(0.5, 0, 0), two.at(-0.5, 0, 0), axis_a=(0, 1, 0), axis_b=(0, 0, 1), name="cross")
    one.set_motion(angular_velocity=(2, 0, 0))
    two.set_motion(angular_velocity=(2, 0.5, 0.3), about=(1, 0, 0))
    return made

made = model()
found = shown(made, ".", t_end=0.05, step=1e-3, sensors=["cross"])
found["dir"] = "universal" in dir(made)
study = {"bodies": [
    {"type": "rigid_body", "name": n, "at": [x, 0.0, 0.0], "mass": 1.0, "inertia": [0.1, 0.2, 0.2]}
    for n, x in (("one", 0.5), ("two", 1.5))], "connections": [
    {"type": "universal", "a": "one.at(0.5, 0, 0)", "b": "two.at(-0.5, 0, 0)",
     "axis_a": [0.0, 1.0, 0.0], "axis_b": [0.0, 0.0, 1.0]}]}
found["file"] = [type(c).__name__ for c in parse_study(study).model.connections]
study["connections"][0]["axis_b"] = [0.0, 1.0, 0.0]
try:
    parse_study(study)
except ancf.ModelError as error:
    found["refused"] = str(error)
try:
    double = model()
    double.universal("one.at(0.5, 0, 0)", "two.at(-0.5, 0, 0)", axis_a=(0, 1, 0), axis_b=(0, 0, 1))
except ancf.ModelError as error:
    found["repeated"] = str(error)
found["schema"] = "UniversalEntry" in schema()["$defs"]
run = ancf.load("run.h5")
found["multiplier"] = run.multiplier("cross").shape
gap = run.position("one.at(0.5, 0, 0)") - run.position("two.at(-0.5, 0, 0)")
axes = [run.section_rotation(name) for name in ("one", "two")]
found["gap"] = float(np.abs(gap).max())
found["cross"] = float(np.abs(np.sum(axes[0][:, :, 1] * axes[1][:, :, 2], axis=1)).max())
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
    assert "universal joint" in added["printed"][0]
    assert "axes (0, 1, 0), (0, 0, 1)" in added["printed"][0]


def test_is_read_from_files_and_refused_there(added):
    assert added["file"] == ["Universal"]
    assert added["refused"].startswith("connections[0].axis_b: must be normal to axis_a")
    assert added["repeated"].endswith('"cross" connects one.at(0.5, 0, 0) and two.at(-0.5, 0, 0) already')
    assert added["schema"]


def test_moves_as_a_cross(added):
    """The points coincide, the axes stay normal; a loaded file has the four multipliers."""
    assert added["gap"] < 1e-12
    assert added["cross"] < 1e-10
    assert added["multiplier"] == [51, 4]


def test_is_drawn_exported_and_sampled(added):
    """In the plot, the page, the file of ParaView and the tables."""
    assert "universal" in added["legend"]
    assert added["markers"]["cross"] == "universal"
    assert ["cross", "universal"] in added["parts"]
    assert added["sensors"] == ["cross"]
    assert any(name.startswith("cross") for name in added["columns"])
