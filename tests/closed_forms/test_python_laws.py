"""Laws of the state that stay in Python, once a step, beside the same ones compiled."""

import math

import numpy as np
import pytest

import ancf
from ancf.solvers.bridge import Bridge
from ancf.solvers.status import UNBALANCED

SECTION = ancf.Section(EA=1e3, EI=0.1, rhoA=1.0, diameter=0.05, drag=(1.2, 0.1), added_mass=(1.0, 0.0))


def compiled(t, r, v):
    return -5.0 * r - 0.8 * v + np.array([0.0, math.sin(3.0 * t), 0.0])


class Law:
    """The same as an object that counts how often it is asked."""

    def __init__(self):
        self.times = []

    def __call__(self, t, r, v):
        self.times.append(t)
        return compiled(t, r, v)


def stream(t, x, y, z):
    return 0.4 * math.cos(t) + 0.3 * x, 0.2 * z, 0.1


class Stream:
    def __init__(self):
        self.times = []

    def __call__(self, t, x, y, z):
        self.times.append(t)
        return list(stream(t, x, y, z))


def hung(force=None, load=None, flow=None, elements=2):
    model = ancf.Model(gravity=(0, 0, -9.81))
    wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=SECTION)
    model.pin(wire.start, name="hook")
    if force is not None:
        model.add_force(wire.end, force, name="push")
    if load is not None:
        model.add_distributed_load(wire, load, name="along")
    if flow is not None:
        model.add_fluid("water", 300.0, velocity=flow)
    return model, wire


def tip(model, step, **given):
    return ancf.simulate(model, t_end=0.2, step=step, **given).position("wire.end")[-1]


WAYS = {
    "force": (lambda law: {"force": law}, compiled, Law, 1),
    "load": (lambda law: {"load": law}, compiled, Law, 8),  # four points in each of two elements
    "fluid": (lambda law: {"flow": law}, stream, Stream, 30),  # five points, each for a difference
}


@pytest.mark.parametrize("way", WAYS)
class TestOnceAStep:
    def test_it_is_as_good_as_the_compiled_one(self, way):
        """Both have order two and go to the same limit; the lag costs no more than the step itself."""
        given, law, kind, _ = WAYS[way]
        steps = (4e-3, 2e-3, 1e-3)
        ours = np.array([tip(hung(**given(kind()))[0], step) for step in steps])
        theirs = np.array([tip(hung(**given(law))[0], step) for step in steps])
        change = np.linalg.norm(np.diff(theirs, axis=0), axis=1)
        apart = np.linalg.norm(ours - theirs, axis=1)
        assert change[1] > 1e-7
        assert np.all(apart[1:] < change)
        assert apart[0] / apart[2] > 10.0  # order two would be sixteen

    def test_it_is_called_once_a_step(self, way):
        given, _, kind, points = WAYS[way]
        law = kind()
        model, _ = hung(**given(law))
        ancf.simulate(model, t_end=0.2, step=2e-3)
        late = np.array([t for t in law.times if t > 1.5e-4])
        assert len(late) == points * 100

    def test_equilibrium_asks_it_as_often_as_it_likes(self, way):
        given, law, kind, _ = WAYS[way]
        found = [ancf.equilibrium(hung(**given(each))[0]).position("wire.end") for each in (kind(), law)]
        assert found[0] == pytest.approx(found[1], abs=1e-10)

    def test_it_says_so(self, way):
        given, law, kind, _ = WAYS[way]
        model, _ = hung(**given(kind()))
        result = ancf.simulate(model, t_end=2e-3, step=1e-3)
        assert "called once a step" in str(model)
        assert result.provenance["settings"]["called once a step"] == [
            {"force": "push", "load": "along", "fluid": "water"}[way]
        ]
        assert "called once a step" in str(result)
        model, _ = hung(**given(law))
        assert "once a step" not in str(ancf.simulate(model, t_end=2e-3, step=1e-3)) + str(model)

    def test_steps_one_by_one_and_resumed_are_the_same_bits(self, way, tmp_path):
        given, _, kind, _ = WAYS[way]
        model, _ = hung(**given(kind()))
        whole = ancf.simulate(model, t_end=0.1, step=2e-3)
        run = ancf.stepper(model, step=2e-3)
        for _ in range(31):
            run.advance()
        assert np.array_equal(run.q, whole.q[31])
        run.save(tmp_path / "left.h5")
        again = ancf.stepper(model, start=tmp_path / "left.h5")
        again.advance(19)
        assert np.array_equal(again.q, whole.q[50])


