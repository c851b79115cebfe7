"""Numbers that look like those of other units: said of results, equilibria, modes and by ``ancf check``."""

import pytest

import ancf
from ancf.model.doubts import doubts


def beam(**material):
    model = ancf.Model()
    section = ancf.Section.rectangle(0.01, 0.01, **material)
    rod = model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.clamp(rod.start)
    return model


@pytest.mark.parametrize(
    ("E", "rho", "said"),
    [
        (210.0, 7850.0, "E = 210 N/m^2 is softer than any solid"),
        (2.1e11, 7.85, "rho = 7.85 kg/m^3 is lighter than any solid"),
        (2.1e11, 7.85e6, "rho = 7.85e+06 kg/m^3 is heavier than any solid"),
        (2.1e11, 7850.0, None),
        (1e4, 20.0, None),  # a foam
        (5e11, 22_600.0, None),  # osmium
    ],
)
def test_materials(E, rho, said):
    model = beam(E=E, rho=rho)
    found = doubts(model)
    assert len(found) == (said is not None)
    if said is None:
        return
    assert said in found[0]
    assert found[0].startswith('"rod": ')
    assert found[0] in ancf.simulate(model, t_end=1e-3, step=1e-3).notes
    assert found[0] in ancf.equilibrium(model).notes
    assert found[0] in ancf.modes(model, count=1).notes


@pytest.mark.parametrize(
    ("density", "diameter", "direction", "said"),
    [
        (1.025, 0.1, 0.0, '"sea": 1.025 kg/m^3 with a surface at z = 0 m: water has 1000 to 1030'),
        (1025.0, 100.0, 0.0, '"rope": displaces 8.05e+06 kg/m of "sea" and has 20 kg/m'),
        (1025.0, 0.1, 90.0, '"sea": its waves run in the direction of 90 rad'),
        (1025.0, 0.5, 1.5, None),  # a buoy
        (1025.0, 0.03, -3.0, None),
    ],
)
def test_what_is_in_water(density, diameter, direction, said):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e6, EI=0.0, rhoA=20.0, diameter=diameter)
    rope = model.add_beam("rope", start=(0, 0, -50), end=(60, 0, 0), elements=3, section=section)
    model.pin(rope.start)
    waves = ancf.Waves.regular(height=1.0, period=6.0, depth=60.0, direction=direction)
    model.add_fluid("sea", density, below=0.0, waves=waves)
    found = doubts(model)
    assert len(found) == (said is not None)
    if said is not None:
        assert found[0].startswith(said)


def test_air_is_no_water():
    model = ancf.Model()
    model.add_fluid("air", 1.225, velocity=(10.0, 0, 0))
    assert doubts(model) == []


def test_numbers_without_a_material_say_nothing():
    model = ancf.Model()
    model.add_beam(
        "rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1, EI=0, rhoA=1e-3)
    )
    assert doubts(model) == []


@pytest.mark.parametrize(("friction", "said"), [(30.0, True), (3.5, True), (1.2, False), (0.0, False)])
def test_friction_that_no_surface_has(friction, said):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=0.1, rhoA=1.0, diameter=0.02)
    rope = model.add_beam("rope", start=(-2, 0, 1), end=(2, 0, 1), elements=4, section=section)
    model.pin(rope.start)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.5, axis=(0, 1, 0)))
    model.add_surface_contact(rope, drum, stiffness=1e5, friction=friction, name="wrap")
    model.add_ground("bed", height=-1.0, stiffness=1e5, friction=friction)
    names = ["bed", "wrap"] if said else []
    assert [text.split('"')[1] for text in doubts(model)] == names
    assert all(f"a friction of {friction:g} is more than surfaces have" in text for text in doubts(model))


@pytest.mark.parametrize("way", ["nothing", "slope", "other end", "pin", "hold", "joint"])
def test_a_winch_that_nothing_holds(way):
    model = ancf.Model(gravity=(0, 0, -9.81))
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=(0, 0, -5), elements=4, section=ancf.Section(EA=1e5, EI=0.0, rhoA=1.0)
    )
    model.winch(rope.start, length="5 - 0.1*t**2")
    if way in ("pin", "other end"):
        model.pin(rope.start if way == "pin" else rope.end)
    elif way == "hold":
        model.hold(rope.start, position="xyz")
    elif way == "joint":
        model.connect(model.add_point_mass("drum", at=(0, 0, 0), mass=5.0), rope.start)
    found = doubts(model)
    if way in ("pin", "hold", "joint"):
        assert found == []
    else:
        assert found == [
            '"winch at rope.start": nothing holds rope.start: pin it, or connect it to what carries the winch'
        ]


