"""Notes on bodies that are stretched by more than a tenth: by how much, where and when, and where none is."""

import numpy as np
import pytest

import ancf
from ancf.results.stretched import LARGE, strains, stretched

SQUARE = {"width": 0.02, "height": 0.02, "rho": 900.0, "nu": 0.0}
KINDS = ["material", "paper", "original", "nonlocking"]


def pulled(kind, share, *, elements=3, length=2.0, name="rope", model=None, EA=40.0):
    """A straight body along x, clamped at its start and pulled by a share of EA."""
    model = ancf.Model() if model is None else model
    if kind in ("original", "nonlocking"):
        section, more = ancf.Section.rectangle(E=EA / 0.0004, **SQUARE), {"element": kind}
    else:
        section, more = ancf.Section(EA=EA, EI=0.5, rhoA=0.1), {"strain": kind}
    body = model.add_beam(
        name, start=(0, 0, 0), end=(length, 0, 0), elements=elements, section=section, **more
    )
    model.clamp(body.start)
    model.add_force(body.end, (share * EA, 0.0, 0.0))
    return model, body


def by_length(state, body):
    return float(np.linalg.norm(state.position(body.end) - state.position(body.start))) / body.length - 1.0


def said(known):
    return [text for text in known.notes if "stretched" in text or "pressed together" in text]


class TestByHowMuch:
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize("share", [0.01, 0.09, 0.13, 0.6])
    def test_strain_is_the_change_of_length(self, kind, share):
        model, body = pulled(kind, share)
        state = ancf.equilibrium(model)
        wanted = by_length(state, body)
        np.testing.assert_allclose(strains(state, body, state.q[None]), wanted, rtol=1e-9)
        assert len(said(state)) == (wanted > LARGE)
        for item, text in zip(stretched(state), said(state), strict=True):
            assert item.strain == pytest.approx(wanted, rel=1e-9)
            assert f'"rope" is stretched by {100 * wanted:.3g} % at {item.point}, t = 0 s' in text
            assert "EA of 40 N given in kN" in text

    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize("share", [-0.3, -0.12, -0.08, 0.08, 0.12, 0.5])
    def test_bodies_between_two_walls(self, kind, share):
        """Beams are spoken of if pressed as well; what cables are pressed by has a note of its own."""
        model, body = pulled(kind, 0.0, length=0.05)
        model.pin(body.end, displacement=[f"{0.05 * share}*ramp(t, 0, 1)", 0, 0])
        found = ancf.simulate(model, t_end=1.0, step=0.01)
        solid = kind in ("original", "nonlocking")
        assert len(said(found)) == (share > LARGE or (solid and share < -LARGE))
        how = "is stretched by" if share > 0 else "is pressed together by"
        assert all(f"{how} {100 * abs(share):.3g} %" in text for text in said(found.state()))

    @pytest.mark.parametrize("EA", [5e6, 3e5])
    @pytest.mark.parametrize("length", [20.0, 300.0])
    def test_kilonewtons(self, EA, length):
        """The same hanging rope with EA in N is not spoken of, with the number in kN it is."""
        for factor, count in ((1.0, 0), (1e-3, 1)):
            model = ancf.Model(gravity=(0, 0, -9.81))
            section = ancf.Section(EA=EA * factor, EI=0.0, rhoA=EA / 1e7)
            sag = {"length": 1.01 * length, "elements": 16, "section": section}
            rope = model.add_beam("rope", start=(0, 0, 0), end=(length, 0, 0), **sag)
            model.add_point_mass("load", at=(length / 2, 0, 0), mass=EA / 1e4)
            model.connect(rope.at(1.01 * length / 2), "load")
            model.pin(rope.start)
            model.pin(rope.end)
            assert len(said(ancf.equilibrium(model))) == count


