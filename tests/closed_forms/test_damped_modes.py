"""Damped and rotating modes against closed forms: oscillator, string, shafts that whirl, blades that turn."""

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from ancf.errors import ModelError, SolveError


@pytest.mark.parametrize(
    ("mass", "stiffness", "damping"), [(2.0, 50.0, 3.0), (0.1, 7.0, 0.0), (1.0, 4.0, 10.0)]
)
def test_oscillator(mass, stiffness, damping):
    """m x'' + d x' + k x = 0, swinging and creeping."""
    model = ancf.Model()
    body = model.add_point_mass("p", at=(1, 0, 0), mass=mass)
    model.hold(body, position="yz")
    model.add_spring(body, (0, 0, 0), stiffness=stiffness, damping=damping)
    exact = np.roots([mass, damping, stiffness])
    modes = ancf.damped_modes(model, count=1)
    wanted = exact[np.argmin(np.abs(exact) - exact.imag * 1e-9)]
    assert modes.eigenvalues[0] == pytest.approx(wanted, rel=1e-10, abs=1e-12)
    critical = damping / (2 * np.sqrt(stiffness * mass))
    if critical < 1:
        assert modes.damping_ratios[0] == pytest.approx(critical, abs=1e-12)
    assert abs(modes.position(body)[0, 0]) > 0.0
    assert np.all(modes.position(body)[:, 1:] == 0.0)


@pytest.mark.parametrize("strain", ["material", "paper"])
def test_taut_string_in_honey(strain):
    """External damping c per length: every mode of rhoA w'' + c w' - T w_xx decays with c/(2 rhoA)."""
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=1e-6, rhoA=0.01, damping=0.4)
    string = model.add_beam(
        "s", start=(0, 0, 0), end=(1, 0, 0), elements=16, length=0.999, section=section, strain=strain
    )
    model.pin(string.start)
    model.pin(string.end)
    state = ancf.equilibrium(model)
    modes = ancf.damped_modes(model, about=state, count=4)
    assert modes.eigenvalues.real == pytest.approx(-20.0, rel=1e-9)
    undamped = ancf.modes(model, about=state, count=4).frequencies
    assert modes.eigenvalues.imag == pytest.approx(np.sqrt(undamped**2 - 400.0), rel=1e-9)
    assert np.all(modes.whirl == 0.0)


def in_space(modes):
    """Angular frequencies of the circles for an observer at rest, with the rotation positive."""
    spin = np.linalg.norm(modes.spin)
    circles = np.abs(modes.whirl) > 0.9
    return np.sort((spin + modes.whirl.round() * modes.eigenvalues.imag)[circles])


@pytest.mark.parametrize("rate", [50.0, 500.0])
@pytest.mark.parametrize("diameter", [0.05, 0.1])
def test_shaft_splits_its_frequencies(diameter, rate):
    """Rayleigh's shaft, simply supported: (A + I k^2) w^2 - 2 W I k^2 w = E I k^4/rho."""
    E, rho, k = 2e11, 7850.0, np.pi / 2
    model = ancf.Model()
    section = ancf.Section.circle(diameter=diameter, E=E, rho=rho, nu=0.3)
    shaft = model.add_beam(
        "s", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section, element="nonlocking"
    )
    model.pin(shaft.start)
    model.hold(shaft.end, position="yz")
    shaft.set_motion(angular_velocity=(rate, 0, 0))
    modes = ancf.damped_modes(model, count=16)
    assert modes.spin == pytest.approx([rate, 0, 0], abs=1e-9 * rate)
    A, Iy = section.A, section.I_y
    exact = np.sort(np.roots([A + Iy * k**2, -2 * rate * Iy * k**2, -E * Iy * k**4 / rho]).real)
    found = in_space(modes)
    found = found[np.argsort(np.abs(np.abs(found) - exact[1]))[:2]]
    assert np.sort(found) == pytest.approx(exact, rel=4e-3)  # shear, which Rayleigh leaves out
    assert found.sum() == pytest.approx(exact.sum(), rel=0.02)  # the split, by gyroscopic moments alone
    assert modes.eigenvalues[0] == 0.0  # it turns freely
    assert np.all(modes.eigenvalues[1:6].imag > 0.0)
    assert np.abs(modes.eigenvalues.real[1:6]).max() < 1e-9 * rate


