"""Springs among the sensors: measured in the step, they say what the positions of their ends say."""

import json

import h5py
import numpy as np
import pytest

import ancf
from ancf import preparation
from ancf.system.sensors import listing
from ancf.system.system import System
from helpers import ELEMENTS, square

#: Of springs between nodes or between them, masses and the ground; what they may be beside a stiffness.
LAW = [[-0.05, -40.0], [0.0, 0.0], [0.02, 5.0], [0.05, 60.0]]
KINDS = {
    "plain": {},
    "damped": {"damping": 3.0},
    "slack": {"slack": True, "damping": 1.0},
    "curved": {"law": LAW, "damper": [[-1.0, -8.0], [0.0, 0.0], [1.0, 2.0]]},
    "rubbing": {"friction": 2.0, "friction_velocity": 0.05},
}
#: A force is computed twice, from extensions that are small beside the lengths.
ROUND_OFF = 1e-10
QUESTIONS = ("spring_force", "spring_length")


def hung(element="cable", touched=False):
    """A wire or beam that shakes on springs of all kinds, at nodes, between them and to the ground."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = square(element, EA=1e4, EI=2.0, rhoA=1.0, damping=0.1)
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(4, 0, 0), elements=4, section=section, element=element
    )
    model.pin(wire.start, displacement=(0, 0, "0.05*sin(30*t)"))
    model.pin(wire.end)
    places = np.linspace(0.5, 3.5, len(KINDS))  # the third one is a node
    for k, ((name, more), x) in enumerate(zip(KINDS.items(), places, strict=True)):
        bob = model.add_point_mass(f"bob {k}", at=(x, 0, -0.5), mass=0.5)
        model.add_spring(bob, wire.at(x), stiffness=500.0, name=name, **more)
        model.add_spring(
            bob, (x, 0.3, -0.9), stiffness=20.0, length=0.45, name=f"{name} to the ground", **more
        )
    if touched:
        strip = model.add_point_mass("strip", at=(1.9, 0, 0.002), mass=1.0)
        model.hold(strip, position="xy", displacement=("0.5*t", 0, 0))
        strip.set_motion(velocity=(0.5, 0, 0))
        model.add_force(strip, (0, 0, 30.0))
        model.add_contact(strip, wire, stiffness=2000.0, name="touch")
    return model


SPRINGS = [c.name for c in hung().connections]


def assert_same(sensors, wanted, names=SPRINGS, at=slice(None)):
    """Forces and lengths are those that something else says."""
    for name in names:
        for question in QUESTIONS:
            got, other = getattr(sensors, question)(name)[at], getattr(wanted, question)(name)[at]
            assert got.shape == other.shape
            assert got == pytest.approx(other, rel=ROUND_OFF, abs=ROUND_OFF * np.abs(other).max()), name


@pytest.mark.parametrize("element", ELEMENTS)
def test_from_positions(element):
    """The positions of the stored states give force and length by formulas of their own."""
    model = hung(element)
    result = ancf.simulate(model, t_end=0.15, step=1e-3, sensors=SPRINGS)
    sensors = result.sensors
    assert np.array_equal(sensors.t, result.t)
    assert_same(sensors, result)
    slack = sensors.spring_force("slack")
    assert 0 < np.count_nonzero(slack == 0.0) < len(slack)
    assert sensors.q.shape == (len(result.t), 0)
    assert all(np.ptp(sensors.spring_force(name)) > 0.0 for name in SPRINGS)


@pytest.mark.parametrize("names", [["slack"], ["touch"], ["touch", "curved"], ["rubbing", "touch", "plain"]])
def test_only_what_is_listed_is_measured(names):
    """In any order, with contacts and without; the run itself is the same."""
    model = hung(touched=True)
    given = {"t_end": 0.02, "step": 1e-3}
    result = ancf.simulate(model, **given, sensors=names)
    system, springs = result.system, [name for name in names if name != "touch"]
    assert system.sensors.width == 2 * len(springs) + 4 * ("touch" in names)
    for name in SPRINGS:
        force, length = system.measured[system.measures[name]]
        last = result.spring_force(name)[-1], result.spring_length(name)[-1]
        assert (force, length) == (pytest.approx(last, rel=ROUND_OFF) if name in springs else (0.0, 0.0))
    assert_same(result.sensors, result, springs)
    if "touch" in names:
        assert result.sensors.contact_force("touch") == pytest.approx(result.contact_force("touch"), abs=1e-9)
        assert np.max(result.sensors.contact_force("touch")) > 1.0
    else:
        with pytest.raises(ancf.ModelError, match="no contact that the sensors have recorded"):
            result.sensors.contact_force("slack")
    plain = ancf.simulate(model, **given).q
    assert np.array_equal(plain, result.q) if "touch" not in names else plain == pytest.approx(result.q)


def test_two_numbers_a_spring():
    """Whatever hangs on it: an element's unknowns are left alone, where they are not asked for."""
    for element in ELEMENTS:
        model = hung(element)
        listed = listing(System(model), [model.sensor(name) for name in SPRINGS], True)
        assert (listed.width, len(listed.index)) == (2 * len(SPRINGS), 0)


