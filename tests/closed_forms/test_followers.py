"""Forces that turn with what they act on, and pressure, beside closed forms."""

import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals

import ancf
from ancf.errors import ModelError
from ancf.linalg.sparse import to_sparse
from ancf.model.file import parse_study
from ancf.system.core import apply_supports, assemble, residual, restrict
from ancf.system.system import System


def ring(pressure, elements=8, strain="material", EA=1e5, EI=2.0):
    """A quarter of a ring of radius 1.5 m, whose ends slide along the axes of symmetry."""
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=EI, rhoA=0.4)
    arc = model.add_beam(
        "arc",
        path=lambda u: 1.5 * np.array([np.cos(0.5 * np.pi * u), np.sin(0.5 * np.pi * u), 0.0]),
        elements=elements,
        section=section,
        strain=strain,
    )
    model.hold(arc.start, position="y", slope="x")
    model.hold(arc.end, position="x", slope="y")
    for x in arc.node_x:
        model.hold(arc.at(float(x)), position="z", slope="z")
    model.add_pressure(arc, pressure, (0, 0, 1))
    return model, arc


class TestPressure:
    @pytest.mark.parametrize("pressure", [2e3, -800.0])
    def test_an_inflated_ring(self, pressure):
        """N = p r, and r = R (1 + N/EA); its curvature by reference length stays."""
        model, arc = ring(pressure, elements=12, EI=500.0)
        state = ancf.equilibrium(model)
        wanted = 1.5 / (1.0 - pressure * 1.5 / 1e5)
        for x in (0.0, 0.3, 1.1, arc.length):
            assert np.linalg.norm(state.position(arc.at(x))) == pytest.approx(wanted, abs=2e-5)
            assert state.tension(arc.at(x)) == pytest.approx(pressure * wanted, rel=1e-3)

    def test_a_ring_buckles_at_3_EI_by_R3(self):
        """The square of the lowest frequency falls with the pressure from outside, to zero there."""
        critical, squares = 3.0 * 2.0 / 1.5**3, []
        for share in (0.0, 0.5, 0.9):
            model, _ = ring(-share * critical, elements=8, EA=1e4)
            modes = ancf.modes(model, about=ancf.equilibrium(model), count=1)
            squares.append(modes.frequencies[0] ** 2)
        zero = [0.5 / (1.0 - squares[1] / squares[0]), 0.9 / (1.0 - squares[2] / squares[0])]
        assert zero == pytest.approx([1.0, 1.0], rel=5e-3)

    def test_a_hanging_membrane_is_a_circle(self):
        """Between two points, without bending stiffness: N = p r everywhere."""
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.4)
        given = {"section": section, "elements": 16, "natural_shape": "straight", "length": 2.4}
        sheet = model.add_beam("sheet", path=lambda u: (2 * u, 2.4 * u * (u - 1), 0.0), **given)
        model.pin(sheet.start)
        model.pin(sheet.end)
        model.add_pressure(sheet, 50.0, (0, 0, 1))  # to the side of tangent x axis: down
        state = ancf.equilibrium(model)
        force = np.array([state.tension(sheet.at(x)) for x in np.linspace(0.1, 2.3, 9)])
        radius = force.mean() / 50.0
        assert np.ptp(force) < 1e-3 * force.mean()
        length = 2.4 * (1.0 + force.mean() / 1e4)
        assert 2.0 * radius * np.arcsin(1.0 / radius) == pytest.approx(length, rel=1e-3)
        assert state.position(sheet.at(1.2))[1] < -0.5

    def test_what_it_is_not_for(self):
        model = ancf.Model()
        model.add_point_mass("p", at=(0, 0, 0), mass=1.0)
        with pytest.raises(ModelError, match="point mass, pressure acts on a beam"):
            model.add_pressure("p", 1.0, (0, 0, 1))


