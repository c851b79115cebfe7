"""Derivatives of a run along a line by lengths of droppers: through its form, slack droppers and contact."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary.derivatives import Linearised, parameters
from ancf.catenary.forms.mesh import Mesh
from ancf.catenary.lines.file import parse_line
from ancf.catenary.rest import assemble

EXAMPLE = Path(__file__).parents[2] / "examples" / "droppers_line.toml"
MESH = Mesh(contact=3.0, messenger=4.0)
#: Iterations that settle part by part leave 1e-7 N, which differences of runs see.
TIGHT = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-12, modified=False))
RUN = {"speed": 80.0, "step": 2e-3, "pantograph": "en50318-2002", "start": 10.0}
RUN |= {"window": (61.0, 101.0), "until": 110.0, "integrator": TIGHT}
KEYS = ("deviation", "mean_force", "maximum", "deviation_5_20", "uplift")


@pytest.fixture(scope="module")
def line():
    tables = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    tables["spans"][0]["repeat"] = 2
    tables["spans"][0]["length"] = 61.0
    tables["spans"][0]["droppers"] = [6.0, 18.0, 30.5, 43.0, 55.0]
    return parse_line(tables, "line")


def longer(line, label, by):
    """The form with one natural length changed."""
    design = catenary.form(line, MESH)
    lengths = np.array(design.dropper_natural)
    lengths[5 * (int(label[0]) - 1) + int(label[2]) - 1] += by
    return catenary.form(replace(line, dropper_lengths=tuple(lengths.tolist())), MESH)


def test_line_at_rest(line):
    overhead = assemble(longer(line, "2-2", 0.0))
    wanted = parameters(overhead, overhead.model, {"a": ["2-2"]})
    own = ancf.equilibrium(overhead.model, sensitivities=wanted).sensitivity("a")

    def heights(by):
        made = assemble(longer(line, "2-2", by))
        state = ancf.equilibrium(made.model)
        return np.array([state.position(d.a)[2] for d in made.droppers])

    differences = (heights(1e-5) - heights(-1e-5)) / 2e-5
    mine = np.array([own.position(d.a)[2] for d in overhead.droppers])
    assert np.max(np.abs(mine - differences)) < 1e-4 * np.max(np.abs(differences))


def check_linearised(done):
    """A force that is as many derivatives larger has the statistics of that force."""
    force = done.recordings[0].force
    made = Linearised(done)
    for by in (0.0, 2e-3):
        recording = replace(done.recordings[0], force=force + by * done.slopes["a"].force[0])
        statistics = catenary.statistics(replace(done, recordings=[recording]))
        found = made.at(np.array([by]))
        for key in ("mean_force", "deviation", "deviation_0_5", "deviation_5_20", "maximum", "raw_minimum"):
            assert found[key][0] == pytest.approx(statistics[key].value, rel=1e-10), key


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_statistics_of_a_run(line):
    """The bar is 1e-4 where slack droppers and the contact keep their order."""
    done = catenary.run(longer(line, "2-2", 0.0), sensitivities={"a": ["2-2"]}, **RUN)
    assert np.min(done.dropper_force) == 0.0  # some went slack
    found = catenary.slopes(done)["a"]
    check_linearised(done)

    def numbers(by):
        statistics = catenary.statistics(catenary.run(longer(line, "2-2", by), **RUN))
        return np.array([statistics[key].value for key in KEYS])

    differences = dict(zip(KEYS, (numbers(4e-6) - numbers(-4e-6)) / 8e-6, strict=True))
    for key in KEYS[:4]:
        assert found[key] == pytest.approx(differences[key], rel=1e-4), key
    # the height at rest is that of the form, which settles to a micrometre
    assert found["uplift"] == pytest.approx(differences["uplift"], rel=1e-2)


@pytest.mark.parametrize(
    ("given", "off"), [({"contact_stiffness": 50e3}, 1e-5), ({}, 3e-4)], ids=["on a spring", "rigid"]
)
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_statistics_with_a_sliding_joint(line, given, off):
    """Its force is a multiplier that only pushes; that of a rigid one is 1e-5 off at single steps."""
    newton = ancf.Newton(tolerance=1e-12, modified=False)
    method = ancf.GeneralizedAlpha(0.5, formulation="index2", newton=newton)
    settings = RUN | {"contact": "joint", "integrator": method} | given
    done = catenary.run(longer(line, "2-2", 0.0), sensitivities={"a": ["2-2"]}, **settings)
    found = catenary.slopes(done)["a"]

    def numbers(by):
        statistics = catenary.statistics(catenary.run(longer(line, "2-2", by), **settings))
        return np.array([statistics[key].value for key in KEYS[:2]])

    differences = (numbers(4e-6) - numbers(-4e-6)) / 8e-6
    assert np.array([found[key] for key in KEYS[:2]]) == pytest.approx(differences, rel=off)


class TestBadInput:
    @pytest.mark.parametrize(
        ("given", "told"),
        [
            ({"a": ["9-9"]}, "there is no dropper"),
            ({"a": "2-2"}, "must be a list of droppers"),
            ({"a": []}, "must be a list of droppers"),
            ({"a": ["2-2", "2-2"]}, "twice"),
            (["2-2"], "must be a mapping"),
        ],
    )
    @pytest.mark.filterwarnings("ignore::UserWarning")
    def test_parameters(self, line, given, told):
        with pytest.raises(ancf.ModelError, match=told):
            catenary.run(line, mesh=MESH, sensitivities=given, **RUN)

    @pytest.mark.parametrize("integrator", [None, ancf.GeneralizedAlpha(0.5, formulation="ggl")])
    def test_joints_whose_force_has_none_with_ggl(self, line, integrator):
        settings = RUN | {"contact": "joint", "integrator": integrator}
        with pytest.raises(ancf.ModelError, match=r"up to 10 % off.*penalty"):
            catenary.run(line, mesh=MESH, sensitivities={"a": ["2-2"]}, **settings)

    @pytest.mark.filterwarnings("ignore::UserWarning")
    def test_springs_that_the_droppers_relax(self, line):
        settings = RUN | {"pantograph": "benchmark-2015"}
        with pytest.raises(ancf.ModelError, match='relaxed at "mean"'):
            catenary.run(line, mesh=MESH, sensitivities={"a": ["2-2"]}, **settings)
