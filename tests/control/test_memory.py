"""Controllers with a memory: a run that is resumed against one that was not stopped."""

import warnings

import numpy as np
import pytest

import ancf
from ancf.control.delay import Delayed
from ancf.errors import Interrupted, ModelError

STEP, EVERY = 2e-3, 0.01
METHODS = [ancf.Trapezoidal(), ancf.Explicit(check=False), ancf.Radau(adaptive=False)]


def pushed():
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(0.0, 0.0, 0.0), mass=2.0)
    model.add_force(mass, (model.add_input("thrust"), 0.0, 0.0))
    return model


class Remembering:
    """Integral of the error, and the last two positions."""

    def __init__(self, gain=40.0):
        self.gain, self.sum, self.last = gain, 0.1, np.zeros(2)

    def __call__(self, run):
        x = run.position("mass")[0]
        self.sum += EVERY * (1.0 - x)
        run.inputs["thrust"] = self.gain * self.sum - 3.0 * (x - self.last[1])
        self.last = np.array([x, self.last[0]])


class Kept(Remembering):
    def state(self):
        return {"sum": self.sum, "last": self.last}

    def restore(self, state):
        self.sum, self.last = state["sum"], np.array(state["last"])


def simulated(controller, t_end, **given):
    return ancf.simulate(pushed(), t_end=t_end, step=STEP, controller=controller, control_step=EVERY, **given)


CONTROLLERS = {
    "kept": Kept,
    "late": lambda: Delayed(Kept(), 0.03),
    "late without memory": lambda: Delayed(
        lambda run: run.inputs.update(thrust=1.0 - run.position("mass")[0]), 0.03
    ),
}


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
@pytest.mark.parametrize("end", [0.05, 0.13, 0.202])
@pytest.mark.parametrize("name", CONTROLLERS)
def test_goes_on(method, end, name, tmp_path):
    """To the last bit, by a controller that is made anew, from ends on and between its calls, twice."""
    make = CONTROLLERS[name]
    whole = simulated(make(), 0.4, integrator=method)
    simulated(make(), end, integrator=method, file=tmp_path / "results.h5")
    ancf.resume(tmp_path, t_end=0.3, controller=make())
    on = ancf.resume(tmp_path, t_end=0.4, controller=make())
    assert np.array_equal(on.q[:], whole.q)
    assert np.array_equal(on.input("thrust"), whole.input("thrust"))


def test_stopped_within_a_call(tmp_path):
    """What a controller had changed in the call that was stopped is taken back: it is asked again."""

    class Stopping(Kept):
        def __call__(self, run):
            super().__call__(run)
            if run.t > 0.155:
                raise KeyboardInterrupt

    with pytest.raises(Interrupted):
        simulated(Stopping(), 0.4, file=tmp_path / "results.h5")
    on = ancf.resume(tmp_path, controller=Kept())
    assert np.array_equal(on.q[:], simulated(Kept(), 0.4).q)


def around():
    memory = {"sum": 0.0}
    gain, log = 2.0, []

    def control(run):
        memory["sum"] += 1.0
        log.append(run.t)
        run.inputs["thrust"] = gain * memory["sum"]

    return control


def counting():
    count = 0

    def control(run):
        nonlocal count
        count += 1
        run.inputs["thrust"] = float(count)

    return control


class TestLost:
    """A file that keeps no memory: the run says whose, and of what."""

    @pytest.mark.parametrize(
        ("make", "said"),
        [
            (Remembering, 'controller "Remembering" had changed "sum", "last", which'),
            (lambda: Remembering().__call__, 'had changed "sum", "last", which'),
            (around, 'controller "control" had changed "memory", which'),
            (counting, 'controller "control" had changed "count", which'),
            (lambda: Delayed(Remembering(), 0.02), 'had changed "sum", "last", which'),
        ],
    )
    def test_said(self, make, said, tmp_path):
        simulated(make(), 0.2, file=tmp_path / "results.h5")
        with pytest.warns(UserWarning, match="the controller") as caught:
            ancf.resume(tmp_path, t_end=0.4, controller=make())
        assert any(said in str(one.message) and "restore(state)" in str(one.message) for one in caught)

    def test_of_one_that_remembers_nothing(self, tmp_path):
        """Numbers that stay, and a log that grows, are no memory."""
        log, gain = [], 2.0

        def control(run):
            log.append(run.t)
            run.inputs["thrust"] = gain * (1.0 - run.position("mass")[0])

        simulated(control, 0.2, file=tmp_path / "results.h5")
        log.clear()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            on = ancf.resume(tmp_path, t_end=0.4, controller=control)
        assert np.array_equal(on.q[:], simulated(control, 0.4).q)

    def test_what_no_file_keeps(self, tmp_path):
        class Wrong(Kept):
            def state(self):
                return {"sum": {1.0}}

        with pytest.raises(ModelError, match=r"simulate\.controller: state\(\) gave .*no file can keep"):
            simulated(Wrong(), 0.1)
