"""Fluids and grounds of a model: described, printed, in files, and what is wrong with them."""

import json

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.model.file import parse_study, schema
from ancf.system.system import System

SECTION = {"EA": 1e6, "EI": 1.0, "rhoA": 5.0, "diameter": 0.1, "drag": [1.2, 0.1], "added_mass": [1.0, 0.0]}
FLUID = {"name": "water", "density": 1025.0}
GROUND = {"name": "seabed", "height": -10.0, "stiffness": 1e6}


def study(fluids=(), grounds=(), section=None, **more):
    body = {"name": "line", "start": [0, 0, -10], "end": [8, 0, 0], "elements": 4}
    body["section"] = SECTION if section is None else section
    given = {"gravity": [0, 0, -9.81], "bodies": [body], "fluids": list(fluids), "grounds": list(grounds)}
    return given | {"supports": [{"type": "pin", "point": "line.start"}]} | more


WAVE = {"spectrum": "regular", "height": 1.4, "period": 6.0, "direction": 0.2, "depth": 30.0, "ramp": 4.0}
GUSTS = {"speed": 12.0, "deviation": 2.0, "length": 60.0, "extent": [0.0, 40.0], "duration": 20.0, "seed": 3}
SEA = {"spectrum": "jonswap", "height": 2.0, "period": 8.0, "gamma": 2.0, "seed": 4, "components": 9}
WAYS = {
    "at rest": {},
    "constant": {"velocity": [1.0, 0.0, 0.5]},
    "in time": {"velocity": ["sin(t)", 0, 0]},
    "a table in time": {"velocity": {"t": [0, 1], "value": [[0, 0, 0], [1, 0, 0]]}},
    "a profile": {"velocity": {"z": [-10, 0], "velocity": [[0, 0, 0], [1, 0, 0]]}},
    "of the place": {"velocity": ["z*t", "x", 0]},
    "between heights": {"above": -20.0, "below": 0.0},
    "on bodies": {"on": ["line"]},
    "a wave": {"below": 0.0, "waves": WAVE},
    "a sea": {"below": 0.0, "waves": SEA},
    "gusts": {"velocity": [12.0, 0, 0], "gusts": GUSTS},
}
GROUNDS = {
    "level": {},
    "rough": {"damping": 1e4, "friction": 0.3, "stick": 1e5},
    "slope": {"normal": [0.0, 0.1, 1.0]},
    "table": {"height": {"x": [0, 5], "y": [-1, 1], "z": [[-10, -10], [-11, -12]]}, "on": ["line"]},
}


