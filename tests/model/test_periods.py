"""Given motions with few steps in a period: found by how fast they vary, and said before and after a run."""

import numpy as np
import pytest

import ancf
from ancf.model.supports.jumps import jumps
from ancf.model.supports.periods import few_steps
from commands import MODEL

WIRE = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)


def moved(motion, name="displacement"):
    model = ancf.Model()
    rod = model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=WIRE)
    model.clamp(rod.start, **{name: motion})
    return model


def said(motion, step, end=10.0, name="displacement", start=0.0):
    model = moved(motion, name)
    return few_steps(model, start, end, step, jumps(model, start, end, step))


def along_z(value):
    return [0, 0, value]


class TestVibrations:
    @pytest.mark.parametrize("steps", [2.5, 5.0, 12.0, 19.0, 21.0, 60.0])
    @pytest.mark.parametrize("frequency", [0.7, 5.0, 31.3])
    @pytest.mark.parametrize("kind", ["formula", "function", "series", "rotation"])
    def test_below_twenty_steps_the_period_is_said(self, kind, frequency, steps):
        step, text = 1 / (steps * frequency), f"0.1*sin({2 * np.pi * frequency!r}*t)"
        t = np.arange(0, 10.2, 1 / (40 * frequency))
        motion = {
            "formula": along_z(text),
            "rotation": text,
            "function": lambda t: (0, 0, 0.1 * np.sin(2 * np.pi * frequency * t)),
            "series": (0, 0, ancf.Series(t, 0.1 * np.sin(2 * np.pi * frequency * t))),
        }[kind]
        name = "rotation" if kind == "rotation" else "displacement"
        found = said(motion, step, name=name)
        assert len(found) == (steps < 20)
        if found:
            place, text = found[0].split(": moves with a period of about ")
            assert place == f"clamp(rod.start).{name}"
            period, rest = text.split(" s, ", 1)
            assert float(period) == pytest.approx(1 / frequency, rel=0.06)
            assert float(rest.split(" steps")[0]) == pytest.approx(steps, rel=0.06)

    @pytest.mark.parametrize("size", [1e-6, 1.0, 1e3])
    @pytest.mark.parametrize("start", [0.0, 3.0])
    def test_a_small_one_upon_a_large_travel(self, size, start):
        """Uniform travel has no period; the size of a vibration is no matter, nor when it is looked at."""
        motion = [f"{45 * size}*t", f"{1e-3 * size}*cos(2*pi*30*t)", 0]
        assert len(said(motion, 1e-2, start=start)) == 1
        assert said(motion, 1e-3, start=start) == []

    @pytest.mark.parametrize(
        "motion", ["45*t", "7", "t**2", "ramp(t, 1, 6)", "1e6 + 1e-12*sin(300*t)", "step(t-2)", "abs(t-3)"]
    )
    def test_what_has_no_period(self, motion):
        assert said(along_z(motion), 1e-2) == []

    def test_tables_of_straight_lines_have_corners_and_no_period(self):
        t = np.linspace(0, 10, 1001)
        for kind, count in (("linear", 0), ("spline", 1)):
            assert len(said((0, 0, ancf.Series(t, np.sin(20 * t), interpolation=kind)), 0.05)) == count


class TestSaid:
    @pytest.mark.parametrize(
        ("method", "count"), [(None, 1), (ancf.GeneralizedAlpha(rho_inf=0.8), 1), (ancf.Radau(), 0)]
    )
    @pytest.mark.parametrize("step", [1e-3, 1e-2])
    def test_of_runs_with_fixed_steps(self, method, count, step, recwarn):
        """A note and no warning: few steps of a small vibration may be meant."""
        run = ancf.simulate(moved(along_z("1e-3*sin(2*pi*12*t)")), t_end=0.1, step=step, integrator=method)
        found = [note for note in run.notes if "steps of" in note and "moves with" in note]
        assert len(found) == count * (step > 5e-3)
        assert not [item for item in recwarn if "moves with" in str(item.message)]

    @pytest.mark.parametrize(("frequency", "count"), [(5, 0), (120, 1)])
    def test_of_checked_files(self, call, tmp_path, frequency, count):
        text = MODEL.replace('stretch = "fixed"', f'displacement = ["0.01*sin(2*pi*{frequency}*t)", 0, 0]')
        (tmp_path / "m.toml").write_text(text + "[simulation]\nt_end = 1.0\nstep = 1e-3\n", "utf-8")
        ran = call("check", tmp_path / "m.toml")
        assert " ".join(ran.out.split()).count("moves with a period of") == count
