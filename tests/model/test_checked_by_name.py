"""A number that is changed by its name is checked as the method that takes it checks it, and as files do."""

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study
from ancf.model.kinds import GROUPS
from ancf.model.vary import names_of, value_of, varied
from ancf.sensitivity.parameters import Named
from registered import study_with

KINDS = [(group, kind) for group, kinds in GROUPS.items() for kind in kinds]
WAVES = ancf.Waves.regular(height=1.0, period=5.0)


def refusal(make):
    """What ModelError says, or nothing."""
    try:
        make()
    except ancf.ModelError as error:
        return error.what
    return ""


def described(model, group, index, key, value):
    """The model of a description that has another number."""
    plain = model.to_dict()
    name, bracket, part = key.partition("[")
    if bracket:
        plain[group][index][name][int(part[:-1])] = value
    else:
        plain[group][index][name] = value
    return ancf.Model.from_dict(plain)


@pytest.mark.parametrize(("group", "kind"), KINDS, ids=[kind.word for _, kind in KINDS])
def test_as_the_method_does(group, kind):
    """All numbers of an item of each kind: the same ones are accepted, and the same is said of others."""
    model = parse_study(study_with(group, kind)).model
    item = getattr(model, group)[0]
    for name in (n for n in names_of(model) if n.startswith(f"{item.name}.")):
        now, key = value_of(model, name), name.removeprefix(f"{item.name}.")
        plain = model.to_dict()[group][0].get(key.partition("[")[0])
        assert not refusal(lambda name=name, now=now: varied(model, name, now))
        if not isinstance(plain, float | list) or (isinstance(plain, list) and "[" not in key):
            continue  # varies by a factor
        for value in (-abs(now) - 0.5, 0.0, 1.5 * now):
            wanted = refusal(lambda key=key, x=value: described(model, group, 0, key, x))
            assert refusal(lambda name=name, x=value: varied(model, name, x)) == wanted
            assert refusal(lambda name=name, x=value: Named(model, name)(x)) == wanted


def sea_and_air(meet=0.0, gap=0.0, on=(None, None), waves=None):
    model = ancf.Model(gravity=(0, 0, -9.81))
    for name, x in (("buoy", 0.0), ("mark", 1.0)):
        model.add_point_mass(name, at=(x, 0, 0), mass=1.0, volume=0.001)
    model.add_fluid("sea", density=1025.0, below=meet, on=on[0], waves=waves)
    model.add_fluid("air", density=1.2, above=meet + gap, on=on[1])
    return model


@pytest.mark.parametrize("meet", [-3.0, 0.0, 2.0])
@pytest.mark.parametrize("gap", [0.0, 0.5])
def test_two_fluids_in_one_place(meet, gap):
    """Also of more than one change, one after the other, and of models that are only read."""
    model = sea_and_air(meet, gap)
    for vary in (varied, lambda m, name, x: Named(m, name)(x)):
        apart = vary(model, "sea.below", meet + 0.9 * gap)
        assert apart.fluids[0].below == meet + 0.9 * gap
        assert vary(model, "air.above", meet + gap + 1.0).fluids[1].above == meet + gap + 1.0
        with pytest.raises(ancf.ModelError, match='"sea" and "air" are both between') as caught:
            vary(apart, "sea.below", meet + gap + 0.1)
        assert caught.value.where == "sea.below"
        assert "builds the model" in caught.value.hint
        with pytest.raises(ancf.ModelError, match='"air" and "sea" are both between'):
            vary(model, "air.above", meet - 0.1)
    with pytest.raises(ancf.ModelError, match="both between"):
        ancf.minimise(
            model,
            "position(buoy)[2]",
            {"sea.below": (meet + gap + 0.1, meet + gap + 1.0)},
            t_end=0.01,
            step=0.01,
        )


@pytest.mark.parametrize("on", [(["buoy"], ["mark"]), (["mark"], ["buoy"])])
def test_on_different_bodies_they_may_be(on):
    assert varied(sea_and_air(on=on), "sea.below", 3.0).fluids[0].below == 3.0


@pytest.mark.parametrize("name", ["gravity", "gravity[2]"])
def test_waves_need_gravity_downwards(name):
    model = sea_and_air(waves=WAVES)
    now = value_of(model, name)
    assert np.array_equal(varied(model, name, 0.5 * now).gravity, [0, 0, -4.905])
    for value in (0.0, -now):
        with pytest.raises(ancf.ModelError, match="need gravity along -z"):
            varied(model, name, value)
    assert varied(model, "gravity[0]", 1.0).gravity[0] == 1.0
    assert varied(sea_and_air(), name, -now).gravity[2] == 9.81


@pytest.mark.parametrize("element", ["original", "nonlocking"])
@pytest.mark.parametrize("made", ["rectangle", "circle"])
def test_damping_of_slopes_is_of_cables_alone(element, made):
    """As in files and in Python; by its name it was accepted and did nothing."""
    sizes = {"width": 0.02, "height": 0.02} if made == "rectangle" else {"diameter": 0.02}
    section = getattr(ancf.Section, made)(**sizes, E=1e7, rho=500.0, nu=0.3)
    model = ancf.Model()
    for name, kind in (("bar", element), ("wire", "cable")):
        model.add_beam(name, start=(0, 0, 0), end=(1, 0, 0), elements=1, section=section, element=kind)
    assert varied(model, "wire.slope_damping", 0.3).bodies["wire"].section.slope_damping == 0.3
    assert "bar.slope_damping" not in names_of(model)
    assert "bar.bending_damping" in names_of(model)
    for ask in (lambda n: value_of(model, n), lambda n: varied(model, n, 0.3)):
        with pytest.raises(ancf.ModelError, match=f'no effect on element "{element}"'):
            ask("bar.slope_damping")
