"""A spring relaxed at the mean height takes nothing from the mean force; whose uplift is whose.

A pantograph of one mass on one spring is a closed form: the sum of its forces at every step is

    F + m z" + c z' + k (z - z_r) = F_0 + a v^2

for the height z of the strip, which the run records.
"""

from functools import cache

import numpy as np
import pytest

from ancf.catenary import form, run, statistics
from overhead_lines import COARSE, LENGTHS, STEP, collector, short_line

#: One mass, kg, over a spring, N/m, and a damper, N s/m.
MASS, SPRING, DAMPER = 9.0, 200.0, 60.0
#: Window of whole spans, m.
WINDOW = (66.0, 98.0)


@cache
def shape():
    return form(short_line(), COARSE)


@cache
def done(relaxed_at, speed, static):
    unit = collector(
        masses=(MASS,),
        stiffness=(SPRING,),
        damping=(DAMPER,),
        static_force=static,
        aerodynamic=0.012,
        relaxed_at=relaxed_at,
    )
    return run(shape(), speed=speed, pantograph=unit, step=STEP, window=WINDOW)


def relaxed_height(found):
    """Height of the strip at which the spring carries nothing, by the forces at rest, m."""
    record, unit = found.recordings[0], found.pantographs[0]
    return record.strip[0] - (unit.force(found.speed) - record.force[0]) / SPRING


def mean_over_window(found, values):
    x = found.recordings[0].position
    return float(np.mean(values[(x >= WINDOW[0]) & (x <= WINDOW[1])]))


@pytest.mark.parametrize(("speed", "static"), [(60.0, 80.0), (65.0, 60.0)])
class TestRelaxedAtTheMean:
    def test_the_mean_force_is_that_of_the_law(self, speed, static):
        """Most of what the spring takes where it is relaxed at the start is given back, not taken twice."""
        law = static + 0.012 * speed**2
        taken, left = (
            law - statistics(done(at, speed, static))["mean_force"].value for at in ("start", "mean")
        )
        assert taken > 2.0
        assert left == pytest.approx(0.0, abs=0.3 * taken)

    def test_the_spring_pulls_from_there(self, speed, static):
        """The sum of all forces at every step, with the run's own height of the strip."""
        found = done("mean", speed, static)
        z, force = found.recordings[0].strip, found.recordings[0].force
        speed_z, bend = (z[2:] - z[:-2]) / (2 * STEP), (z[2:] - 2 * z[1:-1] + z[:-2]) / STEP**2
        pull = SPRING * (z[1:-1] - relaxed_height(found)) + DAMPER * speed_z + MASS * bend
        left = force[1:-1] + pull - (static + 0.012 * speed**2)
        assert abs(mean_over_window(found, np.pad(left, 1))) < 0.2


class TestUplift:
    @pytest.mark.parametrize(("speed", "static"), [(60.0, 80.0), (65.0, 60.0)])
    def test_is_largest_where_the_pantograph_is(self, speed, static):
        """Each support inside answers to its own passing: highest within 12 m of it."""
        found = done("start", speed, static)
        x = found.recordings[0].position
        places = np.cumsum((0.0, *LENGTHS))
        for k in (1, 2, 3):
            highest = x[np.argmax(found.uplift[:, k])]
            assert highest == pytest.approx(places[k], abs=12.0)