class TestFollowerForce:
    @staticmethod
    def column(load, elements=6):
        """Eigenvalues s of a cantilever, EI = L = rhoA = 1, pressed along its tangent at the free end."""
        model = ancf.Model()
        section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
        beam = model.add_beam("column", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
        model.clamp(beam.start)
        for x in beam.node_x[1:]:
            model.hold(beam.at(float(x)), position="z", slope="z")
        model.add_follower_force(beam.end, (-load, 0, 0))
        state = ancf.equilibrium(model)
        system = System(model)
        core, free, none = system.core, system.free, np.zeros(system.size)
        system.place(0.0, none.copy(), none.copy(), none.copy())
        M = np.zeros_like(core.A)
        assemble(core.batches, core.ws, state.q, none, M, 1.0, 0.0, 0.0)
        restrict(core.supports, M)
        columns = []
        for i in free:
            both = []
            for h in (1e-6, -1e-6):
                q = state.q.copy()
                q[i] += h
                system.place(0.0, q, none.copy(), none.copy())
                r = np.zeros(system.size)
                residual(core.batches, core.ws, q, none, none, none.copy(), r)
                apply_supports(core.supports, r)
                both.append(r[free])
            columns.append((both[0] - both[1]) / 2e-6)
        K, M = np.array(columns).T, to_sparse(M, system.places).toarray()[np.ix_(free, free)]
        squares = eigvals(K, -M)
        return np.sqrt(squares[np.abs(squares) < 1e4])

    def test_a_pressed_column_flutters_at_20_05(self):
        """Beck's column: two frequencies meet, none vanishes before."""
        assert np.abs(self.column(19.9).real).max() < 0.05
        assert np.abs(self.column(20.2).real).max() > 0.3

    @pytest.mark.parametrize("force", [3.0, 12.0])
    def test_across_the_end_of_a_beam(self, force):
        """EI phi'' = F cos phi from the tip, whose section the force is normal to."""
        model = ancf.Model()
        section = ancf.Section.rectangle(width=0.02, height=0.02, E=7.5e8, rho=1e3, nu=0.0)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section, element="nonlocking"
        )
        model.clamp(beam.start)
        model.add_follower_force(beam.end, (0.0, 0.0, force))
        state = ancf.equilibrium(model, load_steps=4)
        EI = section.EI_y
        found = solve_ivp(
            lambda s, y: [y[1] / EI, force * np.cos(y[0])], (0.0, 1.0), [0.0, 0.0], rtol=1e-10, atol=1e-12
        )
        turn = found.y[0, -1]  # of the tip against the clamp
        normal = state.section_rotation(beam.end)[:, 0]
        assert np.arctan2(abs(normal[2]), normal[0]) == pytest.approx(turn, rel=4e-3)
        assert np.sign(normal[2]) == np.sign(state.position(beam.end)[2]) == 1.0

    def test_a_rigid_body_that_spins(self):
        """m v' = F (cos w t, sin w t): the body drifts and goes round."""
        model = ancf.Model()
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.1, 0.1))
        hub.set_motion(angular_velocity=(0, 0, 3.0))
        model.add_follower_force(hub.centre, ("1 + 0*t", 0.0, 0.5))
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        t = result.t
        wanted = np.column_stack([np.sin(3 * t) / 6, (1 - np.cos(3 * t)) / 6, 0.25 * t])
        assert result.velocity(hub.centre) == pytest.approx(wanted, abs=2e-6)
        assert np.abs(result.energy.drift).max() < 1e-6

    @pytest.mark.parametrize(
        ("force", "said"),
        [
            ((2.0, 0.0, 0.0), "force = (2, 0, 0) N"),
            (("2*t", 0, 0), "force = (2*t, 0, 0) [N]"),
            (lambda t: (t, 0.0, 0.0), "[N]"),
        ],
    )
    def test_told_with_its_unit(self, force, said):
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
        wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.add_follower_force(wire.end, force)
        [row] = [line for line in str(model).splitlines() if line.startswith("follower force at wire.end")]
        assert row.endswith(said)
        with pytest.raises(ModelError, match=r"\.force: must be given: .*\[N\]"):
            model.add_follower_force(wire.end, None)
        assert len(model.loads) == 1

    def test_files_pictures_and_errors(self):
        study = {
            "bodies": [
                {"name": "wire", "section": {"EA": 1e4, "EI": 1, "rhoA": 1}, "start": [0, 0, 0],
                 "end": [1, 0, 0], "elements": 2}
            ],
            "supports": [{"type": "clamp", "point": "wire.start"}],
            "loads": [
                {"type": "follower_force", "point": "wire.end", "force": ["2*t", 0, 0]},
                {"type": "pressure", "body": "wire", "pressure": 3.0, "axis": [0, 2, 0]},
            ],
        }  # fmt: skip
        model = parse_study(study).model
        again = ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))
        results = [ancf.simulate(m, t_end=0.1, step=1e-3) for m in (model, again)]
        assert np.array_equal(results[0].q, results[1].q)
        assert "3 N/m, axis" in str(model)
        from ancf.viz.scene.compose import make_scene

        arrows = {arrow.name: arrow.ends for arrow in make_scene(results[0]).arrows}
        along = arrows["follower force at wire.end"][-1, 0]
        tip = results[0].slope("wire.end")[-1]
        assert np.cross(along[1] - along[0], tip) == pytest.approx(0.0, abs=1e-12)
        normal = arrows["pressure on wire"][-1]
        assert (normal[-1, 1] - normal[-1, 0]) @ tip == pytest.approx(0.0, abs=1e-12)
        study["loads"][0]["force"] = [1.0, 2.0, 0.0]
        with pytest.raises(ModelError, match=r"loads\[0\]\.force.*across the tangent.*wire.*nonlocking"):
            parse_study(study)
