"""The joint of docs/howto/write_a_joint.md: two files and a line in a copy of the package."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ancf
from places import HOWTO

#: What the page adds: files, and lines behind a line of the registry.
FILES = {"universal.py": "model/universal.py", "universal_rows.py": "connections/universal.py"}
REGISTRY = "model/kinds.py"
LINES = {
    "from .supports import Clamp, Hold, Pin\n": "from .universal import UNIVERSAL\n",
    "CONNECTIONS: list[Kind] = [\n": "    UNIVERSAL,\n",
}

SCRIPT = """
import json, sys
from pathlib import Path
import numpy as np
import ancf
from ancf.model.file import parse_study, schema

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
found = {"printed": str(made), "dir": "universal" in dir(made)}
plain = made.to_dict()
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
folder = Path(sys.argv[1])
ancf.simulate(made, t_end=0.05, step=1e-3, file=folder / "run.h5")
run = ancf.load(folder / "run.h5")
found["multiplier"] = run.multiplier("cross").shape
gap = run.position("one.at(0.5, 0, 0)") - run.position("two.at(-0.5, 0, 0)")
axes = [run.section_rotation(name) for name in ("one", "two")]
found["gap"] = float(np.abs(gap).max())
found["cross"] = float(np.abs(np.sum(axes[0][:, :, 1] * axes[1][:, :, 2], axis=1)).max())
import matplotlib
matplotlib.use("Agg")
run.plot("cross")
found["legend"] = [t.get_text() for t in run.plot_shape().figure.legends[0].get_texts()]
from ancf.viz.scene import make_scene
found["scene"] = sorted({m.kind for m in make_scene(run).markers})
from ancf.viz.export.parts import part_kinds
found["parts"] = "universal" in part_kinds()
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def added(tmp_path_factory):
    """A copy of the package with the joint of the page, and what a script finds there."""
    folder = tmp_path_factory.mktemp("joint")
    root = folder / "src" / "ancf"
    shutil.copytree(Path(ancf.__file__).parent, root, ignore=shutil.ignore_patterns("__pycache__"))
    for name, place in FILES.items():
        shutil.copy(HOWTO / name, root / place)
    text = (root / REGISTRY).read_text(encoding="utf-8")
    for behind, line in LINES.items():
        assert text.count(behind) == 1
        text = text.replace(behind, behind + line)
    (root / REGISTRY).write_text(text, encoding="utf-8")
    env = {**os.environ, "PYTHONPATH": str(folder / "src"), "NUMBA_CACHE_DIR": str(folder / "cache")}
    command = [sys.executable, "-c", SCRIPT, str(folder)]
    ran = subprocess.run(command, env=env, capture_output=True, text=True, timeout=600, check=False)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout.splitlines()[-1])


def test_page_shows_the_files_and_the_lines():
    page = (HOWTO / "write_a_joint.md").read_text(encoding="utf-8")
    assert all(f"{{literalinclude}} {name}" in page for name in FILES)
    assert all(f"`{place}`" in page for place in (*FILES.values(), REGISTRY))
    assert all(line.strip() in page for line in LINES.values())


def test_is_a_method_of_a_model_and_is_printed(added):
    assert added["dir"]
    assert "universal joint" in added["printed"]
    assert "axes (0, 1, 0), (0, 0, 1)" in added["printed"]


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


def test_is_drawn_and_exported(added):
    assert "universal" in added["legend"]
    assert "universal" in added["scene"]
    assert added["parts"]
