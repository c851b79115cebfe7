"""Two results side by side: falls of two gravities, meshes of one beam, and what cannot be compared."""

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError


def fall(gravity=9.81, step=0.01, t_end=1.0, **more):
    model = ancf.Model(gravity=(0, 0, -gravity))
    model.add_point_mass("ball", at=(0.3, -2, 5), mass=2.0)
    model.add_point_mass("held", at=(1, 0, 0), mass=2.0)
    model.pin("held")
    return ancf.simulate(model, t_end=t_end, step=step, **more)


def test_two_falls():
    """They are apart by half the difference of the gravities times t squared."""
    found = fall().compare(fall(8.81, output_step=0.05))
    assert found.largest.point == "ball"
    assert found.largest.distance == pytest.approx(0.5, rel=1e-9)
    assert found.largest.t == pytest.approx(1.0)
    assert found.largest.moved == pytest.approx(0.5 * 9.81)
    assert found.t == pytest.approx(np.arange(21) * 0.05)
    assert [d.point for d in found.differences] == ["ball", "held"]
    assert "ball" in str(found)
    assert repr(found) == "Comparison(0.5 m at ball, t = 1 s)"


def test_a_result_with_itself():
    run = fall()
    assert run.compare(run, points=["ball"]).largest.distance == 0.0


def test_what_cannot_be_compared():
    run = fall()
    with pytest.raises(ModelError, match="must be given a Result, is given 3"):
        run.compare(3)
    with pytest.raises(ModelError, match='"bal" is no point'):
        run.compare(run, points=["bal"])
    model = ancf.Model()
    model.add_point_mass("ball", at=(0.3, -2, 5), mass=1.0)
    other = ancf.simulate(model, t_end=1.0, step=0.1)
    with pytest.raises(ModelError, match='has no body "held"'):
        run.compare(other)
    assert run.compare(other, points=["ball"]).largest.distance == pytest.approx(0.5 * 9.81)
    later = ancf.simulate(run.model, t_end=2.0, step=0.1, start=run.state(-1))
    with pytest.raises(ModelError, match="no stored time in common"):
        fall(t_end=0.55).compare(later)
