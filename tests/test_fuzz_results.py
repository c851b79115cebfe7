"""Results files that something has happened to: each can be looked at, or is refused with a message.

Data sets and attributes changed through HDF5; and bytes cut off or overwritten, which is looked at by a
process of its own because a torn file may bring the library itself down.
"""

import json
import shutil
import subprocess
import sys

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ancf
from ancf.cli.info_result import show_result
from ancf.cli.results_file import open_result, reading
from fuzzing import TOTAL, cases, finite, odd, refused_or_fine


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A results file of a cable, a mass and a spring, with sensors."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Swing")
    rope = ancf.Section(EA=1e3, EI=0.1, rhoA=0.2)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=rope)
    model.pin(cable.start)
    mass = model.add_point_mass("mass", at=(1, 0, -1), mass=0.3)
    spring = model.add_spring(cable.end, mass, stiffness=50.0, name="spring")
    path = tmp_path_factory.mktemp("sound") / "results.h5"
    ancf.simulate(model, t_end=0.02, step=2e-3, sensors=[mass, spring, "cable.at(0.3)"], file=path)
    return path


def look_at(path):
    """What the commands ask of a file."""
    show_result(path)
    with reading(path):
        result = open_result(path)
        print(result, repr(result))
        n = len(result.t)
        for name, body in result.bodies.items():
            point = name if not hasattr(body, "elements") else f"{name}.end"
            places = result.position(point)
            assert places.shape == (n, 3)
            if hasattr(body, "elements"):
                assert result.tension(point).shape == (n,)
        for name in result.springs:
            assert result.spring_force(name).shape == (n,)
        if result.provenance["settings"].get("energy", True):
            assert result.energy.kinetic.shape == (n,)
        assert result.sensors.t.ndim == 1


def members(path):
    found = []
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.append((name, isinstance(item, h5py.Dataset))))
        attributes = [(at, key) for at in ["/", *(name for name, _ in found)] for key in file[at].attrs]
    return found, attributes


def test_the_sound_one_is_sound(sound):
    look_at(sound)
    finite(open_result(sound).position("cable.end"))


def _spoil(file, data, found, attributes):
    """One change of an open file."""
    what = data.draw(
        st.sampled_from(["delete", "values", "shape", "kind", "attribute", "no attribute", "header"])
    )
    if what in ("attribute", "no attribute"):
        at, key = data.draw(st.sampled_from(attributes))
        if at not in file or key not in file[at].attrs:
            return
        del file[at].attrs[key]
        if what == "attribute":
            value = data.draw(odd)
            try:
                file[at].attrs[key] = value
            except (TypeError, ValueError, OverflowError):  # HDF5 has no such thing
                file[at].attrs[key] = "?"
        return
    if what == "header":
        header = json.loads(file.attrs["header"])
        key = data.draw(st.sampled_from(sorted(header)))
        header[key] = data.draw(
            st.sampled_from([None, [], {}, "x", 3, [None], {"bodies": [3]}, {"step": "x"}])
        )
        file.attrs["header"] = json.dumps(header)
        return
    name, is_data = data.draw(st.sampled_from(found))
    if name not in file:
        return
    if what == "delete" or not is_data:
        del file[name]
        return
    values = file[name][()]
    del file[name]
    if what == "kind":
        file[name] = data.draw(
            st.sampled_from(["text", 3, np.zeros(0), np.array([b"x", b"y"]), 1.5, np.eye(2)])
        )
    elif what == "shape":
        rows = np.atleast_1d(values)
        file[name] = data.draw(st.sampled_from([rows[:0], rows[:1], rows[..., None], rows[::2], rows.T]))
    else:
        file[name] = np.full_like(values, data.draw(st.sampled_from([0, 1, -1, 5, 2**31 - 1])))


@cases(0.1)
@given(data=st.data())
def test_changed_contents(sound, tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "changed.h5"
    shutil.copyfile(sound, path)
    found, attributes = members(sound)
    with h5py.File(path, "r+", libver="latest") as file:
        for _ in range(data.draw(st.integers(1, 2))):
            if "header" in file.attrs:
                _spoil(file, data, found, attributes)
    with refused_or_fine():
        look_at(path)


LOOK = """
import contextlib, io, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from ancf.errors import ModelError
from test_fuzz_results import look_at
for path in sys.argv[2:]:
    print("looks at", path, flush=True)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            look_at(Path(path))
    except ModelError as error:
        assert error.where and error.what
print("done")
"""


def test_torn_bytes(sound, tmp_path, request):
    """Cut off at any length, or a few bytes overwritten: nobody crashes, nobody hangs."""
    rng = np.random.default_rng(1)
    whole = np.frombuffer(sound.read_bytes(), dtype=np.uint8)
    paths = []
    for k in range(max(10, round(0.03 * TOTAL))):
        torn = whole.copy()
        if k % 2:
            torn = torn[: int(rng.integers(0, len(torn)))]
        else:
            where = rng.integers(0, min(len(torn), 4096 if k % 4 else len(torn)), 8)
            torn[where] = rng.integers(0, 256, 8)
        paths.append(tmp_path / f"{k}.h5")
        paths[-1].write_bytes(torn.tobytes())
    here = str(request.path.parent)
    command = [sys.executable, "-c", LOOK, here, *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    last = done.stdout.strip().splitlines()[-1:]
    assert last == ["done"], (last, done.returncode, done.stderr[-2000:])