@pytest.mark.parametrize(
    "method", [ancf.GeneralizedAlpha(0.8), ancf.Explicit(), ancf.Radau(adaptive=False)], ids=lambda m: m.name
)
def test_other_methods(method):
    ends = [tip(hung(force=law)[0], 1e-3, integrator=method) for law in (Law(), compiled)]
    assert ends[0] == pytest.approx(ends[1], abs=2e-5)


@pytest.mark.parametrize(
    ("late", "what"),
    [
        (lambda: 1 / 0, "raised ZeroDivisionError"),
        (lambda: [1.0, 2.0], "wanted"),
        (lambda: [math.nan, 0.0, 0.0], "finite"),
    ],
    ids=["raises", "shape", "nan"],
)
@pytest.mark.parametrize("way", ["force", "fluid"])
def test_one_that_has_no_value_ends_the_run(way, late, what):
    """The message has time, step and name, the result what was computed until then."""

    def force(t, r, v):
        return [0.0, {"a": 0.1}["a"], 0.0] if t < 0.0505 else late()

    def flow(t, x, y, z):
        return force(t, None, None)

    model, _ = hung(**{"force": force} if way == "force" else {"flow": flow})
    with pytest.raises(ancf.SolveError, match=what) as caught:
        ancf.simulate(model, t_end=0.1, step=1e-3)
    assert caught.value.where.startswith("t = 0.05")
    assert ", step 51, add_f" in caught.value.where
    assert caught.value.result.t[-1] == pytest.approx(0.05)


@pytest.mark.parametrize("count", [0, 2, 4, 6])
def test_compiled_one_that_gives_other_than_three_numbers_ends_the_run(count):
    """Of more than three it takes none, as of fewer."""

    def force(t, r, v):
        return np.full(3 if t < 0.0505 else count, 0.1)

    model, _ = hung(force=force)
    with pytest.raises(ancf.SolveError) as caught:
        ancf.simulate(model, t_end=0.1, step=1e-3)
    assert caught.value.where.startswith("t = 0.05")
    assert caught.value.result.t[-1] == pytest.approx(0.05)
    assert model.loads[-1].force.once == ""  # it is compiled


@pytest.mark.parametrize("way", WAYS)
def test_halved_steps_ask_it_anew(way, monkeypatch):
    """A step that fails has asked for its end; its halves, and the end of the second, are asked for again."""
    given, _, kind, _ = WAYS[way]
    whole, ends = Bridge._part, []

    def fails(looks):
        def part(bridge, core, t, size, h, first):
            if size < h:
                return whole(bridge, core, t, size, h, first)
            before = bridge._save()
            if looks:
                whole(bridge, core, t, size, h, first)
            bridge._put_back(before)
            return UNBALANCED

        return part

    for looks in (True, False):  # as far as to the end of the step, or not at all
        law = kind()
        model, _ = hung(**given(law), elements=4)
        run = ancf.stepper(model, step=0.02)
        run.advance(10)
        law.times.clear()
        with monkeypatch.context() as patched:
            patched.setattr(Bridge, "_part", fails(looks))
            run._ahead.bridge(UNBALANCED)
        asked = np.array(law.times)
        back = np.diff(asked[np.abs(asked - asked.round(2)) < 1e-9])  # a fluid is asked beside its times too
        assert np.any(back < -5e-3) == looks
        run.advance(10)
        ends.append(run.q)
    assert np.array_equal(*ends)
