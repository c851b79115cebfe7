"""The element of docs/howto/write_an_element.md: its kernels are right, as the page says."""

import importlib.util
import sys

import numba
import numpy as np
import pytest

import ancf
from additions import Addition
from ancf.compiled import add_force, add_inertia, add_tangent, strain_energy
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS, ElementKind
from helpers import derivative
from places import HOWTO

FILE = HOWTO / "hencky.py"
LENGTHS = [0.0, 0.3, 0.8, 1.2]


@pytest.fixture(scope="module")
def element():
    """The module of the page; its kernels are registered on import."""
    spec = importlib.util.spec_from_file_location("doc_hencky", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses and numba look a type's module up
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def batch(element):
    section = ancf.Section(EA=40.0, EI=2.0, rhoA=0.7, damping=0.3)
    beam = ancf.Model().add_beam("beam", start=(0, 0, 0), end=(1.2, 0, 0), nodes=LENGTHS, section=section)
    slots = np.arange(8).reshape(4, 2) * 3
    made = element.build([beam], [slots])
    # a dense matrix of blocks: block (x, y) of 3x3 starts at 36 (4 x + y), in rows of six
    n = len(made.base)
    return made._replace(dest=36 * np.arange(16 * n).reshape(n, 16))


@pytest.fixture(scope="module")
def state():
    """A bent and stretched shape."""
    x = np.repeat(LENGTHS, 2)
    q = np.zeros((8, 3))
    q[0::2, 0], q[1::2, 0] = x[::2], 1.0
    return (q + 0.1 * np.random.default_rng(1).uniform(-1, 1, (8, 3))).ravel()


WS = np.zeros(1)


@numba.njit
def energy(batch, q, ws):
    return strain_energy(batch, q, ws)


@numba.njit
def force(batch, q, v, a, r, ws):
    add_force(batch, q, v, a, r, ws)


@numba.njit
def inertia(batch, a, r, ws):
    add_inertia(batch, a, r, ws)


@numba.njit
def tangent(batch, q, v, A, mass, damping, stiffness, ws):
    add_tangent(batch, q, v, A, mass, damping, stiffness, ws)


def forces(batch, q, v=None, a=None):
    r, zero = np.zeros_like(q), np.zeros_like(q)
    force(batch, q, zero if v is None else v, zero if a is None else a, r, WS)
    return r


def matrix(batch, q, *factors):
    """Dense matrix from the 3x3 blocks."""
    A, dense = np.zeros(36 * batch.dest.size), np.zeros((q.size, q.size))
    tangent(batch, q, np.zeros_like(q), A, *factors, WS)
    blocks = A.reshape(*batch.dest.shape, 6, 6)[..., :3, :3]
    for e, base in enumerate(batch.base):
        for x, i in enumerate(base):
            for y, j in enumerate(base):
                dense[i : i + 3, j : j + 3] += blocks[e, 4 * x + y]
    return dense


def test_force_is_the_gradient_of_the_energy(batch, state):
    wanted = derivative(lambda q: energy(batch, q, WS), state)
    assert forces(batch, state) == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())


def test_tangent_is_the_gradient_of_the_force(batch, state):
    wanted = derivative(lambda q: forces(batch, q), state)
    assert matrix(batch, state, 0.0, 0.0, 1.0) == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())


def test_mass_and_damping(batch, state):
    """They sum to those of the body, and the matrix is what the force takes."""
    M, C = matrix(batch, state, 1.0, 0.0, 0.0), matrix(batch, state, 0.0, 1.0, 0.0)
    along = np.zeros((8, 3))
    along[0::2, 1] = 1.0
    whole = along.ravel()
    assert whole @ M @ whole == pytest.approx(0.7 * 1.2)
    np.testing.assert_allclose(C, M * 0.3 / 0.7, atol=1e-15)
    rate = np.random.default_rng(2).uniform(-1, 1, state.size)
    assert forces(batch, state, v=rate) - forces(batch, state) == pytest.approx(C @ rate, abs=1e-12)
    r = np.zeros_like(state)
    inertia(batch, rate, r, WS)
    assert r == pytest.approx(M @ rate, abs=1e-12)