class TestDescriptions:
    @pytest.mark.parametrize("way", WAYS)
    def test_a_fluid_is_read_described_and_made_again(self, way):
        model = parse_study(study(fluids=[FLUID | WAYS[way]])).model
        plain = json.loads(json.dumps(model.to_dict()))
        assert ancf.Model.from_dict(plain).to_dict() == model.to_dict()
        assert plain["fluids"][0]["density"] == 1025.0
        assert "1 fluid" in str(model)
        assert "water" in str(model)
        assert System(model).parts["fluid"].base.shape == (4, 4)

    @pytest.mark.parametrize("way", GROUNDS)
    def test_a_ground_is_read_described_and_made_again(self, way):
        model = parse_study(study(grounds=[GROUND | GROUNDS[way]])).model
        plain = json.loads(json.dumps(model.to_dict()))
        assert ancf.Model.from_dict(plain).to_dict() == model.to_dict()
        assert "1 ground" in str(model)
        assert "seabed" in str(model)
        assert System(model).parts["ground"].base.shape == (4, 4)

    def test_what_a_model_has_not_is_not_there(self):
        model = parse_study(study()).model
        assert model.fluids == model.grounds == []
        assert not {"fluid", "ground"} & set(System(model).parts)
        assert "fluid" not in str(model)

    def test_sections_keep_what_counts_in_a_fluid(self):
        circle = ancf.Section.circle(0.2, E=1e7, rho=1e3, drag=(1, 0.1))
        assert circle.diameter == 0.2
        assert circle.added_mass is None
        for given in (
            SECTION,
            {"shape": "circle", "diameter": 0.2, "E": 1e7, "rho": 1e3, "drag": [1.0, 0.1]},
            {"shape": "rectangle", "width": 0.1, "height": 0.1, "E": 1e7, "rho": 1e3, "diameter": 0.12},
        ):
            model = parse_study(study(section=given)).model
            again = ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))
            assert again.beams["line"].section == model.beams["line"].section
        assert "drag 1.2 normal, 0.1 tangential" in str(parse_study(study()).model.beams["line"].section)

    def test_waves_are_a_table_or_a_method(self):
        model = parse_study(study(fluids=[FLUID | {"below": 0.0, "waves": SEA}])).model
        other = ancf.Model(gravity=(0, 0, -9.81))
        waves = ancf.Waves.jonswap(2.0, 8.0, gamma=2.0, seed=4, components=9)
        other.add_fluid("water", 1025.0, below=0.0, waves=waves)
        assert np.array_equal(other.fluids[0].waves.phase, model.fluids[0].waves.phase)
        assert np.array_equal(other.fluids[0].waves.omega, model.fluids[0].waves.omega)
        assert "jonswap waves of 2 m and 8 s" in str(model)

    def test_a_python_function_is_named_and_missing(self):
        model = parse_study(study()).model

        def tide(t, x, y, z):
            return 0.1 * z, 0.0, 0.0

        model.add_fluid("water", 1025.0, velocity=tide)
        again = ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))
        assert again.missing_functions() == [("water", "tide")]

    def test_masses_keep_their_volume(self):
        model = ancf.Model()
        model.add_point_mass("buoy", at=(0, 0, 0), mass=1.0, volume=0.1, drag_area=0.2, added_mass=0.5)
        model.add_rigid_body("hull", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1), volume=2.0)
        again = ancf.Model.from_dict(model.to_dict())
        assert again.to_dict() == model.to_dict()
        assert again.masses["buoy"].drag_area == 0.2
        assert again.rigid_bodies["hull"].volume == 2.0

    def test_schema_has_both(self):
        given = schema()
        assert {"fluids", "grounds"} <= set(given["properties"])
        for name in ("FluidEntry", "GroundEntry"):
            assert all("description" in field for field in given["$defs"][name]["properties"].values())


WRONG_WAVES = [
    (3.0, "", "must be ancf.Waves or a table"),
    ({"height": 1, "period": 5}, ".spectrum", "must be one of"),
    (SEA | {"spectrum": "jonswop"}, ".spectrum", '"jonswap"'),
    ({"spectrum": "regular", "period": 5}, ".height", "is missing"),
    (WAVE | {"gamma": 2}, ".gamma", "no meaning"),
    (WAVE | {"height": -1.0}, ".height", "> 0"),
    (SEA | {"gamma": 0.5}, ".gamma", "at least 1"),
    (SEA | {"components": 0}, ".components", "between 1 and 2000"),
    (SEA | {"seed": 1.5}, ".seed", "whole number"),
    (WAVE | {"period": "5"}, ".period", "number"),
    (WAVE | {"height": 9.0}, ".height", "breaks at 7.9"),
    (WAVE | {"height": 2, "period": 9, "depth": 2}, ".height", "in 2 m of water"),
    (WAVE | {"depth": 0}, ".depth", "> 0"),
    (WAVE | {"stretching": "x"}, ".stretching", "one of"),
]
WRONG = {
    "no density": ({"fluids": [FLUID | {"density": 0.0}]}, "fluids[0].density", "> 0"),
    "velocity of two": ({"fluids": [FLUID | {"velocity": [1, 2]}]}, "fluids[0].velocity", "3"),
    "unknown name": (
        {"fluids": [FLUID | {"velocity": ["q", 0, 0]}]},
        "fluids[0].velocity[0]",
        "unknown name",
    ),
    "profile that falls": (
        {"fluids": [FLUID | {"velocity": {"z": [0, -1], "velocity": [[0, 0, 0]] * 2}}]},
        "fluids[0].velocity.z[1]",
        "increasing",
    ),
    "profile of other length": (
        {"fluids": [FLUID | {"velocity": {"z": [0, 1], "velocity": [[0, 0, 0]]}}]},
        "fluids[0].velocity.velocity",
        "1 values for 2 heights",
    ),
    "upside down": ({"fluids": [FLUID | {"above": 1.0, "below": 0.0}]}, "fluids[0].above", "below"),
    "two in one place": (
        {"fluids": [FLUID | {"below": 0.0}, {"name": "oil", "density": 800.0, "above": -1.0}]},
        "fluids[1]",
        "between z = -1 and 0 m",
    ),
    **{
        f"waves: {what}": (
            {"fluids": [FLUID | {"below": 0.0, "waves": given}]},
            f"fluids[0].waves{where}",
            what,
        )
        for given, where, what in WRONG_WAVES
    },
    "waves without a surface": ({"fluids": [FLUID | {"waves": WAVE}]}, "fluids[0].waves", "need a surface"),
    **{
        f"waves under gravity {g}": (
            {"fluids": [FLUID | {"below": 0.0, "waves": WAVE}], "gravity": g},
            "fluids[0].waves",
            "gravity along -z",
        )
        for g in ([0.0, 0.0, 0.0], [0.0, 0.0, 9.81], [1.0, 0.0, -9.81])
    },
    "unknown body": ({"fluids": [FLUID | {"on": ["lime"]}]}, "fluids[0].on[0]", "line"),
    "soft": ({"grounds": [GROUND | {"stiffness": 0.0}]}, "grounds[0].stiffness", "> 0"),
    "hanging": ({"grounds": [GROUND | {"normal": [0, 0, -1.0]}]}, "grounds[0].normal", "point up"),
    "heights of other shape": (
        {"grounds": [GROUND | {"height": {"x": [0, 1], "y": [0, 1], "z": [[1, 2]]}}]},
        "grounds[0].height.z",
        "",
    ),
}


