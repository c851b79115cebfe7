"""Given motions that jump, in value or rate: found where they are, and said; smooth ones are not."""

import warnings

import numpy as np
import pytest

import ancf
from ancf.errors import SolveError
from ancf.model.supports import sudden
from ancf.model.supports.jumps import jumps

WIRE = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)


def beam(**clamped):
    model = ancf.Model()
    rod = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=WIRE)
    model.clamp(rod.start, **clamped)
    return model


def found(motion, end=1.0, step=1e-3, name="rotation"):
    return jumps(beam(**{name: motion}), 0.0, end, step)


def late(t):
    return 0 if t < 0.1 else 6.28 * (t - 0.1)


class TestFound:
    @pytest.mark.parametrize("end", [0.2, 1.0, 37.0, 1000.0])
    def test_a_rate_that_begins_at_once(self, end):
        [jump] = found(late, end)
        assert not jump.of_value
        assert (jump.time, jump.size) == pytest.approx((0.1, 6.28), abs=1e-4)
        assert str(jump).startswith(
            "clamp(beam.start).rotation: its rate jumps by 6.28 rad/s at t = 0.1 s, an impulse whose size"
        )

    @pytest.mark.parametrize(
        ("motion", "size"),
        [("step(t-0.1)", 1.0), (lambda t: float(t > 0.1), 1.0), (lambda t: 1e-3 * (t >= 0.1), 1e-3)],
    )
    def test_a_jump_of_the_value(self, motion, size):
        [jump] = found(motion)
        assert jump.of_value
        assert jump.time == pytest.approx(0.1, abs=1e-5)
        assert jump.size == pytest.approx(size)

    def test_of_a_vector(self):
        """The size of both components together, in metres."""
        [jump] = found(lambda t: (3 * abs(t - 0.4), 0, 4 * abs(t - 0.4)), name="displacement")
        assert (jump.time, jump.size, jump.unit) == (pytest.approx(0.4, abs=1e-5), pytest.approx(10.0), "m")

    def test_straight_lines_of_a_table(self):
        [jump] = found({"t": [0, 0.5, 1], "value": [0, 1, 1]})
        assert (jump.time, jump.size) == pytest.approx((0.5, 2.0), abs=1e-5)

    def test_of_a_sliding_joint(self):
        model = beam()
        bead = model.add_point_mass("bead", at=(0.2, 0, 0), mass=1.0)
        model.slide(bead, along="beam", motion=lambda t: 0.2 + max(0, t - 0.3))
        [jump] = jumps(model, 0.0, 0.8, 1e-3)
        assert (jump.time, jump.size) == pytest.approx((0.3, 1.0), abs=1e-5)


class TestSmooth:
    def test_a_full_turn_of_a_rotation_vector(self):
        """From pi about an axis to -pi about it nothing turns; a kink of the angle is one of the axes."""

        def wraps(t):
            angle = 7.0 * t
            return (0, 0, angle if angle < np.pi else angle - 2 * np.pi)

        assert found(wraps, name="rotation_vector") == []
        [jump] = found(lambda t: (0, 0, 2.0 * abs(t - 0.3)), name="rotation_vector")
        assert (jump.time, jump.size) == pytest.approx((0.3, 4.0), abs=1e-3)

    @pytest.mark.parametrize(
        "motion",
        [
            "45*t",
            "ramp(t, 0.2, 0.3)",
            "where(t<0.5, t**2, t - 0.25)",
            lambda t: 3 * max(0, t - 0.1) ** 2,
            lambda t: np.sin(2 * np.pi * 200 * t),
            lambda t: np.tanh((t - 0.5) / 5e-3),
            ancf.Series(np.linspace(0, 1, 101), np.sin(np.linspace(0, 6, 101))),
        ],
    )
    def test_says_nothing(self, motion):
        assert found(motion) == []

    def test_exact_derivatives_are_taken_as_they_are(self):
        zero = lambda t: 0.0  # noqa: E731
        model = beam(rotation=late, rotation_rate=zero, rotation_acceleration=zero)
        assert jumps(model, 0.0, 1.0, 1e-3) == []

    def test_a_function_that_fails_later_fails_later(self):
        def breaks(t):
            return 1 / (t < 0.5)

        assert found(breaks) == []


class TestSaid:
    def test_before_a_run_and_after_it(self, tmp_path):
        with pytest.warns(UserWarning, match=r"its rate jumps by 6\.28 rad/s at t = 0\.1 s"):
            run = ancf.simulate(beam(rotation=late), t_end=0.12, step=1e-3)
        assert "its rate jumps by 6.28 rad/s" in run.notes[0]
        assert "rate jumps" in str(run)
        run.save(tmp_path / "run.h5")
        assert ancf.load(tmp_path / "run.h5").notes == run.notes

    def test_a_step_that_fails_there(self):
        """The jump is the cause: no smaller step helps, and none is advised."""
        with pytest.warns(UserWarning, match="its value jumps by 1 rad"), pytest.raises(SolveError) as caught:
            ancf.simulate(beam(rotation="step(t-0.1)"), t_end=0.3, step=1e-3)
        assert caught.value.hint.startswith(
            "clamp(beam.start).rotation: its value jumps by 1 rad at t = 0.1 s"
        )
        assert "try a step" not in str(caught.value)
        assert caught.value.hint in str(caught.value)

    def test_noise_is_among_the_notes(self):
        t = np.arange(0, 2, 0.01)
        shaken = 5e-3 + 0.03 * np.sin(2 * np.pi * t) + 3e-4 * np.random.default_rng(0).standard_normal(len(t))
        model = beam(displacement=(ancf.Series(t, shaken, relative=True), 0, 0))
        with pytest.warns(UserWarning, match="noise"):
            run = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert any("a noise of about" in note for note in run.notes)