@pytest.mark.parametrize("rate", [20.0, 60.0])
def test_overhung_disc(rate):
    """A disc on a light cantilever (Stodola): z and phi of the disc, polar moment twice the diametral one."""
    L, m, Id = 0.5, 10.0, 0.05
    model = ancf.Model()
    section = ancf.Section.circle(diameter=0.02, E=2e11, rho=1e-2, nu=0.3)
    shaft = model.add_beam(
        "s", start=(0, 0, 0), end=(L, 0, 0), elements=3, section=section, element="nonlocking"
    )
    disc = model.add_rigid_body("disc", at=(L, 0, 0), mass=m, inertia=(2 * Id, Id, Id))
    model.clamp(shaft.start, rotation=lambda t: rate * t, axis=(1, 0, 0))
    model.clamp(shaft.end, to=disc)
    for body in (shaft, disc):
        body.set_motion(angular_velocity=(rate, 0, 0))
    modes = ancf.damped_modes(model, count=8)
    EI = section.EI_y
    K = EI / L**3 * np.array([[12, -6 * L], [-6 * L, 4 * L**2]])
    M, G = np.diag([m, Id]), np.diag([0.0, 2 * Id * rate])
    # with z = y + i z and exp(i w t): (K + w G' - w^2 M), G' = -G
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [np.linalg.solve(M, K), np.linalg.solve(M, G)]])
    exact = np.sort(np.linalg.eigvals(A).real)
    found = in_space(modes)
    for w in exact:
        assert np.min(np.abs(found - w)) < 3e-3 * abs(w), (w, found)