class TestWrong:
    @pytest.mark.parametrize("case", WRONG)
    def test_is_refused_with_its_place(self, case):
        given, where, what = WRONG[case]
        with pytest.raises(ModelError) as caught:
            parse_study(study(**given))
        assert caught.value.where == where
        assert what in str(caught.value)

    @pytest.mark.parametrize(
        ("lacking", "given"),
        [("drag", {"diameter": 0.1}), ("diameter and no drag", {})],
        ids=["drag", "both"],
    )
    def test_a_section_without_data_is_named(self, lacking, given):
        section = {"EA": 1e6, "EI": 1.0, "rhoA": 5.0} | given
        model = parse_study(study(fluids=[FLUID], section=section)).model
        with pytest.raises(ModelError, match=f'"line".*no {lacking}.*"water"'):
            System(model)
        model = parse_study(study(fluids=[FLUID | {"on": ["line"]}], section=section)).model
        with pytest.raises(ModelError, match=lacking):
            ancf.simulate(model, t_end=0.1, step=0.1)

    def test_a_bottom_above_the_anchor(self):
        model = parse_study(study(grounds=[GROUND | {"height": -9.0}])).model
        with pytest.raises(ModelError, match=r"1 m below the ground \"seabed\""):
            System(model)

    def test_waves_of_less_water_than_there_is(self):
        """The anchor would be below their bottom; a chain that has sunk in a little is not."""
        for depth, fits in ((6.0, False), (9.95, True), (30.0, True)):
            model = parse_study(
                study(fluids=[FLUID | {"below": 0.0, "waves": WAVE | {"depth": depth}}])
            ).model
            if fits:
                System(model)
                continue
            with pytest.raises(
                ModelError, match=r'water of 6 m depth, and "line" starts 10 m below'
            ) as caught:
                System(model)
            assert caught.value.where == "water.waves"

    @pytest.mark.parametrize(
        ("law", "what"),
        [
            (lambda t, x, y, z: (1.0, 2.0), "three numbers"),
            (lambda t, x, y, z: (np.nan, 0.0, 0.0), "finite"),
            (lambda t, x, y, z: 1 / 0, "ZeroDivisionError"),
        ],
        ids=["shape", "nan", "raises"],
    )
    def test_a_function_that_is_wrong(self, law, what):
        model = parse_study(study()).model
        with pytest.raises(ModelError, match=what) as caught:
            model.add_fluid("water", 1025.0, velocity=law)
        assert caught.value.where == 'add_fluid("water").velocity'

    @pytest.mark.parametrize("key", ["drag", "added_mass"])
    def test_coefficients(self, key):
        for value, where in (((-1.0, 0.0), f"Section.{key}[0]"), ((1.0,), f"Section.{key}")):
            with pytest.raises(ModelError) as caught:
                ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, **{key: value})
            assert caught.value.where == where
