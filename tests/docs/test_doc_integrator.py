"""The integrator of docs/howto/write_an_integrator.md: registered by a line, it runs and is in files."""

import importlib.util
import sys

import numpy as np
import pytest

import ancf
from additions import Addition
from ancf.errors import ModelError
from ancf.model.integrators import INTEGRATORS, integrator_of, table_schema
from motions import SLOW, step_rates, straight
from places import HOWTO

FILE = HOWTO / "hht.py"
EXACT = ancf.Newton(tolerance=1e-14)


@pytest.fixture(scope="module")
def HHT():
    spec = importlib.util.spec_from_file_location("doc_hht", FILE)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look it up
    spec.loader.exec_module(module)
    return module.HHT


@pytest.fixture(autouse=True)
def registered(HHT, monkeypatch):
    monkeypatch.setitem(INTEGRATORS, "hht", HHT)


def falling():
    model, beam = straight(3, "material", (0, 0, -4.0), **SLOW, damping=0.3)
    model.clamp(beam.start)
    return model, beam


@pytest.mark.parametrize("dissipation", [0.0, 0.1, 1 / 3])
def test_order(HHT, dissipation):
    method = HHT(dissipation, newton=EXACT)
    assert step_rates(falling, method, 1e-3 / 2 ** np.arange(4)) == pytest.approx([2, 2], abs=0.1)


def test_without_dissipation_is_the_trapezoidal_rule(HHT):
    ends = []
    for method in (HHT(0.0), ancf.Trapezoidal()):
        model, beam = falling()
        ends.append(ancf.simulate(model, t_end=0.1, step=1e-3, integrator=method).position(beam.end))
    assert np.array_equal(*ends)


def hilber_hughes_taylor(d, omega_h, steps):
    """u'' = -omega^2 u from u = 1 at rest by the authors' own recursion, time in steps."""
    alpha, beta, gamma, w2 = -d, 0.25 * (1 + d) ** 2, 0.5 + d, omega_h**2
    u, v, a, path = 1.0, 0.0, -w2, [1.0]
    for _ in range(steps):
        guess_u, guess_v = u + v + (0.5 - beta) * a, v + (1 - gamma) * a
        # a_n+1 + (1 + alpha) w2 u_n+1 - alpha w2 u_n = 0 with u_n+1 = guess_u + beta a_n+1
        a = (alpha * w2 * u - (1 + alpha) * w2 * guess_u) / (1 + (1 + alpha) * w2 * beta)
        u, v = guess_u + beta * a, guess_v + gamma * a
        path.append(u)
    return np.array(path)


@pytest.mark.parametrize("dissipation", [0.0, 0.05, 0.1, 1 / 3])
@pytest.mark.parametrize("omega_h", [0.3, 3.0, 30.0])
def test_is_the_authors_recursion(HHT, dissipation, omega_h):
    """A mass on a spring along a line is a linear oscillator."""
    amplitude, model = 1e-3, ancf.Model()
    mass = model.add_point_mass("mass", at=(1, 0, 0), mass=2.0)
    model.hold(mass, position="yz")
    model.add_spring(mass, (0, 0, 0), stiffness=2.0 * omega_h**2, length=1.0 - amplitude)
    result = ancf.simulate(model, t_end=30.0, step=1.0, integrator=HHT(dissipation, newton=EXACT))
    path = (result.position(mass)[:, 0] - (1.0 - amplitude)) / amplitude
    assert path == pytest.approx(hilber_hughes_taylor(dissipation, omega_h, 30), abs=1e-8)


def test_is_read_from_a_file(HHT):
    assert integrator_of({"type": "hht", "dissipation": 0.2}) == HHT(0.2)
    assert integrator_of("hht") == HHT()
    assert table_schema()["properties"]["dissipation"]["maximum"] == 1 / 3
    with pytest.raises(ModelError, match=r"integrator.dissipation: must be between 0 and 0.333"):
        integrator_of({"type": "hht", "dissipation": 0.5})
    with pytest.raises(ModelError, match="is a setting of hht, not of radau"):
        integrator_of({"type": "radau", "dissipation": 0.1})


def test_is_kept_in_results(HHT, tmp_path):
    model, _ = falling()
    ancf.simulate(model, t_end=0.01, step=1e-3, integrator=HHT(0.2), file=tmp_path / "a.h5")
    settings = ancf.load(tmp_path / "a.h5").provenance["settings"]
    assert settings["integrator"] == "hht"
    assert settings["scheme"]["alpha_f"] == 0.2


PAGE = (HOWTO / "write_an_integrator.md").read_text(encoding="utf-8")
MODULE, TABLE = "model/integrators/hht.py", "model/integrators/__init__.py"
IMPORT, BEHIND = "from .hht import HHT\n", "from .generalized_alpha import GeneralizedAlpha\n"
CODE = PAGE.split("{code-block} python\n")[1].split("```")[0]
SCRIPT = """
import json
import ancf
from ancf.model.file import parse_study
from shown import shown

study = parse_study({"gravity": [0.0, 0.0, -9.81],
    "bodies": [{"type": "point_mass", "name": "bob", "at": [0.0, 0.0, 0.0], "mass": 1.0}],
    "connections": [{"type": "spring", "a": "bob", "b": [0.0, 0.0, 1.0], "stiffness": 10.0}],
    "simulation": {"t_end": 0.2, "step": 0.1, "integrator": {"type": "hht", "dissipation": 0.05}}})
asked = study.simulation
settings = {"integrator": asked.integrator, "t_end": asked.t_end, "step": asked.step}
print(json.dumps(shown(study.model, ".", sensors=["bob"], **settings)))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package with the file of the page and its name in the table."""
    lines = {TABLE: {BEHIND: IMPORT, "(Trapezoidal, GeneralizedAlpha, Radau, Explicit": ", HHT"}}
    return Addition(tmp_path_factory.mktemp("integrator"), {FILE.name: MODULE}, lines)


def test_touches_two_files(copy):
    assert copy.touched() == [TABLE, MODULE]
    text = (copy.root / TABLE).read_text(encoding="utf-8")
    assert CODE.startswith(IMPORT)
    assert CODE.removeprefix(IMPORT).strip() in text
    assert all(f"`{place}`" in PAGE for place in copy.touched())


def test_its_result_is_printed_saved_drawn_exported_and_sampled(copy):
    """The name and the settings stand in what is printed and kept."""
    done = copy.found(SCRIPT, interpreted=True)
    assert "hht" in done["printed"][1]
    assert done["settings"]["integrator"] == "hht"
    assert done["markers"]["bob"] == "point mass"
    assert ["bob", "point mass"] in done["parts"]
    assert done["sensors"] == ["bob"]
    assert "bob position z [m]" in done["columns"]
