"""Where and when a cable is pressed, against the wave of an impact and the tension of every element."""

import json

import numpy as np
import pytest

import ancf
from ancf.results.tension import compressions

EA, RHO_A = 1e3, 0.1
WAVE_SPEED = np.sqrt(EA / RHO_A)  # 100 m/s
ROPE = ancf.Section(EA=EA, EI=1e-5, rhoA=RHO_A)
#: Half waves of a straight strut, Euler: N = pi^2 EI / l^2.
EULER = np.pi**2


def thrown(speed, *, EI=1e-5, elements=20, length=1.0, name="rope", model=None, **more):
    """A straight rope along x, pinned at its start, that flies against the pin."""
    model = ancf.Model() if model is None else model
    damping = {"axial_damping": more.pop("axial_damping", 0.0)}
    section = ancf.Section(EA=EA, EI=EI, rhoA=RHO_A, **damping)
    rope = model.add_beam(
        name, start=(0, 0, 0), end=(length, 0, 0), elements=elements, section=section, **more
    )
    rope.set_motion(velocity=(-speed, 0, 0))
    model.pin(rope.start)
    return model, rope


def struck(model, time, steps=60):
    with pytest.warns(UserWarning, match="the support wins"):
        return ancf.simulate(model, t_end=time, step=time / steps)


def by_elements(result, rope):
    """Tensions in the middles of the elements, asked for one by one."""
    x = 0.5 * (rope.node_x[:-1] + rope.node_x[1:])
    return x, np.stack([result.tension(rope.at(s)) for s in x.tolist()], axis=1)


@pytest.mark.parametrize(
    ("speed", "more"),
    [
        (2.0, {}),
        (0.5, {"elements": 33, "length": 2.0}),
        (1.0, {"strain": "paper"}),
        (1.0, {"natural_shape": "straight", "axial_damping": 0.02}),
        (1.0, {"strain": "paper", "axial_damping": 0.02}),
    ],
)
def test_is_found_where_the_tension_is_lowest(speed, more):
    model, rope = thrown(speed, **more)
    result = struck(model, 0.5 * rope.length / WAVE_SPEED)
    x, tension = by_elements(result, rope)
    row, element = np.unravel_index(np.argmin(tension), tension.shape)
    [found] = compressions(result)
    assert (found.body, found.arc_length, found.t) == ("rope", x[element], result.t[row])
    assert found.tension == pytest.approx(tension.min(), rel=1e-9)
    assert found.largest == pytest.approx(max(tension.max(), 0.0), abs=1e-9 * EA)
    # behind the front the force is that of d'Alembert's wave
    behind = tension[-1, x < 0.3 * rope.length].mean()
    assert behind == pytest.approx(-EA * speed / WAVE_SPEED, rel=0.05)
    assert result.notes == [str(found)]
    assert f"{found.tension:.4g} N at rope.at({found.arc_length:.12g}), t = {found.t:.6g} s" in str(result)


@pytest.mark.parametrize("length", [0.2, 1.0, 5.0])
@pytest.mark.parametrize(("share", "count"), [(0.3, 0), (4.0, 1)])
def test_what_a_straight_strut_can_stand_is_no_compression(share, count, length):
    """Below the Euler load of its own length a cable is a strut."""
    EI = 2.0 * length**2
    force = share * EULER * EI / length**2
    model, rope = thrown(force / EA * WAVE_SPEED, EI=EI, length=length)
    result = struck(model, 0.5 * rope.length / WAVE_SPEED)
    assert by_elements(result, rope)[1].min() < -0.9 * force
    assert len(compressions(result)) == count


@pytest.mark.parametrize(("EI", "coarse"), [(1e-5, True), (0.2, False)])
def test_says_whether_the_elements_can_show_how_it_buckles(EI, coarse):
    model, rope = thrown(1.0, EI=EI)
    [found] = compressions(struck(model, 0.5 * rope.length / WAVE_SPEED))
    assert found.half_wave == pytest.approx(np.sqrt(EULER * EI / -found.tension))
    assert (found.half_wave < 2 * found.element) == coarse
    assert ("cannot show" in str(found)) == coarse


def test_every_cable_the_worst_first():
    model, _ = thrown(0.5, name="b")
    thrown(2.0, name="a", model=model, elements=7)
    thrown(1.0, name="c", model=model)
    pulled = model.add_beam("taut", start=(0, 1, 0), end=(1, 1, 0), elements=4, length=0.99, section=ROPE)
    model.pin(pulled.start)
    model.pin(pulled.end)
    result = struck(model, 0.5 / WAVE_SPEED)
    assert [item.body for item in compressions(result)] == ["a", "c", "b"]
    assert len(result.notes) == 3


@pytest.mark.filterwarnings("default:.*the support wins")
def test_run_says_where_and_when(call, tmp_path):
    (tmp_path / "model.toml").write_text(
        f"""
        [[bodies]]
        name = "rope"
        start = [0, 0, 0]
        end = [1, 0, 0]
        elements = 8
        section = {{ EA = {EA}, EI = 1e-5, rhoA = {RHO_A} }}
        motion = {{ velocity = [-1, 0, 0] }}
        [[supports]]
        type = "pin"
        point = "rope.start"
        [simulation]
        t_end = 5e-3
        step = 1e-4
        """,
        encoding="utf-8",
    )
    ran = call("run", "model.toml")
    result = ancf.load("out/results.h5")
    [found] = compressions(result)
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["compression"] == [found.as_dict()]
    assert summary["notes"] == [str(found)] == result.notes
    assert f"note: {found}" in ran.out


def test_a_taut_cable_gives_no_note():
    taut = ancf.Model(gravity=(0, 0, -9.81))
    wire = taut.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=8, length=0.99, section=ROPE)
    taut.pin(wire.start)
    taut.pin(wire.end)
    result = ancf.simulate(taut, t_end=0.02, step=1e-4)
    assert result.notes == []
