"""What a wire on a mesh gives too little at the clamps of its droppers, against matrices of the oracle."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import eigh

import overhead_oracle
from ancf.catenary import Mesh, Rayleigh, Wire, form, read_line
from ancf.catenary.forms.clamps import missing_give
from ancf.catenary.forms.mesh import Nodes
from ancf.errors import ModelError
from overhead_cases import LINE_2002
from overhead_oracle import Beam, OverheadLine

NONE = np.zeros(0, dtype=np.int64)


def nodes(x):
    return Nodes(np.asarray(x, dtype=float), NONE, NONE, NONE, NONE)


def give(wire, x, at, **options):
    """What is missing at the node at a place."""
    node = int(np.argmin(np.abs(np.asarray(x) - at)))
    return missing_give(wire, nodes(x), np.array([node]), **options)[0]


def compliance(wire, x, at):
    """Displacement of a place of a beam under tension between hinges under 1 N there, m, by the oracle."""
    beam = Beam(overhead_oracle.Wire(wire.mass, wire.tension, wire.EI, 0.0), np.asarray(x))
    ends, place = beam.node(np.array([x[0], x[-1]])), int(beam.node(np.array([at]))[0])
    free = np.setdiff1d(np.arange(2 * len(x)), ends)
    return np.linalg.solve(beam.K[free][:, free].toarray(), (free == place).astype(float))[free == place][0]


class TestGive:
    @pytest.mark.parametrize(("tension", "EI"), [(20e3, 195.0), (16e3, 131.7), (3e3, 10.0), (400.0, 150.0)])
    @pytest.mark.parametrize("sizes", [(2.0,) * 10, (0.8,) * 24, (0.5, 2.0, 3.0, 1.6, 1.6, 0.8, 3.0, 1.0)])
    def test_is_what_a_fine_mesh_gives_more(self, tension, EI, sizes):
        wire = Wire(EA=1e7, EI=EI, mass=1.0, tension=tension)
        x = np.concatenate([[0.0], np.cumsum(sizes)])
        at, layer = x[len(x) // 2], np.sqrt(EI / tension)
        fine = np.unique(np.round(np.concatenate([x, at + layer * np.linspace(-8, 8, 161)]), 9))
        fine = fine[(fine >= 0.0) & (fine <= x[-1])]
        wanted = compliance(wire, fine, at) - compliance(wire, x, at)
        assert give(wire, x, at) == pytest.approx(wanted, rel=2e-3, abs=1e-4 * layer / tension)

    def test_of_a_string(self):
        """Without bending stiffness, equal elements: sqrt(2) h/(24 T)."""
        wire = Wire(EA=1e7, EI=0.0, mass=1.0, tension=10e3)
        found = [give(wire, h * np.arange(17), 8 * h) for h in (0.1, 1.0, 4.0)]
        wanted = np.sqrt(2.0) / (24.0 * wire.tension) * np.array([0.1, 1.0, 4.0])
        assert found == pytest.approx(wanted, rel=1e-6)

    def test_goes_with_the_elements(self):
        """Elements shorter than sqrt(EI/T) bend as the wire does."""
        wire = Wire(EA=1e7, EI=195.0, mass=1.0, tension=20e3)
        found = [give(wire, h * np.arange(41), 20 * h) for h in (0.8, 0.2, 0.05, 0.0125)]
        assert np.all(np.diff(found) < 0.0)
        assert found[-1] < 1e-4 * found[0]

    def test_hinges_and_ends_bend_on_any_mesh(self):
        wire, x = Wire(EA=1e7, EI=195.0, mass=1.0, tension=20e3), 2.0 * np.arange(12)
        assert [give(wire, x, at, hinges=(5,)) for at in (0.0, 10.0, 22.0)] == [0.0] * 3
        beside = give(wire, x, 12.0, hinges=(5,))
        assert beside == give(wire, x[5:], 12.0)
        assert beside != pytest.approx(give(wire, x, 12.0), rel=1e-2)


class TestBays:
    """The linear oracle on coarse elements, with droppers that have the give of their clamps in series."""

    @staticmethod
    def frequencies(line, count=60):
        square = eigh(line.K.toarray(), line.M.toarray(), eigvals_only=True, subset_by_index=(0, count - 1))
        return np.sqrt(square) / (2 * np.pi)

    @staticmethod
    @cache
    def lines():
        line = replace(LINE_2002, spans=2)
        coarse, fine = OverheadLine(line, 0.8, 2.5), OverheadLine(line, 0.8, 1.25, finest=0.08)
        return coarse, fine

    def test_ring_as_on_short_elements(self):
        """Bays from 5 to 12 Hz: without the give those of the messenger are up to 2 % too high."""
        coarse, fine = self.lines()
        wanted, plain = (self.frequencies(line) for line in (fine, coarse))
        missing = sum(
            missing_give(
                Wire(EA=1e7, EI=beam.wire.EI, mass=beam.wire.mass, tension=beam.wire.tension),
                nodes(beam.nodes),
                np.searchsorted(beam.nodes, coarse.at - 1e-7),
            )
            for beam in (coarse.contact, coarse.messenger)
        )
        stiffness = coarse.stiffness.copy()
        coarse.stiffness = stiffness / (1.0 + missing * stiffness)
        coarse.assemble()
        band = (wanted > 5.0) & (wanted < 12.0)
        found, before = (np.abs(f / wanted - 1.0)[band] for f in (self.frequencies(coarse), plain))
        bays = before > 0.009  # the others are of the masts, over which this messenger bends
        assert np.sum(bays) > 10
        assert before.max() > 0.015
        assert found[bays].max() < 5e-4


class TestForm:
    def test_change_of_the_line_is_refused(self):
        made = form(read_line("en50318-2002").excerpt(0, 2))
        line = made.line
        other = replace(line, contact_wire=replace(line.contact_wire, tension=15e3))
        with pytest.raises(ModelError) as caught:
            replace(made, line=other)
        assert caught.value.where == "form.line.contact_wire"
        with pytest.raises(ModelError, match="found with"):
            replace(made, mesh=Mesh(contact=0.5))
        damped = replace(made, line=replace(line, damping=Rayleigh(alpha=0.1, beta=0.0)))
        with pytest.raises(ModelError):
            replace(damped, line=replace(other, damping=damped.line.damping))