@pytest.mark.parametrize("spectrum", ["jonswap", "pierson_moskowitz"])
@pytest.mark.parametrize(
    ("height", "period", "said"),
    [
        (12.0, 9.0, "steepness 2 pi Hs/(g Tp^2) is 0.0949, that of seas at most 0.063"),
        (5.0, 6.0, "at most 0.067 (DNV-RP-C205); with this height Tp is at least about 6.93 s"),
        (18.0, 15.0, "at most 0.04 "),
        (12.0, 14.0, None),
        (6.0, 8.0, None),  # 1/16.6
        (1.0, 20.0, None),
    ],
)
def test_seas_that_are_steeper_than_any(spectrum, height, period, said):
    """Limits of DNV-RP-C205 (2014), 3.5.4: 1/15 for Tp up to 8 s, 1/25 from 15 s on, linear between."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    waves = getattr(ancf.Waves, spectrum)(height=height, period=period)
    model.add_fluid("sea", 1025.0, below=0.0, waves=waves)
    found = doubts(model)
    assert len(found) == (said is not None)
    if said is not None:
        assert found[0].startswith(f'"sea": waves of Hs = {height:g} m with Tp = {period:g} s break: ')
        assert said in found[0]


def test_check_says_so(call, tmp_path):
    text = """
[sections.steel]
shape = "rectangle"
width = 0.01
height = 0.01
E = 210
rho = 7850
[[bodies]]
type = "beam"
name = "rod"
section = "steel"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
[[supports]]
type = "clamp"
point = "rod.start"
rotation = "step(t - 0.1)"
[simulation]
t_end = 1.0
step = 1e-3
"""
    (tmp_path / "rod.toml").write_text(text)
    ran = call("check", str(tmp_path / "rod.toml"))
    assert ran.code == 0
    assert "softer than any solid" in ran.said + ran.out
    assert "its value jumps by 1 rad at t = 0.1 s" in ran.said + ran.out


@pytest.mark.parametrize("start", ["rest", "equilibrium"])
def test_check_names_a_support_that_sets_off_at_once(start, call, tmp_path):
    text = """[sections.steel]