@pytest.mark.parametrize(("rate", "flap"), [(0.0, 3.5160), (2.0, 4.1373), (6.0, 7.3604), (12.0, 13.1702)])
def test_blade_gets_stiffer(rate, flap):
    """First frequency of a turning cantilever (Wright et al. 1982), and in the plane w^2 less W^2."""
    model = ancf.Model()
    section = ancf.Section(EA=1e7, EI=1.0, rhoA=1.0)
    blade = model.add_beam("b", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
    model.clamp(blade.start, rotation=lambda t: rate * t, axis=(0, 0, 1))
    blade.set_motion(angular_velocity=(0, 0, rate))
    modes = ancf.damped_modes(model, count=2)
    lag, found = modes.eigenvalues.imag
    assert found == pytest.approx(flap, rel=2e-4)
    assert lag**2 == pytest.approx(found**2 - rate**2, rel=1e-3 if rate else 1e-9)
    stretch = modes.about.position(blade.end)[0] - 1.0
    assert stretch == pytest.approx(rate**2 / 3e7, rel=1e-2, abs=1e-12)  # rhoA W^2 L^3/(3 EA)


def rotor(gravity=(0, 0, 0), damping=0.0):
    model = ancf.Model(gravity=gravity)
    section = ancf.Section(EA=1e5, EI=1.0, rhoA=1.0, damping=damping)
    rope = model.add_beam("r", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.pin(rope.start)
    return model, rope


def test_what_is_no_steady_rotation_is_refused():
    model = ancf.Model()
    for k, speed in enumerate((1.0, -1.0, 1.0)):
        stone = model.add_point_mass(f"stone {k}", at=(k, 0, 0), mass=1.0)
        stone.set_motion(velocity=(0, 0, speed))
    with pytest.raises(SolveError, match="not in a steady rotation"):
        ancf.damped_modes(model, count=1)
    model, rope = rotor(gravity=(0, -9.81, 0))
    rope.set_motion(angular_velocity=(0, 0, 5.0))
    with pytest.raises(SolveError, match="from all sides of the axis"):
        ancf.damped_modes(model, count=3)
    model, rope = rotor()
    with pytest.raises(ModelError, match=r"damped_modes\.count"):
        ancf.damped_modes(model, count=1000)
    with pytest.raises(ModelError, match="must be a State"):
        ancf.damped_modes(model, about="rest")


def test_damping_inside_a_blade_is_that_of_its_bending():
    """Of a turning blade too the first mode loses by its strains alone: D is proportional to K at rest."""
    found = []
    for rate in (0.0, 6.0):
        model = ancf.Model()
        section = ancf.Section(EA=1e7, EI=1.0, rhoA=1.0, bending_damping=1e-3)
        blade = model.add_beam("b", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
        model.clamp(blade.start, rotation=lambda t, rate=rate: rate * t, axis=(0, 0, 1))
        blade.set_motion(angular_velocity=(0, 0, rate))
        found.append(ancf.damped_modes(model, count=2).eigenvalues)
    still, turning = found
    assert still.real == pytest.approx(-0.5e-3 * np.abs(still) ** 2, rel=1e-4)
    assert np.all(turning.real < 0.0)
    assert np.abs(turning[1]) == pytest.approx(7.3604, rel=1e-3)


@pytest.mark.parametrize("rate", [60.0, 400.0])
@pytest.mark.parametrize("element", ["nonlocking", "original"])
def test_shaft_that_whirls_in_air_at_rest(element, rate):
    """External damping brakes both whirls: l^2 (A + I k^2) + l (c/rho - 2 i W I k^2) + E I k^4/rho = 0."""
    E, rho, k, c = 2e11, 7850.0, np.pi / 2, 900.0
    model = ancf.Model()
    section = ancf.Section.circle(diameter=0.05, E=E, rho=rho, nu=0.0, damping=c)
    elements = 4 if element == "nonlocking" else 24
    shaft = model.add_beam(
        "s", start=(0, 0, 0), end=(2, 0, 0), elements=elements, section=section, element=element
    )
    model.pin(shaft.start)
    model.hold(shaft.end, position="yz")
    shaft.set_motion(angular_velocity=(rate, 0, 0))
    modes = ancf.damped_modes(model, count=20)
    A, Iy = section.A, section.I_y
    mass = A + Iy * k**2
    exact = np.roots([mass, c / rho - 2j * rate * Iy * k**2, E * Iy * k**4 / rho])
    circles = np.abs(modes.whirl) > 0.9
    found = modes.eigenvalues[circles]
    space = found.real + 1j * (rate + modes.whirl.round()[circles] * found.imag)
    for value in exact:
        near = space[np.argmin(np.abs(space - value))]
        assert near.imag == pytest.approx(value.imag, rel=6e-3)
        assert near.real == pytest.approx(value.real, rel=6e-3)


@pytest.mark.parametrize(("rate", "c"), [(2.0, 0.3), (1.0, 2.0)])
def test_blade_is_bent_back_by_the_air(rate, c):
    """Drag c W x per length on a stiff cantilever: the tip lags by 11 c W L^5/(120 EI)."""
    L, EI = 1.5, 4e3
    model = ancf.Model()
    section = ancf.Section(EA=1e8, EI=EI, rhoA=1.0, damping=c)
    blade = model.add_beam("b", start=(0, 0, 0), end=(L, 0, 0), elements=6, section=section)
    model.clamp(blade.start, rotation=lambda t: rate * t, axis=(0, 0, 1))
    blade.set_motion(angular_velocity=(0, 0, rate))
    modes = ancf.damped_modes(model, count=2)
    assert modes.about.position(blade.end)[1] == pytest.approx(-11 * c * rate * L**5 / (120 * EI), rel=2e-3)
    assert modes.eigenvalues.real == pytest.approx(-0.5 * c, rel=1e-3)


def test_resistance_that_stands_still_is_refused_of_what_turns():
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=1.0, rhoA=1.0, slope_damping=0.1)
    rope = model.add_beam("r", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.pin(rope.start)
    rope.set_motion(angular_velocity=(0, 0, 5.0))
    with pytest.raises(SolveError, match="resistance that stands still"):
        ancf.damped_modes(model, count=3)
    model, rope = rotor(damping=0.1)
    rope.set_motion(angular_velocity=(0, 0, 5.0))
    with pytest.raises(SolveError, match="does not turn steadily"):  # the air brings it to rest
        ancf.damped_modes(model, count=3)


def pressed(load, elements, section):
    """Lowest two eigenvalues of a column, EI = rhoA = L = 1, whose end is pressed along its tangent."""
    model = ancf.Model()
    column = model.add_beam("column", start=(0, 0, 0), end=(0, 0, 1), elements=elements, section=section)
    model.clamp(column.start)
    for x in column.node_x[1:]:
        model.hold(column.at(float(x)), position="y", slope="y")
    model.add_follower_force(column.end, (-load, 0, 0))
    return ancf.damped_modes(model, about=ancf.equilibrium(model), count=2).eigenvalues


def becks_equation(w, load):
    s = np.sqrt(load**2 / 4 + w * w)
    a, b = np.sqrt(s + load / 2), np.sqrt(s - load / 2)
    return load**2 + 2 * w * w + load * w * np.sin(a) * np.sinh(b) + 2 * w * w * np.cos(a) * np.cosh(b)


@pytest.mark.parametrize(("load", "elements"), [(-15.0, 8), (4.0, 6), (12.0, 8), (19.5, 10)])
def test_column_under_a_follower_force(load, elements):
    """The roots of Beck's characteristic equation, pulled and pressed."""
    found = pressed(load, elements, ancf.Section(EA=1e6, EI=1.0, rhoA=1.0))
    assert np.abs(found.real).max() < 1e-6
    wanted = [brentq(becks_equation, 0.95 * w, 1.05 * w, args=(load,)) for w in found.imag]
    assert found.imag == pytest.approx(wanted, rel=4e-4)


def test_column_flutters():
    """Two frequencies meet at 20.05; damping of the material makes that earlier (Ziegler's paradox)."""
    assert np.abs(pressed(19.95, 10, ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)).real).max() < 1e-6
    above = pressed(20.2, 10, ancf.Section(EA=1e6, EI=1.0, rhoA=1.0))
    assert above.real.max() > 0.3
    damped = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0, bending_damping=1e-3)
    assert pressed(10.0, 10, damped).real.max() < 0.0
    assert pressed(12.0, 10, damped).real.max() > 0.0


def in_bearings(rate, hold, mass=5.0, polar=0.05, across=0.03):
    """Lowest six modes of a rigid rotor about x whose bearings, at x = 0.2 and -0.2 m, ``hold`` makes."""
    model = ancf.Model()
    rotor = model.add_rigid_body("rotor", at=(0, 0, 0), mass=mass, inertia=(polar, across, across))
    rotor.set_motion(angular_velocity=(rate, 0, 0))
    for x in (-0.2, 0.2):
        hold(model, rotor, x)
    return ancf.damped_modes(model, count=6)


def between_springs(model, rotor, x, stiffness=(1e4, 1e4), damping=10.0):
    """Two springs along y and two along z: twice stiffness and damping across the axis."""
    for (y, z), k in zip(((1, 0), (0, 1)), stiffness, strict=True):
        for side in (-1, 1):
            place = (x, side * y, side * z)
            model.add_spring(rotor.at(x, 0, 0), place, stiffness=k, damping=damping)


def in_a_law(model, rotor, x):
    model.add_force(rotor.at(x, 0, 0), ["0", "-2e4*y - 20*vy", "-2e4*z - 20*vz"])


@pytest.mark.parametrize(
    ("element", "neutral"), [("cable", 5), ("original", 6), ("nonlocking", 6), ("mass", 3)]
)
@pytest.mark.parametrize("damping", [0.0, 1e-4])
def test_what_nothing_holds_has_its_rigid_motions(element, neutral, damping):
    """Once each, with the value zero, whatever else is asked for and whatever resists them."""
    model = ancf.Model()
    if element == "mass":
        body = model.add_point_mass("p", at=(1, 0, 0), mass=2.0)
    else:
        section = ancf.Section.circle(diameter=0.01, E=2e11, rho=7850, nu=0.3, damping=damping)
        body = model.add_beam(
            "b", start=(0, 0, 0), end=(1, 0.2, 0.3), elements=3, section=section, element=element
        )
    for count in {1, 2, neutral}:
        modes = ancf.damped_modes(model, count=count)
        assert np.all(modes.eigenvalues == 0.0)
        assert len(modes.eigenvalues) == count
    where = body if element == "mass" else body.at(0.3)
    moved = modes.position(where).real
    assert np.linalg.matrix_rank(moved, tol=1e-6 * np.abs(moved).max()) == 3
    if element != "mass":
        assert ancf.damped_modes(model, count=neutral + 2).eigenvalues[neutral:].imag.min() > 10.0


@pytest.mark.parametrize("resistance", [1e-3, 0.5, 40.0])
@pytest.mark.parametrize("mass", [0.2, 3.0])
def test_what_is_braked_has_two_values(mass, resistance):
    """m x'' + c x' = 0 along x: 0 and -c/m, however small beside the spring across."""
    model = ancf.Model()
    body = model.add_point_mass("p", at=(1, 0, 0), mass=mass)
    model.add_force(body, [f"-{resistance}*vx", "-1e5*y", "-1e5*z"])
    found = ancf.damped_modes(model, count=3).eigenvalues
    assert found[:2] == pytest.approx([0.0, -resistance / mass], rel=1e-6, abs=0.0)
    assert found[2:] == pytest.approx(1j * np.sqrt(1e5 / mass), rel=1e-6)


@pytest.mark.parametrize("stiffness", [1.0, 1e-3])
def test_what_creeps_is_not_neutral(stiffness):
    """c x' + k x = 0 in honey: -k/c, of which inertia is no part."""
    model = ancf.Model()
    body = model.add_point_mass("p", at=(1, 0, 0), mass=1e-3)
    model.add_force(body, [f"-1e6*vx - {stiffness}*(x - 1)", "-1e5*y", "-1e5*z"])
    found = ancf.damped_modes(model, count=1).eigenvalues[0]
    assert found == pytest.approx(-1e-6 * stiffness, rel=1e-6, abs=0.0)


@pytest.mark.parametrize("hold", [between_springs, in_a_law])
@pytest.mark.parametrize("rate", [10.0, 200.0])
def test_dampers_of_bearings_stand_still(hold, rate):
    """For an observer at rest translations do not know of the rotation, and decay: m w'' + c w' + k w = 0.

    The tilts have the gyroscopic moment alone, J w'' + (c - i W J_p) w' + k w = 0 (Genta 2005, 3.4).
    """
    modes = in_bearings(rate, hold)
    k, c, arm = 4e4, 40.0, 0.04
    at_rest = np.concatenate([np.roots([5.0, c, k]), np.roots([0.03, c * arm - 1j * rate * 0.05, k * arm])])
    found = modes.eigenvalues[2:]
    assert np.all(modes.eigenvalues[:2] == 0.0)  # along the axis and about it
    assert len(found) == 4
    for value in at_rest - 1j * rate:  # in axes that turn; of a pair that above the axis
        wanted = value if value.imag >= 0 else value.conjugate()
        near = found[np.argmin(np.abs(found - wanted))]
        assert near.real == pytest.approx(wanted.real, rel=2e-3)
        assert near.imag == pytest.approx(wanted.imag, rel=2e-2)  # the pull of the springs beside the axis


@pytest.mark.parametrize("rate", [3.0, 7.0, 50.0, 900.0])
def test_springs_as_strong_as_the_centrifugal_force(rate):
    """k = m W^2: in axes that turn with it a mass may rest anywhere in its plane."""
    model = ancf.Model()
    for k, at in enumerate([(0.4, 0, 0), (-0.1, 0.3, 0), (-0.2, -0.2, 0.1)]):
        mass = model.add_point_mass(f"m{k}", at=at, mass=0.3)
        model.add_spring(mass, (0, 0, at[2]), stiffness=0.3 * rate**2, length=0.0)
        mass.set_motion(velocity=np.cross((0, 0, rate), at))
        model.hold(mass, position="z")
    assert np.all(ancf.damped_modes(model, count=6).eigenvalues == 0.0)


def test_bearings_that_are_not_alike_from_all_sides_are_refused():
    def softer_upwards(model, rotor, x):
        between_springs(model, rotor, x, stiffness=(1e4, 2e4))

    with pytest.raises(SolveError, match="from all sides of the axis"):
        in_bearings(100.0, softer_upwards)


def test_a_brake_needs_a_moment():
    def braked(model, rotor, x):
        between_springs(model, rotor, x)
        model.add_torsion_spring(
            rotor, (0, 0, 0), axis=(1, 0, 0), stiffness=0.0, damping=1.0, name=f"brake {x}"
        )

    with pytest.raises(SolveError, match="does not turn steadily"):
        in_bearings(100.0, braked)


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_stiff_shafts_of_any_size_turn_slowly(size, rate):
    """Round-off of a shaft that is stiff beside its centrifugal forces is no force."""
    model = ancf.Model()
    section = ancf.Section.circle(diameter=0.02 * size, E=2.1e11, rho=7850.0, nu=0.3)
    shaft = model.add_beam(
        "s", start=(0, 0, 0), end=(size, 0, 0), elements=6, section=section, element="nonlocking"
    )
    model.pin(shaft.start)
    model.hold(shaft.end, position="yz")
    shaft.set_motion(angular_velocity=(rate / size, 0, 0))
    modes = ancf.damped_modes(model, count=4)
    critical = (
        np.pi**2 * np.sqrt(2.1e11 * section.I_y / (7850.0 * section.A)) / size
    )  # of Euler and Bernoulli
    swing = np.abs(modes.whirl) > 0.9
    found = np.sort(modes.eigenvalues.imag[swing][:2] * size)
    assert found == pytest.approx([critical - rate, critical + rate], rel=1e-3)


@pytest.mark.parametrize("push", [0.0, 6.0, 60.0])
def test_a_force_across_the_velocity(push):
    """m x'' = -k x + b v x e, as of a magnet: circles with sqrt(k/m + (b/2m)^2) less and plus b/2m."""
    model = ancf.Model()
    ball = model.add_point_mass("ball", at=(0, 0, 0), mass=2.0)
    model.hold(ball, position="x")
    model.add_force(ball, ["0", f"-200*y + {push}*vz", f"-200*z - {push}*vy"])
    modes = ancf.damped_modes(model, count=2)
    half = push / 4.0
    wanted = np.sqrt(100.0 + half**2) + np.array([-half, half])
    assert modes.eigenvalues.imag == pytest.approx(wanted, rel=1e-9)
    assert np.abs(modes.eigenvalues.real).max() < 1e-9 * wanted[1]


@pytest.mark.parametrize("angle", ["0", "0.5*(1 - cos(pi*t))", "0.3*sin(t)**2"])
def test_an_arm_on_a_motor_at_rest(angle):
    """Rates of given motions that begin at rest are round-off and no motion."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(height=0.01, width=0.03, E=7e10, rho=2700.0)
    beam = model.add_beam(
        "arm", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section, element="nonlocking"
    )
    model.clamp(beam.start, rotation_vector=[0, f"-({angle})", 0])
    rest = ancf.equilibrium(model)
    found = ancf.damped_modes(model, about=rest, count=3)
    wanted = 2.0 * np.pi * np.asarray(ancf.modes(model, about=rest, count=3).frequencies_hz)
    assert np.sort(np.imag(found.eigenvalues)) == pytest.approx(np.sort(wanted), rel=1e-6)


@pytest.mark.parametrize("damping", [0.0, 0.1, 3.0])
@pytest.mark.parametrize("elements", [3, 6, 9])
@pytest.mark.parametrize("hung", ["ball", "turning in a current"])
def test_neutral_motions_take_no_digits(hung, elements, damping):
    """A body that spins freely below a rope: other eigenvalues are those of the linear model in modes."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2, damping=damping, diameter=0.01, drag=(1.2, 0.1))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -2), elements=elements, section=section)
    model.pin(rope.start)
    body = model.add_rigid_body("body", at=(0, 0, -2.2), mass=2.0, inertia=(0.02, 0.03, 0.04))
    model.connect(rope.end, body.at(0, 0, 0.2))
    if hung != "ball":
        model.add_fluid("air", density=1.2, velocity=(3.0, 1.0, 0))
    state = ancf.equilibrium(model)
    values = ancf.linearise(model, about=state).eigenvalues
    found = ancf.damped_modes(model, about=state, count=20 if elements == 3 else 40).eigenvalues
    vibrate = found[np.abs(found) > 1e-3]  # what spins has the stiffness that an equilibrium leaves, if any
    assert len(vibrate) >= len(found) - 2
    for value in vibrate:
        assert np.min(np.abs(values - value)) <= 1e-9 * np.abs(value)
