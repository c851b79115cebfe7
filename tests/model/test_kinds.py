"""Every registered kind of support, load and connection is printed, in files, drawn and asked for."""

import inspect
import json
import re

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study, schema
from ancf.model.kind import SLIDE, body_of
from ancf.model.kinds import GROUPS, all_kinds, kind_of, marked
from ancf.model.touching import bodies_of, to_ground
from ancf.system.system import System
from ancf.viz.export.parts import part_kinds
from ancf.viz.pictures.questions import DEFAULTS, noun_of
from ancf.viz.scene import make_scene
from places import HOWTO

WIRE = {"EA": 1e4, "EI": 0.01, "rhoA": 0.1}
#: One of each kind; a kind that is registered and missing here fails the first test.
SAMPLE = {
    "title": "one of each",
    "gravity": [0.0, 0.0, -9.81],
    "bodies": [
        {"name": "wire", "section": WIRE, "start": [0.0, 0, 0], "end": [4.0, 0, 0], "elements": 4},
        {"name": "tail", "section": WIRE, "start": [4.0, 0, 0], "end": [5.0, 0, 0], "elements": 2},
        {"type": "rigid_body", "name": "hub", "at": [0.0, 0, 0], "mass": 1.0, "inertia": [0.1, 0.1, 0.1]},
        {"type": "rigid_body", "name": "arm", "at": [0.0, 1.0, 0], "mass": 1.0, "inertia": [0.1, 0.1, 0.1]},
        {"type": "point_mass", "name": "bead", "at": [1.5, 0.0, 0.0], "mass": 0.2},
        {"type": "point_mass", "name": "head", "at": [2.5, 0.0, -0.01], "mass": 0.2},
        {"type": "point_mass", "name": "bob", "at": [1.0, 0.0, -1.0], "mass": 0.2},
    ],
    "supports": [
        {"type": "pin", "point": "wire.end"},
        {"type": "clamp", "point": "tail.end", "name": "wall"},
        {"type": "hold", "point": "head", "position": "xy"},
    ],
    "loads": [
        {"type": "force", "point": "tail.at(0.5)", "force": [0.0, "sin(t)", 0.0]},
        {"type": "moment", "point": "arm", "moment": [0.0, 0.0, 0.1]},
        {"type": "distributed", "body": "wire", "load": [0.0, 0.2, 0.0], "between": [1.0, 2.0]},
    ],
    "connections": [
        {"type": "spherical", "a": "wire.at(3)", "b": [3.0, 0.0, 0.0], "name": "ball"},
        {"type": "hinge", "a": "hub.at(0, 0.5, 0)", "b": "arm.at(0, -0.5, 0)", "axis": [1.0, 0, 0]},
        {"type": "fixation", "point": "wire.start", "to": "hub"},
        {"type": "slide", "point": "bead", "along": "wire"},
        {"type": "spring", "a": "bob", "b": "wire.at(1)", "stiffness": 100.0, "slack": True},
        {"type": "contact", "point": "head", "along": "wire", "stiffness": 1e3},
    ],
}
KINDS = [(group, kind.word) for group, kinds in GROUPS.items() for kind in kinds]


@pytest.fixture(scope="module")
def model():
    return parse_study(SAMPLE).model


@pytest.fixture(scope="module")
def state(model):
    system = System(model)
    return ancf.State(system, 0.0, *system.initial_state())


def found(model, group, word):
    """The item of a kind in the sample, with its record."""
    kind = next(kind for kind in GROUPS[group] if kind.word == word)
    return next(item for item in getattr(model, group) if type(item) is kind.item), kind


def test_sample_has_one_of_each():
    for group, kinds in GROUPS.items():
        assert [item["type"] for item in SAMPLE[group]] == [kind.word for kind in kinds]


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


def test_unknown_methods_are_refused(model):
    with pytest.raises(AttributeError, match="add_foce"):
        model.add_foce  # noqa: B018
    assert kind_of(model.supports[0]).word == "pin"
