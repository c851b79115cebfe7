"""Every registered kind of support, load and connection is printed, in files, drawn and asked for."""

import functools
import inspect
import json
import re

import numpy as np
import pytest

import ancf
from ancf.model.bodies.beam import Beam
from ancf.model.elements import KINDS as ELEMENTS
from ancf.model.file import parse_study, schema
from ancf.model.integrators import INTEGRATORS
from ancf.model.joints.touching import bodies_of, to_ground
from ancf.model.kind import SLIDE, body_of
from ancf.model.kinds import GROUPS, all_kinds, by_word, kind_of, marked
from ancf.system.system import System
from ancf.viz.export.parts import part_kinds
from ancf.viz.pictures.questions import DEFAULTS, noun_of
from ancf.viz.scene import make_scene
from places import HOWTO
from registered import SECTION, study_with
from shown import shown

KINDS = [(group, kind.word) for group, kinds in GROUPS.items() for kind in kinds]


@functools.cache
def study(group, word):
    return study_with(group, by_word(group)[word])


@functools.cache
def model_of(group, word):
    return parse_study(study(group, word)).model


@pytest.fixture
def model(group, word):
    return model_of(group, word)


@pytest.fixture
def state(model):
    system = System(model)
    return ancf.State(system, 0.0, *system.initial_state())


def found(model, group, word):
    """The item of a kind in the sample, with its record."""
    kind = next(kind for kind in GROUPS[group] if kind.word == word)
    return next(item for item in getattr(model, group) if type(item) is kind.item), kind


def test_words_types_and_nouns_are_unique():
    for names in (
        [k.item for k in all_kinds()],
        [k.noun for k in all_kinds()],
        [k.word for k in all_kinds()],
    ):
        assert len(set(names)) == len(names)


@pytest.mark.parametrize(("group", "word"), KINDS)
class TestKind:
    def test_has_a_method(self, model, group, word):
        _, kind = found(model, group, word)
        assert callable(getattr(model, kind.method))
        assert kind.method in dir(model)

    def test_is_printed(self, model, group, word):
        item, kind = found(model, group, word)
        printed = str(model)
        assert item.name in printed
        assert kind.noun in printed

    def test_is_described(self, model, group, word):
        item, _ = found(model, group, word)
        plain = json.loads(json.dumps(model.to_dict()))[group]
        assert [p["type"] for p in plain if p["name"] == item.name] == [word]

    def test_is_made_again_from_its_description(self, model, group, word):
        item, kind = found(model, group, word)
        again = ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))
        twin = next(other for other in getattr(again, group) if other.name == item.name)
        assert type(twin) is kind.item
        assert again.to_dict() == model.to_dict()
        plain = next(p for p in model.to_dict()[group] if p["name"] == item.name)
        assert set(plain) - {"type"} <= set(inspect.signature(getattr(model, kind.method)).parameters)
        assert {*(kind.keys or kind.ends), "name", "type"} <= set(plain)

    def test_has_a_table_in_files(self, model, group, word):
        _, kind = found(model, group, word)
        entry = kind.entry()
        assert entry.__name__ in schema()["$defs"]
        assert set(kind.keys or kind.ends) <= set(entry.model_fields)

    def test_its_ends_are_found(self, model, group, word):
        item, kind = found(model, group, word)
        ends = kind.ends_of(item)
        bodies = [body for end in ends if (body := body_of(end)) is not None]
        assert all(model.bodies[body.name] is body for body in bodies)
        assert len(bodies) >= len(ends) - 1
        if group == "connections":
            assert bodies_of(item) == [body.name for body in bodies]
            assert to_ground(item) == (len(bodies) < len(ends))

    def test_is_drawn_at_its_first_end(self, model, state, group, word):
        item, kind = found(model, group, word)
        markers = {marker.name: marker for marker in make_scene(state).markers}
        assert (kind.look is not None) == (item.name in markers)
        if kind.look is not None:
            marker = markers[item.name]
            assert marker.kind == word
            np.testing.assert_allclose(marker.position[0], state.position(kind.ends_of(item)[0]), atol=1e-12)
            assert word in marked()
            assert word in part_kinds()

    def test_results_answer_for_connections(self, model, state, group, word):
        item, kind = found(model, group, word)
        if group == "connections":
            assert noun_of(state, item) == kind.asked
            assert kind.asked in DEFAULTS
            assert kind.constrains == (bool(kind.rows) or kind.asked == SLIDE)
            assert model.sensor(item.name) is item

    def test_is_documented(self, model, group, word):
        _, kind = found(model, group, word)
        text = "".join(page.read_text(encoding="utf-8") for page in HOWTO.glob("*.md"))
        assert re.search(rf'[`"]{word}[`"]', text)
        assert f"{kind.method}(" in text