def test_ends_are_points_of_their_own():
    """They have positions where they are listed; without, the message says so."""
    model = hung()
    result = ancf.simulate(model, t_end=5e-3, step=1e-3, sensors=["plain", "wire.at(0.5)"])
    sensors = result.sensors
    assert np.array_equal(sensors.position("wire.at(0.5)"), result.position("wire.at(0.5)"))
    with pytest.raises(ancf.ModelError, match="was not recorded") as caught:
        sensors.position("bob 0")
    assert "list its end as well" in caught.value.hint
    with pytest.raises(ancf.ModelError, match="unknown spring"):
        sensors.spring_force("slack")


GIVEN = {"step": 1e-3, "output_step": 5e-3}
LISTED = ["bob 1", "touch", *SPRINGS]
#: Rows before the end of half a run: the rates of the moving support are one-sided in the last steps.
BEFORE = 28


@pytest.fixture(scope="module")
def whole():
    """A run that is not stopped, in memory."""
    return ancf.simulate(hung(touched=True), t_end=0.06, sensors=LISTED, **GIVEN)


@pytest.fixture
def earlier(monkeypatch):
    """Sensors record as in files of earlier versions: by the ends of springs."""

    def by_ends(system, items, accelerations, ends=False):
        return listing(system, items, accelerations, ends=True)

    monkeypatch.setattr(preparation, "listing", by_ends)
    yield
    monkeypatch.undo()


def stopped(path):
    """The first half of the run in a file."""
    return ancf.simulate(hung(touched=True), t_end=0.03, sensors=LISTED, file=path, **GIVEN)


class TestFiles:
    def test_loaded_and_resumed(self, whole, tmp_path):
        """The rows are those of the run that was not stopped, to the last bit."""
        path = tmp_path / "run.h5"
        first, rows = stopped(path), slice(BEFORE)
        for result in (first, ancf.load(path)):
            assert_same(result.sensors, whole.sensors, at=rows)
            assert result.sensors.listing.springs.keys() == set(SPRINGS)
        run = ancf.stepper(hung(touched=True), start=path)
        run.advance(61 - len(run.sensors.t))
        for sensors, count in ((ancf.resume(path, t_end=0.06).sensors, 61), (run.sensors, 30 + BEFORE)):
            assert np.array_equal(sensors.t[:count], whole.sensors.t[:count])
            for name in SPRINGS:
                got, wanted = sensors.spring_force(name), whole.sensors.spring_force(name)
                assert np.array_equal(got[:count], wanted[:count])
        whole.save(tmp_path / "copy.h5")
        assert_same(ancf.load(tmp_path / "copy.h5").sensors, whole.sensors)

    def test_of_an_earlier_version(self, whole, tmp_path, earlier, monkeypatch):
        """It is read, and goes on with the columns that it has; ends of springs are known."""
        path, ends = tmp_path / "run.h5", ["wire.at(0.5)", "bob 4"]
        stopped(path)
        monkeypatch.undo()
        with h5py.File(path, "r+") as file:
            plain = json.loads(file["sensors"].attrs["listed"])
            assert plain.pop("springs") == []
            assert plain["columns"].keys() == {"touch"}
            file["sensors"].attrs["listed"] = json.dumps(plain)
        before = ancf.load(path).sensors
        assert_same(before, whole.sensors, at=slice(BEFORE))
        run = ancf.stepper(hung(touched=True), start=path)
        run.advance(61 - len(run.sensors.t))
        for sensors, count in ((ancf.resume(path, t_end=0.06).sensors, 61), (run.sensors, 30 + BEFORE)):
            assert_same(sensors, whole.sensors, at=slice(count))
            assert not sensors.listing.springs
            force = sensors.contact_force("touch"), whole.sensors.contact_force("touch")
            assert np.array_equal(force[0][:count], force[1][:count])
            for end in ends:
                got, wanted = sensors.position(end)[:count:5], whole.position(end)
                assert got == pytest.approx(wanted[: len(got)], rel=1e-12, abs=1e-15)

    def test_without_a_checkpoint(self, whole, tmp_path, earlier, monkeypatch):
        """Runs that start anew from a file go on with its columns, too."""
        path = tmp_path / "run.h5"
        stopped(path)
        monkeypatch.undo()
        with h5py.File(path, "r+") as file:
            del file["checkpoints"]
        with pytest.warns(UserWarning, match="no checkpoint"):
            sensors = ancf.resume(path, t_end=0.06).sensors
        assert sensors.spring_length("plain") == pytest.approx(whole.sensors.spring_length("plain"), rel=1e-6)
        assert not sensors.listing.springs


def test_what_springs_say_is_no_history(tmp_path):
    """A checkpoint holds what a step needs: the numbers of the sensors are computed anew."""
    run = ancf.stepper(hung(touched=True), step=1e-3, sensors=LISTED)
    run.advance(3)
    arrays = run._run.snapshot().arrays
    assert "parts.contacts.found" in arrays
    assert not any(place.startswith(("measured", "parts.springs.found")) for place in arrays)