EA = 1e6
rhoA = 1.0
EI = 1.0
[[bodies]]
type = "beam"
name = "rod"
section = "steel"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
[[supports]]
type = "clamp"
point = "rod.start"
rotation = "3*t"
[simulation]
t_end = 1.0
step = 1e-3
"""
    (tmp_path / "rod.toml").write_text(text + (f'start = "{start}"\n' if start != "rest" else ""))
    ran = call("check", str(tmp_path / "rod.toml"))
    assert ran.code == 0
    said = " ".join((ran.said + ran.out).split())
    assert 'supports[0].rotation of "clamp at rod.start": its rate is 3 rad/s from t = 0 s on' in said


@pytest.mark.parametrize(
    ("given", "velocity", "said"),
    [
        (
            {"direction": 90.0},
            (0, 12, 0),
            ["in the direction of 90 rad", "are those of a wind"],
        ),
        ({"direction": 1.57, "deviation": 20.0}, (0, 12, 0), ["deviate by 167 % of the mean wind"]),
        (
            {"direction": 1.57},
            (0, 0, 0),
            ["a wind of (0.00956, 12, 0) m/s, which velocity="],
        ),
        ({"direction": 1.57}, (12, 0, 0), ["it is (12, 0, 0)"]),
        ({"direction": 1.57}, (0, 12, 0), []),
        ({"direction": 0.0}, ["12 + sin(t)", 0, 0], []),
        ({"direction": 0.0}, ["12*(1 + 0.01*z)", 0, 0], []),
        ({"direction": 0.0}, {"z": [0, 50], "velocity": [[8, 0, 0], [14, 0, 0]]}, []),
    ],
)
def test_gusts(given, velocity, said):
    model = ancf.Model()
    wanted = {"speed": 12.0, "deviation": 2.0, "length": 60.0, "extent": (0.0, 40.0), "duration": 10.0}
    model.add_fluid("wind", 1.225, velocity=velocity, gusts=ancf.Gusts.von_karman(**(wanted | given)))
    found = doubts(model)
    assert len(found) == len(said), found
    for text, part in zip(found, said, strict=True):
        assert text.startswith('"wind": ')
        assert part in text


@pytest.mark.parametrize(("angle", "said"), [(90.0, True), (-45.0, True), (3.0, False), (20.0, False)])
def test_torsion_springs_in_degrees(angle, said):
    model = ancf.Model()
    body = model.add_rigid_body("body", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    model.hinge(body, (0, 0, 0), axis=(0, 0, 1))
    model.add_torsion_spring(body, (0, 0, 0), axis=(0, 0, 1), stiffness=1.0, angle=angle, name="twist")
    assert [f"{angle:g} rad" in text for text in doubts(model)] == [True] * said


#: Lines as they are, by makers' or textbooks' numbers in SI units (EA, EI, rhoA, diameter, length)
LINES = {
    "contact wire": (1.2e7, 150.0, 1.08, 0.012, 600.0),
    "steel rope": (8e7, 500.0, 3.0, 0.03, 300.0),
    "mooring chain": (7.5e8, 0.0, 200.0, 0.2, 800.0),
    "polyester rope": (3e7, 0.0, 20.0, 0.2, 3000.0),
    "deck of a bridge": (5e11, 3e13, 25e3, None, 1500.0),
    "immersed tunnel": (6e12, 6e13, 3e5, None, 180.0),
    "rubber band": (20.0, 5e-6, 4e-3, 2e-3, 0.1),
    "silicone": (8.0, 4e-5, 0.08, 0.01, 0.2),
    "Slinky": (0.05, 1e-4, 3.3, 0.07, 1.5),
    "foam rod": (80.0, 0.01, 0.06, 0.05, 1.0),
    "spider silk": (0.07, 1e-14, 1e-8, 3e-6, 0.05),
    "carbon fibre": (9.0, 3e-11, 7e-8, 7e-6, 0.1),
    "DNA": (1.1e-9, 2.1e-28, 3.3e-15, 2e-9, 1e-6),
    "nanotube": (1.0e-6, 1e-25, 1.3e-15, 1e-9, 1e-7),
    "rigid stand-in": (7.5e12, 0.0, 800.0, None, 500.0),
    "belt without thickness": (7600.0, 1.3e-3, 0.87, 1e-4, 2.0),
}
SPEED, THICK, AIR, BRIDGE = "a pull runs along it at", "m thick, and it is", "less than air", "any bridge has"


def line_of(EA, EI, rhoA, diameter, length, gravity=9.81):
    model = ancf.Model(gravity=(0, 0, -gravity))
    section = ancf.Section(EA=EA, EI=EI, rhoA=rhoA, diameter=diameter)
    line = model.add_beam("line", start=(0, 0, 0), end=(length, 0, 0), elements=2, section=section)
    model.pin(line.start)
    return model


@pytest.mark.parametrize("name", LINES)
def test_lines_as_they_are(name):
    assert doubts(line_of(*LINES[name])) == []


@pytest.mark.parametrize(
    ("name", "changed", "said"),
    [
        ("contact wire", {"EA": 5e-6}, [SPEED, THICK]),
        ("contact wire", {"EI": 1e12}, [THICK]),
        ("deck of a bridge", {"EI": 3e16}, [THICK]),
        ("steel rope", {"EI": 500e12}, [THICK]),
        ("contact wire", {"rhoA": 1e-9}, [SPEED, AIR]),
        ("contact wire", {"rhoA": 1e6}, [BRIDGE]),
        ("deck of a bridge", {"rhoA": 25e6}, [BRIDGE]),
        ("steel rope", {"EA": 8e16}, [SPEED]),
        *(
            (name, {"diameter": 1e3 * LINES[name][3]}, [AIR])
            for name in ("contact wire", "steel rope", "rubber band")
        ),
        ("foam rod", {"rhoA": 0.06e-3}, [AIR]),
    ],
)
def test_lines_in_other_units(name, changed, said):
    given = dict(zip(("EA", "EI", "rhoA", "diameter", "length"), LINES[name], strict=True)) | changed
    model = line_of(**given)
    found = doubts(model)
    assert len(found) == len(said), found
    for text, part in zip(found, said, strict=True):
        assert text.startswith('"line": ')
        assert part in text
        assert text in " ".join(str(model).split())


@pytest.mark.parametrize(
    ("gravity", "said"),
    [(981.0, True), (9810.0, True), (32.2, True), (24.8, False), (0.0, False), (1.62, False)],
)
def test_gravity_in_other_units(gravity, said):
    """32.2 are feet per second squared; Jupiter has 24.8 m/s^2."""
    found = doubts(line_of(*LINES["steel rope"], gravity=gravity))
    assert (
        found
        == [f"gravity of {gravity:g} m/s^2 is more than planets have, on Earth it is 9.81: is it in m/s^2?"]
        * said
    )


def test_units_of_a_fluid_and_of_a_line_are_told_once():
    model = line_of(1e6, 0.0, 20.0, 100.0, 60.0)
    assert [AIR in text for text in doubts(model)] == [True]
    model.add_fluid("sea", 1025.0, below=0.0)
    assert ["displaces" in text for text in doubts(model)] == [True]
