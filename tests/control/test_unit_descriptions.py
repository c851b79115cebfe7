"""What the description of an exported unit tells a master: units, words, steps, who made it."""

import json
import math
import re
import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest

from ancf.cosimulation.fmu import export_fmu
from ancf.cosimulation.outputs import SAID, Output
from ancf.cosimulation.units import BASE, base_unit
from ancf.model.file import read_study
from files_of_units import HOIST, MODEL, TOUCHING

fmpy = pytest.importorskip("fmpy")
validation = pytest.importorskip("fmpy.validation")

FILES = {"pulled": MODEL, "hoist": HOIST, "touching": TOUCHING}
#: Units and what they are in SI units: factor, then exponents.
KNOWN = {
    "m": (1.0, {"m": 1}),
    "m/s": (1.0, {"m": 1, "s": -1}),
    "m/s^2": (1.0, {"m": 1, "s": -2}),
    "m/s2": (1.0, {"m": 1, "s": -2}),
    "m/s\u00b2": (1.0, {"m": 1, "s": -2}),
    "m s^-1": (1.0, {"m": 1, "s": -1}),
    "km/h": (1 / 3.6, {"m": 1, "s": -1}),
    "N m": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "N*m": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "kNm": (1e3, {"kg": 1, "m": 2, "s": -2}),
    "N/m": (1.0, {"kg": 1, "s": -2}),
    "N s/m": (1.0, {"kg": 1, "s": -1}),
    "kN": (1e3, {"kg": 1, "m": 1, "s": -2}),
    "MPa": (1e6, {"kg": 1, "m": -1, "s": -2}),
    "N/mm2": (1e6, {"kg": 1, "m": -1, "s": -2}),
    "kg/m^3": (1.0, {"kg": 1, "m": -3}),
    "kW": (1e3, {"kg": 1, "m": 2, "s": -3}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "mm": (1e-3, {"m": 1}),
    "rad/s": (1.0, {"rad": 1, "s": -1}),
    "deg": (math.pi / 180, {"rad": 1}),
    "rpm": (2 * math.pi / 60, {"rad": 1, "s": -1}),
    "1/min": (1 / 60, {"s": -1}),
    "Hz": (1.0, {"s": -1}),
    "%": (0.01, {}),
    "1": (1.0, {}),
}


@pytest.mark.parametrize("text", KNOWN)
def test_units_in_si(text):
    found = base_unit(text)
    factor, exponents = KNOWN[text]
    assert found.factor == pytest.approx(factor, rel=1e-12)
    assert found.exponents == exponents


@pytest.mark.parametrize("one", ["kN", "km/h", "deg", "mm2", "kg/m^3"])
@pytest.mark.parametrize("other", ["s", "1/s", "N m", "%"])
def test_products(one, other):
    """Sizes multiply and exponents add, in whatever order."""
    a, b = base_unit(one), base_unit(other)
    head, _, tail = other.partition("/")
    text = f"{one} {head}/{tail}" if tail else f"{other} {one}"
    both = base_unit(text)
    assert both.factor == pytest.approx(a.factor * b.factor, rel=1e-12)
    for name in BASE:
        wanted = a.exponents.get(name, 0) + b.exponents.get(name, 0)
        assert both.exponents.get(name, 0) == wanted


@pytest.mark.parametrize("text", ["turns", "m//s", "furlong/h", "N^x", "m^", "", "/s/", "kkN", "kg m oops"])
def test_others_are_names_alone(text):
    assert base_unit(text) is None


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    folder = tmp_path_factory.mktemp("described")
    for name, text in FILES.items():
        (folder / f"{name}.toml").write_text(text, "utf-8")
        for version in ("2.0", "3.0"):
            export_fmu(folder / f"{name}.toml", folder / f"{name}{version[0]}.fmu", version)
    return folder


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", FILES)
class TestDescription:
    def test_every_variable_has_unit_and_words(self, exported, name, version):
        file = exported / f"{name}{version}.fmu"
        assert validation.validate_fmu(str(file)) == []
        found = fmpy.read_model_description(str(file), validate=True)
        defined = {unit.name: unit.baseUnit for unit in found.unitDefinitions}
        study = read_study(exported / f"{name}.toml")
        for variable in found.modelVariables:
            assert len(variable.description) > 3
            assert "{" not in variable.description
            if variable.causality == "input":
                wanted = study.model.inputs[variable.name].unit or None
                assert variable.unit == wanted
            else:
                assert defined[variable.unit] is not None
        assert {v.unit for v in found.modelVariables if v.unit} == defined.keys()

    def test_exponents_are_those_of_the_quantity(self, exported, name, version):
        """By names of the outputs, not by the table of units."""
        found = fmpy.read_model_description(str(exported / f"{name}{version}.fmu"))
        bases = {unit.name: unit.baseUnit for unit in found.unitDefinitions}
        ends = {"position": (0, 1, 0), "velocity": (0, 1, -1), "force": (1, 1, -2), "tension": (1, 1, -2)}
        ends |= {"length": (0, 1, 0), "gap": (0, 1, 0), "moment": (1, 2, -2), "reaction": (1, 1, -2)}
        seen = 0
        for variable in found.modelVariables:
            words = [part.rpartition("_")[2] for part in variable.name.split(".")[-2:]]
            for word in (w for w in words if w in ends):
                base = bases[variable.unit]
                assert (base.kg, base.m, base.s) == ends[word]
                seen += 1
        assert seen > 3

    def test_who_made_it_and_how_it_is_stepped(self, exported, name, version):
        found = fmpy.read_model_description(str(exported / f"{name}{version}.fmu"))
        study = read_study(exported / f"{name}.toml")
        assert found.generationTool.startswith("ancf ")
        assert found.modelName == study.title or not study.title
        assert found.coSimulation.modelIdentifier == name.capitalize() + str(version)
        assert found.description == (study.title or name.capitalize() + str(version)).replace('"', " ")
        span, settings = found.defaultExperiment, study.simulation
        assert float(span.stopTime) == settings.t_end
        assert float(span.stepSize) == (settings.output_step or settings.step)
        assert found.coSimulation.canHandleVariableCommunicationStepSize
        with zipfile.ZipFile(exported / f"{name}{version}.fmu") as unit:
            root = ElementTree.fromstring(unit.read("modelDescription.xml"))
        outputs = len([v for v in found.modelVariables if v.causality == "output"])
        unknowns = "InitialUnknowns/Unknown" if version == 2 else "InitialUnknown"
        assert len(root.findall(f"ModelStructure/{unknowns}")) == outputs


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("title", ["Kran 7", 'a "short" rope', "wind < 5 & more", "  Seil über\tRolle ", ""])
def test_title_is_the_name(tmp_path, title, version):
    """That of the file is the identifier alone, by which a master finds the library."""
    text = f"title = {json.dumps(title)}\n" + re.sub(r"(?m)^title = .*$", "", MODEL)
    (tmp_path / "model.toml").write_text(text, encoding="utf-8")
    export_fmu(tmp_path / "model.toml", tmp_path / "crane-2.fmu", version)
    found = fmpy.read_model_description(str(tmp_path / "crane-2.fmu"))
    assert found.modelName == (" ".join(title.split()) or "Crane_2")
    assert found.coSimulation.modelIdentifier == "Crane_2"


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("every", [0, 1, 5, 20])
def test_a_master_is_told_the_steps_at_which_states_are_stored(tmp_path, every, version):
    """Those of the method where the file gives no others."""
    wanted = f"step = 1e-3\noutput_step = {1e-3 * every!r}" if every else "step = 1e-3"
    (tmp_path / "model.toml").write_text(MODEL.replace("step = 1e-3", wanted), encoding="utf-8")
    export_fmu(tmp_path / "model.toml", tmp_path / "unit.fmu", version)
    found = fmpy.read_model_description(str(tmp_path / "unit.fmu"))
    assert float(found.defaultExperiment.stepSize) == pytest.approx(1e-3 * max(every, 1), rel=1e-12)


#: Units of an input, with what one of them is in SI units.
SIZES = {"kN": 1e3, "mm": 1e-3, "km/h": 1 / 3.6, "deg": math.pi / 180, "rpm": math.pi / 30, "bar": 1e5}


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_units_of_inputs_have_their_sizes(tmp_path, version):
    """A master multiplies by the factor to come to SI units."""
    inputs = "".join(f'[[inputs]]\nname = "u{k}"\nunit = "{unit}"\n' for k, unit in enumerate(SIZES))
    (tmp_path / "model.toml").write_text(
        MODEL.replace("[[bodies]]", f"{inputs}[[bodies]]", 1), encoding="utf-8"
    )
    export_fmu(tmp_path / "model.toml", tmp_path / "unit.fmu", version)
    found = fmpy.read_model_description(str(tmp_path / "unit.fmu"))
    factors = {unit.name: float(unit.baseUnit.factor or 1.0) for unit in found.unitDefinitions}
    assert {name: factors[name] for name in SIZES} == pytest.approx(SIZES, rel=1e-12)
    assert factors["N"] == 1.0


@pytest.mark.parametrize("question", SAID)
def test_words_of_every_question(question):
    said = [Output("name", question, "thing", part, "m").said for part in range(2)]
    assert all("thing" in text for text in said)
    assert len(np.unique(said)) == (2 if "{part}" in SAID[question] else 1)
