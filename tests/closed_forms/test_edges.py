"""A cable on a table that hangs over its rounded edge: how much holds, how fast the rest slides."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf

G, R, D, MASS = 9.81, 0.06, 0.02, 0.3  # m/s^2, m: the edge, diameter; kg/m
CORNERS = [(x, y, z) for x in (-2.0, 0.0) for y in (-0.5, 0.5) for z in (-1.5, 0.0)]
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
FACES += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def over_the_edge(hanging, lying, friction, element=0.025, stiffness=5e4):
    """The top is a mesh, the edge a cylinder at its end; the axis of the cable turns with R + D/2."""
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=2e4, EI=1e-5, rhoA=MASS, diameter=D, axial_damping=20.0, bending_damping=1e-6)
    r, a = R + 0.5 * D, np.linspace(0, 0.5 * math.pi, 13)
    on_top, down = np.linspace(-lying, 0, 25)[:-1], np.linspace(0, hanging, 15)[1:]
    path = np.concatenate(
        [
            np.column_stack([on_top, 0 * on_top, 0.5 * D + 0 * on_top]),
            np.column_stack([r * np.sin(a), 0 * a, r * np.cos(a) - R]),
            np.column_stack([r + 0 * down, 0 * down, -R - down]),
        ]
    )
    count = round((lying + hanging + 0.5 * math.pi * r) / element)
    cable = model.add_beam("cable", path=path, elements=count, section=section)
    top = model.add_surface("top", ancf.Mesh(points=CORNERS, triangles=FACES))
    edge = model.add_surface("edge", ancf.Cylinder(radius=R, at=(0, 0, -R), axis=(0, 1, 0)))
    for surface in (top, edge):
        model.add_contact(cable, surface, stiffness=stiffness, damping=300.0, friction=friction)
    return model, cable


def held(lying, friction):
    """Hanging length that friction just holds: dT/dphi = mu (T + w r cos(phi)) - w r sin(phi)."""
    r = R + 0.5 * D

    def rate(phi, T):
        return friction * (T + r * np.cos(phi)) - r * np.sin(phi)

    return float(solve_ivp(rate, (0, 0.5 * math.pi), [friction * lying], rtol=1e-10).y[0, -1])


@pytest.mark.parametrize(("lying", "friction"), [(0.8, 0.3), (0.5, 0.6)])
def test_holds_below_the_limit_and_slides_above(lying, friction):
    """Capstan's equation with the weight on the edge gives the limit; 5 % beside it either happens."""
    for share in (0.95, 1.05):
        model, cable = over_the_edge(share * held(lying, friction), lying, friction)
        run = ancf.simulate(model, t_end=0.5, step=1e-3, output_step=0.05)
        x = run.position(cable.start)[:, 0]
        late = x[-1] - x[-3]  # in a tenth of a second; friction begins with the pressure, after some steps
        assert late < 1e-6 if share < 1.0 else late > 5e-3, share


@pytest.mark.parametrize(("lying", "hanging"), [(0.8, 0.3), (0.6, 0.6)])
def test_slides_off_as_a_chain(lying, hanging):
    """Without friction x'' = g (x + r) / L, where x hangs: what lies on the edge pulls with w r."""
    model, cable = over_the_edge(hanging, lying, 0.0)
    run = ancf.simulate(model, t_end=0.3, step=1e-3, output_step=0.01)
    r = R + 0.5 * D
    length = lying + hanging + 0.5 * math.pi * r
    way = (hanging + r) * (np.cosh(math.sqrt(G / length) * run.t) - 1.0)
    slid = run.position(cable.start)[:, 0] + lying
    assert slid[-1] == pytest.approx(way[-1], rel=0.02)
    assert abs(run.energy.drift).max() < 1e-3 * run.energy.kinetic[-1]