class TestWhere:
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.parametrize("EA", [20.0, 400.0])
    def test_in_a_run_the_largest_of_all_states(self, kind, EA):
        """A load that is let go stretches the body twice as far as at rest, and later less."""
        model, body = pulled(kind, 0.12, elements=4, EA=EA)
        model.add_point_mass("load", at=(2, 0, 0), mass=5.0)
        model.connect(body.end, "load")
        period = 2 * np.pi * np.sqrt(5.0 * body.length / EA)
        result = ancf.simulate(model, t_end=0.8 * period, step=period / 150)
        every = strains(result, body, result.q[:])
        row, element = np.unravel_index(np.argmax(every), every.shape)
        [item] = stretched(result)
        place = float(0.5 * (body.node_x[element] + body.node_x[element + 1]))
        assert (item.t, item.point) == (result.t[row], str(body.at(place)))
        assert item.strain == pytest.approx(0.24, rel=0.3)
        assert item.t == pytest.approx(period / 2, rel=0.15)
        assert said(result) == [str(item)]

    @pytest.mark.parametrize("count", [1, 2, 4, 9])
    def test_is_said_once_and_of_the_worst(self, count):
        model = ancf.Model()
        for k in range(count):
            pulled("material", 0.11 + 0.02 * k, name=f"rope{k}", model=model)
        pulled("material", 0.05, name="stiff", model=model)
        state = ancf.equilibrium(model)
        [text] = said(state)
        assert text.startswith(f'"rope{count - 1}" is stretched by {11 + 2 * (count - 1)} %')
        assert [item.body for item in stretched(state)] == [f"rope{k}" for k in range(count)][::-1]
        assert ("so far as well" in text) == (count > 1)
        assert ("5 more" in text) == (count == 9)
        assert "stiff" not in text


class TestNone:
    @pytest.mark.parametrize("angle", [0.5, 1.0, 1.5])
    @pytest.mark.parametrize("kind", KINDS)
    def test_shapes_that_are_curved_by_nature(self, kind, angle):
        """Elements that turn by so much are longer in their middles than along their chords."""
        more = {"element": kind} if kind in ("original", "nonlocking") else {"strain": kind}
        section = ancf.Section.rectangle(E=1e7, **SQUARE)
        t = np.linspace(0, 4 * angle, 200)
        path = np.column_stack([np.sin(t), np.zeros_like(t), 1 - np.cos(t)])
        model = ancf.Model()
        arc = model.add_beam("arc", path=path, elements=4, section=section, **more)
        model.clamp(arc.start)
        for x in arc.node_x[1:].tolist():
            model.hold(arc.at(x), position="y", slope="y")
        state = ancf.equilibrium(model)
        assert said(state) == []
        start, _ = state.system.initial_state()
        np.testing.assert_allclose(strains(state, arc, start[None]), 0.0, atol=1e-12)

    @pytest.mark.parametrize("to", [0.5, 1.6])
    @pytest.mark.parametrize("share", [0.02, 0.2])
    def test_what_a_winch_has_let_out_is_no_strain(self, to, share):
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=0.01, rhoA=0.1)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(4, 0, 0), elements=8, section=section)
        model.pin(rope.end)
        model.winch(rope.end, length=lambda t: 4.0 * (1.0 + (to - 1.0) * min(t, 1.0) ** 2))
        model.add_force(rope.start, (-share * 1e3, 0, 0))
        state = ancf.equilibrium(model)
        state = ancf.simulate(model, t_end=1.0, step=0.02, start=state).state()
        largest = strains(state, rope, state.q[None]).max()
        assert len(said(state)) == (largest > LARGE) == (share > LARGE)


RUN = "[simulation]\nt_end = 0.05\nstep = 0.01\nstart = 'equilibrium'\n"


@pytest.mark.parametrize(("EA", "count"), [(1e3, 0), (20.0, 1)])
@pytest.mark.parametrize("simulation", ["", RUN])
def test_commands_say_it(call, tmp_path, EA, count, simulation):
    (tmp_path / "model.toml").write_text(
        f"""
        gravity = [0, 0, -9.81]
        [[bodies]]
        name = "rope"
        start = [0, 0, 0]
        end = [0, 0, -1]
        elements = 4
        section = {{ EA = {EA}, EI = 0.0, rhoA = 0.5 }}
        [[supports]]
        type = "pin"
        point = "rope.start"
        """
        + (simulation or "[equilibrium]\n"),
        encoding="utf-8",
    )
    ran = call("run", "model.toml")
    assert ran.code == 0
    result = ancf.load("out/results.h5")
    assert ran.out.count('note: "rope" is stretched by') == count
    assert len(said(result)) == len(said(result.state())) == count
    assert str(result).count('"rope" is stretched') == count
