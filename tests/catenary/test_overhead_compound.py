"""Compound catenaries: equilibrium of the whole model, strings by hand, the limit of a simple one, states."""

from dataclasses import replace

import numpy as np
import pytest

from ancf import catenary
from ancf.catenary import Auxiliary, DropperRule, Droppers, Span, Wire
from ancf.errors import ModelError
from overhead_lines import COARSE, LENGTHS, STEP, collector, droppers, short_line

WIRE = Wire(EA=6e6, EI=40.0, mass=0.9, tension=12e3)
LONG = Droppers(EA=2e5, mass=0.1, clamp_contact=0.2, clamp_messenger=0.3)


def compound(**changes):
    """The short line with an auxiliary."""
    given = {"wire": WIRE, "height": 0.3, "droppers": LONG, "places": DropperRule(first=5.0, pitch_max=10.0)}
    line = {key: changes.pop(key) for key in list(changes) if key not in given}
    return short_line(auxiliary=Auxiliary(**(given | changes)), **line)


def sag(line, mesh=COARSE):
    return catenary.form(line, mesh)


class TestForm:
    @pytest.mark.parametrize(
        "changes",
        [
            {},
            {"contact_support": "free", "anchors": "tension", "height": 0.5},
            {
                "droppers": replace(LONG, EA=None, stiffness=5e4),
                "places": DropperRule(first=3.0, pitch_max=6.5),
            },
            {"messenger_stagger": 0.0, "messenger_support": 5e5},
        ],
    )
    def test_the_model_rests_there(self, changes):
        """The equilibrium of the assembled model, which form finding does not solve."""
        found = catenary.verify(catenary.assemble(sag(compound(**changes))))
        assert found.height < 1e-7
        assert found.place < 1e-6
        assert found.tension < 4.0  # of 16 kN: the slope at an end of the messenger's first element
        assert found.load < 1e-3

    def test_forces_of_strings(self):
        """Moments about the ends of each piece: what the auxiliary's droppers carry without bending."""
        line = compound(wire=replace(WIRE, EI=0.0), droppers=replace(LONG, mass=0.0), stagger=0.0)
        found = sag(line, catenary.Mesh(contact=1.0, messenger=1.0))
        marks = np.concatenate([[0.0], line.long_x, [line.length]])
        carried = np.zeros(marks.size)
        loads = [*zip(line.dropper_x, found.dropper_force, strict=True)]
        for a, b, k in zip(marks[:-1], marks[1:], range(marks.size), strict=False):
            weight = WIRE.mass * line.gravity * (b - a)
            carried[k : k + 2] += 0.5 * weight
            for x, force in loads:
                if a <= x < b:
                    carried[k] += force * (b - x) / (b - a)
                    carried[k + 1] += force * (x - a) / (b - a)
        told = carried[1:-1] + LONG.clamp_contact * line.gravity
        assert found.long_droppers.force == pytest.approx(told, rel=1e-2)

    def test_heights(self):
        """The auxiliary is level at its droppers, the contact wire has its heights."""
        line = compound(height=0.4)
        found = sag(line)
        at = found.auxiliary.position[found.auxiliary.nodes.stitch, 2]
        give = found.long_droppers.give
        assert at == pytest.approx(0.4, abs=1.2 * float(np.max(give * found.long_droppers.force)) + 1e-6)
        assert found.contact_height == pytest.approx(line.dropper_height, abs=1e-7)

    def test_as_built(self):
        line = compound()
        found = sag(line)
        again = sag(replace(line, dropper_lengths=tuple(found.dropper_natural)))
        assert again.contact_height == pytest.approx(found.contact_height, abs=1e-6)
        assert again.long_droppers.force == pytest.approx(found.long_droppers.force, abs=1e-2)

    def test_weights_travel(self):
        """alpha L dT at the end of the auxiliary, between the middle anchor and the weight."""
        line = compound(anchors="tension")
        warm = sag(replace(line, conditions=catenary.Conditions(temperature=50.0)))
        cool = sag(line)
        moved = warm.auxiliary.position[-1, 0] - cool.auxiliary.position[-1, 0]
        middle = cool.auxiliary.nodes.support[np.argmin(np.abs(line.supports[1:-1] - line.length / 2)) + 1]
        free = (cool.auxiliary.arc[-1] - cool.auxiliary.arc[middle]) * (1.0 + WIRE.tension / WIRE.EA)
        assert moved == pytest.approx(17e-6 * 40.0 * free, rel=2e-3)
        assert warm.pull == pytest.approx(cool.pull, abs=1e-6)


class TestLimit:
    """A light auxiliary with droppers above those of the contact wire is a part of longer droppers."""

    EACH = Droppers(stiffness=2e5)

    def pair(self):
        spans = [Span(length=size, droppers=droppers(size), long_droppers=droppers(size)) for size in LENGTHS]
        faint = Wire(EA=1e5, EI=10.0, mass=1e-3, tension=300.0)
        simple = short_line(droppers=Droppers(stiffness=1e5))
        made = Auxiliary(wire=faint, height=0.25, droppers=self.EACH)
        return simple, short_line(spans=spans, droppers=self.EACH, auxiliary=made)

    def test_form(self):
        simple, double = map(sag, self.pair())
        length = double.dropper_length + double.long_droppers.length
        assert length == pytest.approx(simple.dropper_length, abs=1e-3)
        assert double.dropper_load == pytest.approx(simple.dropper_load, rel=1e-3)

    def test_run(self):
        """Standard deviation and extremes of a run are those of the simple line."""
        given = {"speed": 50.0, "pantograph": collector(), "step": STEP, "window": (66.0, 98.0)}
        one, two = (catenary.run(sag(line), **given).recordings[0].force for line in self.pair())
        assert np.std(one) > 10.0
        assert np.sqrt(np.mean((one - two) ** 2)) < 0.05 * np.std(one)  # of which 300 N of tension are most


class TestRefused:
    @pytest.mark.parametrize(
        ("changes", "where"),
        [
            ({"height": 1.3}, "line.auxiliary.height"),
            ({"places": None}, "line.spans[0].long_droppers"),
            ({"messenger_wire": None}, "line."),
            ({"wire": replace(WIRE, tension=12.0)}, "line.auxiliary.tension"),
        ],
    )
    def test_lines(self, changes, where):
        with pytest.raises(ModelError) as caught:
            compound(**changes)
        assert caught.value.where.startswith(where)

    def test_a_dropper_that_has_to_push(self):
        """A taut auxiliary over a valley."""
        line = compound(wire=replace(WIRE, tension=150e3))
        with pytest.raises(ModelError, match=r"line.auxiliary.droppers: .* has to push"):
            sag(replace(line, height=(0.0, 0.0, -0.05, 0.0, 0.0, 0.0)))
