"""A number changed by its name gives the model that is built with it: what follows from it goes along."""

import pytest

import ancf
from ancf.model.vary import renewal, value_of, varied

SIZES = [1e-3, 0.02, 3.0]
#: Numbers of sections of about 1 m, and to which power of the size they go.
NUMBERS = {
    "rectangle": {"width": (0.9, 1), "height": (0.6, 1)},
    "circle": {"diameter": (0.8, 1)},
    "from_moments": {"A": (0.5, 2), "I_y": (0.015, 4), "I_z": (0.04, 4), "J": (0.03, 4)},
}
#: What may be given, and else follows from these.
GIVEN = {
    "rectangle": {"J": (0.011, 4)},
    "circle": {"J": (0.011, 4)},
    "from_moments": {"I_yyyy": (0.02, 6), "I_zzzz": (0.003, 6), "I_yyzz": (0.0013, 6)},
}


def sized(numbers, size):
    return {key: value * size**power for key, (value, power) in numbers.items()}


def built(kind, numbers, size):
    """A beam and two drums, of which it touches the first with the radius of its section."""
    given = {"drag": (1.0, 0.1), "added_mass": (1.0, 0.0)}
    wide = {} if kind == "circle" else {"diameter": 0.7 * size}
    section = getattr(ancf.Section, kind)(E=2e9, rho=900.0, nu=0.3, **numbers, **given, **wide)
    model = ancf.Model(gravity=(0, 0, -9.81))
    ends = {"start": (0, 0, 0), "end": (20, 0, 0)}
    beam = model.add_beam("beam", **ends, elements=2, section=section, element="nonlocking")
    model.clamp(beam.start)
    for name, radius in (("own", None), ("given", 0.123)):
        drum = model.add_surface(f"drum {name}", ancf.Cylinder(radius=4.0, at=(5, 0, -9), axis=(0, 1, 0)))
        model.add_contact(beam, drum, stiffness=1e6, radius=radius, name=name)
    return model


def same(one, other):
    """Two descriptions, numbers to round-off."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(same, one, other))
    return one == pytest.approx(other, rel=1e-13, abs=0.0) if isinstance(one, float) else one == other


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("given", [False, True], ids=["follows", "given"])
@pytest.mark.parametrize(("kind", "key"), [(kind, key) for kind in NUMBERS for key in NUMBERS[kind]])
def test_sections(kind, key, given, size):
    """Constants given for themselves stay, however small; below 1e-8 they were lost."""
    numbers = sized(NUMBERS[kind] | (GIVEN[kind] if given else {}), size)
    model, name = built(kind, numbers, size), f"beam.{key}"
    for factor in (0.98, 1.03):
        changed = numbers | {key: factor * numbers[key]}
        other = built(kind, changed, size).to_dict()
        assert value_of(model, name) == numbers[key]
        for made in (varied(model, name, changed[key]), renewal(model, name)[1](changed[key])):
            assert same(made.to_dict(), other)


@pytest.mark.parametrize("factor", [0.6, 0.9, 1.5, 2.0])
@pytest.mark.parametrize("key", ["A", "I_y", "I_z"])
def test_moments_that_change_by_much(key, factor):
    """Fourth moments that nobody gave were refused."""
    numbers = sized(NUMBERS["from_moments"], 0.05)
    made = varied(built("from_moments", numbers, 0.05), f"beam.{key}", factor * numbers[key])
    assert value_of(made, f"beam.{key}") == factor * numbers[key]


def rope(diameter, radius=None, friction=0.0):
    """A rope between two pins, over a drum."""
    model = ancf.Model(gravity=(0.5, 0.2, -9.81))
    section = ancf.Section(EA=2e3, EI=0.02, rhoA=0.3, diameter=diameter)
    ends = {"start": (-0.5, 0, 0.215), "end": (0.5, 0, 0.215)}
    line = model.add_beam("line", **ends, elements=4, section=section)
    model.pin(line.start)
    model.pin(line.end)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0.1, 1, 0)))
    model.add_contact(line, drum, stiffness=2e4, friction=friction, radius=radius, name="touch")
    return model


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("radius", [None, 0.012])
def test_a_thicker_rope_on_a_drum(radius, friction):
    """It is tighter by that, unless it has a radius of its own: derivatives and differences."""
    state = ancf.equilibrium(rope(0.02, radius, friction), sensitivities=["line.diameter"])
    found = float(state.sensitivity("line.diameter").tension("line.start"))
    h = 1e-5
    low, high = (ancf.equilibrium(rope(0.02 + x, radius, friction)).tension("line.start") for x in (-h, h))
    wanted = float(high - low) / (2 * h)
    assert found == pytest.approx(wanted, rel=1e-5, abs=1e-6)
    assert (abs(wanted) > 10.0) == (radius is None)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_gradient_by_the_diameter(friction):
    run, text = {"t_end": 0.06, "step": 1e-3}, "mean(tension(line.start))"
    slope = ancf.gradient(rope(0.02, None, friction), text, ["line.diameter"], **run)[1]["line.diameter"]
    h = 1e-5
    low, high = (ancf.gradient(rope(0.02 + x, None, friction), text, [], **run)[0] for x in (-h, h))
    assert slope == pytest.approx((high - low) / (2 * h), rel=1e-4)


@pytest.mark.parametrize("J", [3e-10, None])
def test_twist_by_the_width(J):
    """Of a flat bar: T L/(G J), which goes with the width only as far as J does."""

    def bar(width):
        model = ancf.Model()
        section = ancf.Section.rectangle(width, 0.008, E=1e9, rho=900.0, nu=0.3, J=J)
        ends = {"start": (0, 0, 0), "end": (1, 0, 0)}
        beam = model.add_beam("bar", **ends, elements=2, section=section, element="nonlocking")
        model.clamp(beam.start)
        model.add_moment(beam.end, (2e-3, 0, 0))
        return model

    own = ancf.equilibrium(bar(0.012), sensitivities=["bar.width"])
    found = float(own.sensitivity("bar.width").twist("bar.end"))
    h = 1e-6
    low, high = (float(ancf.equilibrium(bar(0.012 + x)).twist("bar.end")) for x in (-h, h))
    assert found == pytest.approx((high - low) / (2 * h), rel=1e-4, abs=1e-5)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("hub.inertia[0][1]", "factor of the whole"),
        ("drum.radius", 'no number "radius" \\(a function that builds'),
        ("law.force", "is no number \\(a function that builds"),
        ("floor.normal[0]", "it has: height, stiffness, damping, friction; of others"),
    ],
)
def test_what_has_no_name_is_said_plainly(name, told):
    model = rope(0.02)
    model.add_rigid_body("hub", at=(0, 1, 0), mass=1.0, inertia=(1.0, 1.0, 1.0))
    model.add_force("hub", lambda t, r, v: -v, name="law")
    model.add_ground("floor", height=-1.0, stiffness=1e3)
    with pytest.raises(ancf.ModelError, match=told) as error:
        value_of(model, name)
    assert "object at" not in str(error.value)
