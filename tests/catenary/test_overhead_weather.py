"""Gusts, uplift by the air on each mass of a pantograph, and lines that are not as they were designed."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import ancf
from ancf import ModelError
from ancf.catenary import (
    Butterworth,
    Conditions,
    Route,
    Span,
    assemble,
    clamp_strains,
    dropper_errors,
    form,
    height_errors,
    run,
)
from ancf.catenary.answers.clamp_strain import edge, hanging, strain_below_strip
from ancf.catenary.lines.fittings import DropperErrors
from overhead_lines import COARSE, STEP, collector, short_line


@cache
def found():
    return form(short_line(), COARSE)


def windy(**conditions):
    given = {"diameter": 0.0132}
    wires = {key: replace(getattr(short_line(), key), **given) for key in ("contact_wire", "messenger_wire")}
    return form(short_line(stagger=0.0, conditions=Conditions(**conditions), **wires), COARSE)


class TestGusts:
    @pytest.mark.parametrize("wind", [18.0, -16.0])
    def test_move_the_wires_about_their_place_in_the_wind(self, wind):
        """At rest they are steady; then pressure varies by twice the turbulence, and the wire with it."""
        steady, gusty = (windy(wind=wind, turbulence=t) for t in (0.0, 0.15))
        assert gusty.contact.position == pytest.approx(steady.contact.position, abs=1e-9)
        overhead = assemble(gusty)
        middle = overhead.contact_at(83.0)
        result = ancf.simulate(
            overhead.model, t_end=30.0, step=0.02, start=ancf.equilibrium(overhead.model), sensors=[middle]
        )
        y = result.sensors.position(middle)[:, 1]
        rest = y[0]
        assert abs(rest) > 0.01
        moved = y[100:]
        assert np.std(moved) > 0.1 * abs(rest)
        assert np.std(moved) < 0.7 * abs(rest)
        assert np.mean(moved) == pytest.approx(rest, rel=0.35)

    def test_seeds(self):
        models = [assemble(windy(wind=10.0, turbulence=0.1, seed=seed)).model for seed in (3, 3, 4)]
        tables = [model.fluids[0].gusts.table for model in models]
        assert np.array_equal(tables[0], tables[1])
        assert not np.array_equal(tables[0], tables[2])

    def test_a_pantograph_runs_in_them(self):
        done = run(windy(wind=15.0, turbulence=0.2), speed=40.0, pantograph=collector(), step=STEP)
        swept = done.recordings[0].stagger
        assert np.ptp(swept) > 0.01
        assert np.all(done.recordings[0].force[10:] > 0.0)

    def test_without_wind(self):
        with pytest.raises(ModelError, match=r"turbulence: has no effect"):
            short_line(conditions=Conditions(turbulence=0.1))


class TestAerodynamic:
    @pytest.mark.parametrize("shares", [(0.01, 0.006), (0.02, -0.004)])
    def test_forces_on_each_mass(self, shares):
        """At the start all is in equilibrium with their sum, and springs carry what is below them."""
        unit = collector(static_force=70.0, aerodynamic=shares)
        done = run(found(), speed=40.0, pantograph=unit, step=STEP)
        force = 70.0 + sum(shares) * 1600.0
        assert done.recordings[0].force[0] == pytest.approx(force, abs=0.05)
        assert unit.carried(1, 40.0) == pytest.approx(70.0 + shares[0] * 1600.0)
        same = run(found(), speed=40.0, pantograph=collector(static_force=force), step=STEP)
        assert done.recordings[0].force[:20] == pytest.approx(same.recordings[0].force[:20], abs=0.5)

    def test_over_a_profile(self):
        unit = collector(static_force=100.0, aerodynamic=(0.0, 0.02))
        lumped = collector(static_force=100.0, aerodynamic=0.02)
        profile = [(0.0, 30.0), (2.0, 40.0)]
        lifts = [
            run(found(), speed=profile, pantograph=u, step=STEP).recordings[0].force for u in (unit, lumped)
        ]
        assert lifts[0].mean() == pytest.approx(lifts[1].mean(), rel=0.01)

    @pytest.mark.parametrize("value", [(0.01,), (0.01, -0.02), -0.1, (0.01, float("nan"))])
    def test_wrong(self, value):
        with pytest.raises(ModelError, match=r"pantograph\.test\.aerodynamic"):
            collector(aerodynamic=value)


class TestIrregular:
    @pytest.mark.parametrize("deviation", [0.001, 0.004])
    def test_dropper_errors(self, deviation):
        """Their spread over many seeds, and the same line for the same seed."""
        plain = found()
        errors = np.array(
            [
                np.array(dropper_errors(plain, deviation, s).dropper_lengths) - plain.dropper_natural
                for s in range(40)
            ]
        )
        count = errors.size
        assert np.std(errors) == pytest.approx(deviation, rel=3 / np.sqrt(2 * count))
        assert abs(np.mean(errors)) < 3 * deviation / np.sqrt(count)
        assert dropper_errors(plain, deviation, 7) == dropper_errors(plain, deviation, 7)
        built = form(dropper_errors(plain, deviation, 7), COARSE)
        assert 0.0 < np.std(built.contact_height - plain.contact_height) < 2 * deviation

    @pytest.mark.parametrize("seed", [1, 7])
    def test_sections_of_a_route_have_errors_of_their_own(self, seed):
        """Those of the first are those of the line alone, and none are those of another one."""
        level = {"stagger": 0.0, "height": (0.1, *[0.0] * 4, 0.1)}
        rough = short_line(dropper_errors=DropperErrors(deviation=0.003, seed=seed), **level)
        plain, alone = form(short_line(**level), COARSE), form(rough, COARSE)
        made = form(Route(lines=(rough, rough, rough), starts=(0.0, 136.0, 272.0)), COARSE)
        errors = [one.dropper_natural - plain.dropper_natural for one in made.forms]
        assert np.array_equal(made.forms[0].dropper_natural, alone.dropper_natural)
        share = np.corrcoef(errors)[~np.eye(3, dtype=bool)]
        assert np.abs(share).max() < 0.7
        assert np.std(errors, axis=1) == pytest.approx([0.003] * 3, rel=0.5)

    @pytest.mark.parametrize("slope", [0.0, 2.0])
    def test_height_errors_have_their_spectrum(self, slope):
        """Their mean square over many seeds is the integral of the density."""
        line = short_line(
            spans=[Span(length=50.0, droppers=tuple(np.arange(2.0, 50.0, 2.0)))] * 8, stagger=0.0
        )
        band = (10.0, 100.0)
        density = lambda nu: 1e-5 * (nu / 0.05) ** -slope  # noqa: E731
        squares = []
        for seed in range(30):
            rough = height_errors(line, density, band, seed)
            error = rough.dropper_height - line.dropper_height
            squares.append(np.mean(error**2))
        nu = np.linspace(1 / band[1], 1 / band[0], 20001)
        wanted = np.trapezoid(density(nu), nu)
        assert np.mean(squares) == pytest.approx(wanted, rel=0.12)
        again = height_errors(line, density, band, 3)
        assert again == height_errors(line, density, band, 3)
        assert again != height_errors(line, density, band, 4)

    def test_height_errors_are_formed(self):
        rough = height_errors(short_line(), lambda nu: 1e-6 / nu, (12.0, 60.0), seed=2)
        assert form(rough, COARSE).contact_height == pytest.approx(rough.dropper_height, abs=1e-7)

    @pytest.mark.parametrize(
        ("make", "where"),
        [
            (lambda: dropper_errors(found(), -1.0, 1), "dropper_errors.deviation"),
            (lambda: dropper_errors(found(), 5.0, 1), "dropper_errors.deviation"),
            (lambda: dropper_errors(found(), 0.001, -1), "dropper_errors.seed"),
            (
                lambda: height_errors(short_line(), lambda nu: nu, (50.0, 10.0), 1),
                "height_errors.wavelengths",
            ),
            (lambda: height_errors(short_line(), lambda nu: -nu, (5.0, 10.0), 1), "height_errors.spectrum"),
        ],
    )
    def test_wrong(self, make, where):
        with pytest.raises(ModelError) as caught:
            make()
        assert caught.value.where == where


class TestStrain:
    """At the clamps the wire has the tension, stiffness and mass of its state, not those of the design."""

    @pytest.mark.parametrize(
        ("anchors", "given"),
        [
            ("tension", {"contact_tension": 9e3}),
            ("tension", {"contact_tension": 14e3, "wear": 0.3}),
            ("tension", {"temperature": 40.0}),
            ("fixed", {"temperature": -15.0}),
            ("fixed", {"temperature": 30.0, "wear": 0.1}),
            ("fixed", {"ice": 0.4}),
        ],
    )
    def test_of_a_state(self, anchors, given):
        line = short_line(anchors=anchors, conditions=Conditions(**given))
        wire, air = line.contact_wire, line.conditions
        done = run(form(line, COARSE), speed=25.0, pantograph=collector(), step=STEP)
        [hung] = hanging(done)
        # of weights what they pull, of ends that stay EA times what the heat does not stretch, sag aside
        pull = air.contact_tension or wire.tension
        if anchors == "fixed":
            assert hung.tension == pytest.approx(float(np.mean(done.form.pull[0])), rel=1e-3)
            degrees = line.temperature if air.temperature is None else air.temperature
            cooled = wire.EA * (1.0 - air.wear) * wire.expansion * (line.temperature - degrees)
            assert np.sign(hung.tension - pull) == np.sign(cooled + 10.0 * air.ice)
            pull = hung.tension
        assert hung.tension == pytest.approx(pull, rel=1e-3)
        EI = (1.0 - air.wear) ** 2 * wire.EI
        one = clamp_strains(done)[2]
        j = int(np.flatnonzero(done.form.line.dropper_x == one.position)[0])
        droppers = line.droppers
        weight = line.gravity * (droppers.clamp_contact + 0.5 * droppers.mass * done.form.dropper_length[j])
        bent = edge(hung) / (2.0 * np.sqrt(EI * pull))
        assert one.rest == pytest.approx((done.form.dropper_force[j] - weight) * bent, rel=2e-3)
        below = strain_below_strip(done, 0)
        moving = edge(hung) / (2.0 * np.sqrt(EI * (pull - hung.mass * 625.0)))
        force = Butterworth().low_pass(done.recordings[0].force, 1.0 / STEP)
        assert below[100] == pytest.approx(force[100] * moving, rel=1e-2)