class TestEverything:
    """What is registered is printed, written, read, drawn, exported and sampled; nothing is listed here."""

    @pytest.mark.parametrize(("group", "word"), KINDS)
    def test_kind(self, group, word, tmp_path):
        model = model_of(group, word)
        item, kind = found(model, group, word)
        asked = item if group == "connections" else kind.ends_of(item)[0]
        asked = asked.at(0.5) if isinstance(asked, Beam) else asked
        seen = shown(model, tmp_path, sensors=[asked])
        assert kind.noun in seen["printed"][0]
        assert seen["described"][group][0]["type"] == word
        assert model_of(group, word).to_dict() == ancf.Model.from_dict(seen["described"]).to_dict()
        assert (kind.look is not None) <= (word in seen["legend"])
        assert kind.push is None or kind.noun in seen["legend"]
        assert (kind.look is not None) == (seen["markers"].get(item.name) == word)
        assert item.name in seen["drawn"]
        assert item.name in [name for name, _ in seen["parts"]]
        assert any(name.startswith(str(getattr(asked, "name", asked))) for name in seen["columns"])

    @pytest.mark.parametrize("name", ELEMENTS)
    def test_element(self, name, tmp_path):
        for strain in ELEMENTS[name].strains:
            bodies = [{"name": "body", "element": name, "strain": strain, "section": SECTION, "elements": 2}]
            bodies[0] |= {"start": [0.0, 0, 0], "end": [1.0, 0, 0]}
            model = parse_study({"gravity": [0.0, 0, -9.81], "bodies": bodies}).model
            (tmp_path / strain).mkdir()
            seen = shown(model, tmp_path / strain, sensors=["body.at(0.5)"])
            assert name in seen["printed"][0]
            assert seen["described"]["bodies"][0]["element"] == name
            assert seen["traces"] == {"body": name}
            assert ["body", name] in seen["parts"]
            assert (["body", "surface"] in seen["parts"]) == ELEMENTS[name].has_section
            assert seen["sensors"] == ["body.at(0.5)"]

    @pytest.mark.parametrize("name", INTEGRATORS)
    def test_integrator(self, name, tmp_path):
        bodies = [{"type": "point_mass", "name": "bob", "at": [0.0, 0, 0], "mass": 1.0}]
        plain = {"gravity": [0.0, 0, -9.81], "bodies": bodies}
        plain["simulation"] = {"t_end": 0.02, "step": 0.01, "integrator": {"type": name}}
        read = parse_study(plain)
        method = read.simulation.integrator
        assert type(method) is INTEGRATORS[name]
        seen = shown(read.model, tmp_path, integrator=method, t_end=0.02, step=0.01, sensors=["bob"])
        assert seen["settings"]["integrator"] == name
        assert name.replace("_", " ") in seen["printed"][1].replace("-", " ")
        assert seen["markers"] == {"bob": "point mass"}
        end = ancf.load(tmp_path / "run.h5").position("bob")[-1]
        assert end == pytest.approx([0.0, 0.0, -0.5 * 9.81 * 0.02**2], rel=1e-9)


def test_each_kind_has_a_method_that_editors_see():
    """Completion and type checkers read the class, not what a name is looked up in while a program runs."""
    for kind in all_kinds():
        assert callable(getattr(ancf.Model, kind.method)), kind.word


def test_unknown_methods_are_refused():
    model = model_of("supports", "pin")
    with pytest.raises(AttributeError, match="add_foce"):
        model.add_foce  # noqa: B018
    assert kind_of(model.supports[0]).word == "pin"