def test_strain_is_logarithmic(batch):
    """A cable stretched evenly to twice its length: EA/2 ln(2)^2 per length."""
    q = np.zeros((8, 3))
    q[0::2, 0], q[1::2, 0] = 2.0 * np.array(LENGTHS), 2.0
    assert energy(batch, q.ravel(), WS) == pytest.approx(0.5 * 40.0 * np.log(2.0) ** 2 * 1.2)


class TestRegistered:
    """One line is all that a model needs to have it."""

    @pytest.fixture(autouse=True)
    def registered(self, element, monkeypatch):
        monkeypatch.setitem(KINDS, "hencky", ElementKind("hencky", ("material",), vectors=2, internal=0))
        monkeypatch.setitem(ELEMENTS, "hencky", element)

    def cantilever(self, element):
        section = ancf.Section.rectangle(0.01, 0.01, E=1e8, rho=500.0)
        model = ancf.Model(gravity=(0, 0, -9.81))
        ends = {"start": (0, 0, 0), "end": (1, 0, 0)}
        beam = model.add_beam("beam", **ends, elements=8, section=section, element=element)
        model.clamp(beam.start, stretch="fixed")
        return model

    def drawn(self, element):
        return ancf.simulate(self.cantilever(element), t_end=1e-3, step=1e-3).state(0)

    def test_falls_as_the_cable_does(self):
        """Strains are small: the measures agree."""
        ours, cable = (
            ancf.simulate(self.cantilever(kind), t_end=0.4, step=2.5e-4) for kind in ("hencky", "cable")
        )
        assert ours.position("beam.end")[-1] == pytest.approx(cable.position("beam.end")[-1], abs=4e-7)
        energy = ours.energy.total
        assert np.ptp(energy) < 1e-6 * np.ptp(ours.energy.kinetic)

    def test_equilibrium_and_frequencies(self):
        ours, cable = (ancf.equilibrium(self.cantilever(kind)) for kind in ("hencky", "cable"))
        assert ours.position("beam.end") == pytest.approx(cable.position("beam.end"), abs=4e-7)
        frequencies = [
            ancf.modes(drawn.model, about=drawn, count=3).frequencies_hz
            for drawn in (self.drawn(kind) for kind in ("hencky", "cable"))
        ]
        assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-9)


PAGE = (HOWTO / "write_an_element.md").read_text(encoding="utf-8")
MODULE, TABLE = "elements/hencky.py", "model/elements.py"
LINE = '"hencky": ElementKind("hencky", ("material",), vectors=2, internal=0),\n'
SCRIPT = """
import json
import ancf
from ancf.model.file import parse_study
from shown import shown

section = {"shape": "rectangle", "width": 0.01, "height": 0.01, "E": 1e8, "rho": 500.0}
study = {"gravity": [0.0, 0.0, -9.81], "bodies": [
    {"name": "beam", "start": [0.0, 0.0, 0.0], "end": [1.0, 0.0, 0.0], "elements": 2, "section": section,
     "element": "hencky"}],
    "supports": [{"type": "clamp", "point": "beam.start"}],
    "loads": [{"type": "force", "point": "beam.end", "force": [0.0, "sin(t)", 0.0]}]}
print(json.dumps(shown(parse_study(study).model, ".", sensors=["beam.end"])))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package with the file and the line of the page."""
    lines = {TABLE: {"KINDS: dict[str, ElementKind] = {\n": "    " + LINE}}
    return Addition(tmp_path_factory.mktemp("element"), {FILE.name: MODULE}, lines)


def test_touches_two_files(copy):
    assert copy.touched() == [MODULE, TABLE]
    assert LINE in PAGE
    assert all(f"`{place}`" in PAGE for place in (f"src/ancf/{MODULE}", TABLE))


def test_is_printed_saved_drawn_exported_and_sampled(copy):
    """Read from a file; the two steps run with kernels that Python interprets."""
    done = copy.found(SCRIPT, interpreted=True)
    assert "hencky" in done["printed"][0]
    assert done["described"]["bodies"][0]["element"] == "hencky"
    assert done["traces"] == {"beam": "hencky"}
    assert ["beam", "hencky"] in done["parts"]
    assert "clamp" in done["legend"]
    assert done["sensors"] == ["beam.end"]
    assert "beam.end position z [m]" in done["columns"]