def run_of(model, start=None, step=1e-3):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ancf.simulate(model, t_end=0.004, step=step, start=start)


def set_off(model, start=None, step=1e-3):
    """The notes of a run that name a velocity from the start on."""
    return [note for note in run_of(model, start, step).notes if " from t = " in note]


TURNS = {"rotation_rate": "5", "rotation_acceleration": "0"}


class TestAtTheStart:
    @pytest.mark.parametrize(
        ("motion", "says"),
        [
            ({"displacement": ["2*t", 0, 0]}, "displacement: its rate is 2 m/s from t = 0 s on"),
            ({"displacement": [0, "0.01*sin(300*t)", 0]}, "displacement: its rate is 3 m/s"),
            ({"rotation": "5*t"}, "rotation: its rate is 5 rad/s"),
            ({"rotation": "5*t", "stretch": "fixed"}, "rotation: its rate is 5 rad/s"),
            ({"rotation": "5*t", **TURNS}, "rotation: its rate is 5 rad/s"),
            ({"rotation_vector": [0, 0, "5*t"]}, "rotation_vector: its rate is 5 rad/s"),
            ({"displacement": {"t": [0, 1], "value": [[0, 0, 0], [0, 0, 2]]}}, "rate is 2 m/s"),
        ],
    )
    def test_a_beam_at_rest(self, motion, says):
        """From its initial shape and from an equilibrium, in which the support alone moves."""
        model = beam(**motion)
        for start in (None, ancf.equilibrium(model)):
            [note] = set_off(model, start)
            assert note.startswith("clamp(beam.start).")
            assert says in note
            assert 'give "beam" that motion by set_motion' in note

    @pytest.mark.parametrize(
        "motion",
        [
            {"displacement": ["t**2", 0, 0]},
            {"displacement": [0, "0.01*ramp(t, 0, 0.002)", 0]},
            {"rotation": "1 - cos(40*t)"},
            {"displacement": [1e-6, 0, 0]},
            {"rotation": "t**2", "rotation_rate": "2*t", "rotation_acceleration": "2"},
        ],
    )
    def test_what_begins_smoothly_says_nothing(self, motion):
        assert set_off(beam(**motion)) == []

    def test_a_body_that_moves_so_says_nothing(self):
        turning, drawn = beam(rotation="8*t"), beam(displacement=["2*t", 0, 0])
        turning.bodies["beam"].set_motion(angular_velocity=(0, 0, 8))
        drawn.bodies["beam"].set_motion(velocity=(2, 0, 0))
        for model in (turning, drawn):
            assert set_off(model) == []

    def test_a_state_that_moves_so_says_nothing_and_another_one_does(self):
        slow, fast = beam(displacement=["2*t", 0, 0]), beam(displacement=["3*t - 0.004", 0, 0])
        state = run_of(slow).state()

        def again(model):
            return ancf.simulate(model, t_end=state.t + 0.004, step=1e-3, start=state).notes

        assert not any(" from t = " in note for note in again(slow))
        assert any("rate is 3 m/s from t = 0.004 s on" in note for note in again(fast))

    def test_what_is_joined_to_a_mass_that_moves(self):
        """A mass alone may set off; a cable that hangs on it may not, unless it moves as well."""

        def carried(joined, moves):
            model = ancf.Model()
            rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=WIRE)
            mass = model.add_point_mass("trolley", at=(0, 0, 0), mass=1.0)
            mass.set_motion(velocity=(2, 0, 0))
            rope.set_motion(velocity=(2, 0, 0) if moves else (0, 0, 0))
            model.pin(mass, displacement=["2*t", 0, 0])
            if joined:
                model.connect(rope.start, mass)
            return model

        assert set_off(carried(False, False)) == set_off(carried(True, True)) == []
        [note] = set_off(carried(True, False))
        assert note.startswith('pin(trolley).displacement: its rate is 2 m/s from t = 0 s on, "rope"')

    def test_joints_are_looked_at_once(self, monkeypatch):
        """However many supports move."""
        model, looked = ancf.Model(), []
        for k in range(6):
            mass = model.add_point_mass(f"mass {k}", at=(0, k, 0), mass=1.0)
            rope = model.add_beam(f"rope {k}", start=(0, k, 0), end=(1, k, 0), elements=1, section=WIRE)
            model.connect(mass, rope.start)
            model.pin(mass, displacement=["2*t", 0, 0])
        asked = sudden.bodies_of
        monkeypatch.setattr(sudden, "bodies_of", lambda joint: looked.append(joint) or asked(joint))
        found = sudden.sudden(model, 0.0, 1.0, 1e-3, lambda support, body: True)
        assert [jump.body for jump in found] == [f"rope {k}" for k in range(6)]
        assert len(looked) == 6

    def test_components_that_a_hold_leaves_free_do_not_count(self):
        model = ancf.Model()
        rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=WIRE)
        model.hold(rope.start, position="yz", displacement=("2*t", "t**2", 0))
        assert set_off(model) == []

    def test_a_value_that_jumps_behind_the_start(self):
        [note] = [
            n for n in run_of(beam(displacement=lambda t: (0.001 * (t > 0), 0, 0))).notes if "jumps" in n
        ]
        assert "its value jumps by 0.001 m at t = 0 s" in note
