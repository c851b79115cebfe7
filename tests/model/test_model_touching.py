"""Contacts of cables and of bodies: what is given, files, tables, messages."""

import json

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study
from ancf.system.system import System

SECTION = {"EA": 1e4, "EI": 0.01, "rhoA": 0.5, "diameter": 0.02}
FILE = {
    "bodies": [
        {"name": "rope", "start": [0, 0, 0], "end": [2, 0, 0], "elements": 4, "section": "s"},
        {"name": "line", "start": [0, 0.3, 0], "end": [2, 0.3, 0], "elements": 3, "section": "s"},
        {"type": "rigid_body", "name": "hub", "at": [0, 0, -1], "mass": 1.0, "inertia": [1, 1, 1]},
    ],
    "sections": {"s": SECTION},
    "surfaces": [
        {"name": "skin", "shape": "sphere", "radius": 0.1, "on": "hub"},
        {"name": "floor", "shape": "plane", "at": [0, 0, -2]},
        {"name": "drum", "shape": "cylinder", "radius": 0.1, "at": [0, 0, -3], "axis": [0, 1, 0]},
    ],
}


def stage(section=SECTION, apart=0.3):
    model = ancf.Model()
    for k, name in enumerate(("rope", "line")):
        place = {"start": (0, k * apart, 0), "end": (2, k * apart, 0)}
        model.add_beam(name, **place, elements=4 - k, section=ancf.Section(**section))
    model.add_rigid_body("hub", at=(0, 0, -1), mass=1.0, inertia=(1, 1, 1))
    model.add_surface("skin", "sphere", radius=0.1, on="hub")
    model.add_surface("floor", "plane", at=(0, 0, -2))
    model.add_surface("drum", "cylinder", radius=0.1, at=(0, 0, -3), axis=(0, 1, 0))
    return model


@pytest.mark.parametrize(
    ("ends", "keys", "word", "name"),
    [
        (("rope", "line"), ("body", "other"), "cable_contact", "contact of rope and line"),
        (("rope", "rope"), ("body", "other"), "cable_contact", "contact of rope and itself"),
        (("skin", "floor"), ("surface", "other"), "body_contact", "contact of skin and floor"),
        (("drum", "skin"), ("surface", "other"), "body_contact", "contact of drum and skin"),
    ],
)
def test_one_noun_in_python_and_in_files(ends, keys, word, name):
    given = {"stiffness": 1e5, "damping": 10.0, "friction": 0.3, "stick": 2e5}
    model = stage()
    item = model.add_contact(*ends, **given)
    assert item.name == name
    same = parse_study(
        FILE | {"connections": [{"type": word, **dict(zip(keys, ends, strict=True)), **given}]}
    ).model
    plain = json.loads(json.dumps(model.to_dict()))
    assert plain["connections"] == json.loads(json.dumps(same.to_dict()))["connections"]
    assert ancf.Model.from_dict(plain).to_dict() == plain
    shown = str(model)
    assert ("itself" in shown) == (ends == ("rope", "rope"))
    assert "0.3" in shown
    assert len(System(model).measures[name]) == 4


class TestRefused:
    @pytest.mark.parametrize(
        ("ends", "given", "says"),
        [
            (("rope", "line"), {"stiffness": 0.0}, "stiffness"),
            (("rope", "line"), {"friction": -0.1}, "friction"),
            (("rope", "rope"), {"damping": -1.0}, "damping"),
            (("rope", "line"), {"strip": (0, 1, 0)}, "has no effect on a contact of cables"),
            (("skin", "floor"), {"friction": -0.1}, "friction"),
            (("skin", "floor"), {"radius": 0.1}, "has no effect on a contact of bodies"),
            (("drum", "floor"), {}, "both are on the ground"),
            (("skin", "skin"), {}, 'both are on "hub"'),
        ],
    )
    def test_wrong_numbers_and_ends(self, ends, given, says):
        with pytest.raises(ancf.ModelError, match=says):
            stage().add_contact(*ends, **({"stiffness": 1e5} | given))

    def test_without_a_diameter(self):
        thin = {key: value for key, value in SECTION.items() if key != "diameter"}
        model = stage(thin)
        with pytest.raises(ancf.ModelError, match='the section of "rope" has no diameter'):
            model.add_contact("rope", "rope", stiffness=1e5)
        assert model.add_contact("rope", "rope", stiffness=1e5, radius=0.01).radius == 0.01

    def test_closed(self):
        model = stage()
        a = np.linspace(0, 2 * np.pi, 41)
        path = np.stack([np.cos(a), np.sin(a), 0 * a + 5.0], axis=1)
        path[-1] = path[0]
        section = ancf.Section(**SECTION)
        model.add_beam("belt", path=path, elements=12, section=section, closed=True)
        with pytest.raises(ancf.ModelError, match='"belt" is closed'):
            model.add_contact("rope", "belt", stiffness=1e5)

    def test_twice(self):
        model = stage()
        model.add_contact("rope", "line", stiffness=1e5)
        with pytest.raises(ancf.ModelError, match='between "line" and "rope" already'):
            model.add_contact("line", "rope", stiffness=1e5)
        model.add_contact("skin", "floor", stiffness=1e5)
        with pytest.raises(ancf.ModelError, match='between "floor" and "skin" already'):
            model.add_contact("floor", "skin", stiffness=1e5)

    def test_shapes_without_a_law(self):
        model = stage()
        model.add_rigid_body("arm", at=(0, 0, 1), mass=1.0, inertia=(1, 1, 1))
        model.add_surface("tube", "cylinder", radius=0.1, on="arm")
        with pytest.raises(ancf.ModelError, match="a cylinder and a plane cannot touch"):
            model.add_contact("tube", "floor", stiffness=1e5)

    @pytest.mark.parametrize(
        ("apart", "sunk"), [(0.009, True), (0.0145, True), (0.0155, False), (0.02, False)]
    )
    def test_cables_in_each_other(self, apart, sunk):
        model = stage(apart=apart)
        model.add_contact("rope", "line", stiffness=1e5)
        if not sunk:
            assert System(model).n > 0
            return
        with pytest.raises(
            ancf.ModelError, match=r'"rope" at about x = .* m is 0\.0\d+ m inside "line"'
        ) as said:
            System(model)
        assert "at least 0.02 m" in str(said.value)
        assert f"is {0.02 - apart:.4g} m inside" in str(said.value)

    def test_a_cable_in_itself(self):
        a = np.linspace(0, 3 * np.pi, 200)
        path = np.stack([0.2 * np.cos(a), 0.2 * np.sin(a), 0.001 * a], axis=1)
        model = ancf.Model()
        model.add_beam("coil", path=path, elements=30, section=ancf.Section(**SECTION))
        model.add_contact("coil", "coil", stiffness=1e5)
        with pytest.raises(ancf.ModelError, match=r'"coil" at about x = .* inside "coil"'):
            System(model)

    def test_bodies_in_each_other(self):
        model = stage()
        model.add_rigid_body("arm", at=(0, 0, -1.14), mass=1.0, inertia=(1, 1, 1))
        model.add_surface("knob", "sphere", radius=0.1, on="arm")
        model.add_contact("skin", "knob", stiffness=1e5)
        with pytest.raises(ancf.ModelError, match=r'"skin" is 0\.06 m inside "knob"'):
            System(model)
