"""Generated arguments of the Python face: each call does what it says or refuses with a place.

Every call starts from arguments that are right, of which some are replaced by anything that Python has.
"""

import warnings

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import ancf
from ancf.catenary import Droppers, Line, Span, SteadyArm, Wire
from ancf.cli.summary import node_count, plural, total_mass
from ancf.model import checks
from ancf.model.bodies.axes import carried
from ancf.model.functions.function import TimeFunction
from ancf.model.settings import SimulationSettings
from fuzzing import cases, changed, finite, odd, refused_or_fine

ROPE = {"EA": 4e4, "EI": 2.0, "rhoA": 0.7}
DAMPED = {"damping": 0.1, "axial_damping": 0.2, "bending_damping": 0.3, "slope_damping": 0.0}
MATERIAL = {"E": 6e8, "rho": 1e3, "nu": 0.3, "shear_factors": [0.8, 0.9]}


def base():
    """A model with a body of every kind."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(**ROPE)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section)
    bar = ancf.Section.rectangle(0.03, 0.02, **MATERIAL)
    model.add_beam("bar", start=(0, 0, 1), end=(1, 0, 1), elements=1, section=bar, element="original")
    model.add_rigid_body("hub", at=(2, 0, 0), mass=1.5, inertia=(0.3, 0.4, 0.5))
    model.add_point_mass("tip", at=(1.0, 0, 0), mass=0.3)
    return model, beam


#: Arguments that are right, by the call.
CALLS = {
    "Section": {**ROPE, **DAMPED},
    "rectangle": {"width": 0.03, "height": 0.02, **MATERIAL, **DAMPED, "J": 1e-8},
    "circle": {"diameter": 0.03, **MATERIAL, "J": None},
    "from_moments": {"A": 6e-4, "I_y": 2e-8, "I_z": 4.5e-8, "J": 5e-8, **MATERIAL, "I_yyyy": None},
    "Model": {"gravity": [0, 0, -9.81], "title": "a title"},
    "add_beam": {
        "name": "new",
        "start": [0, 0, 0],
        "end": [1, 1, 0],
        "elements": 2,
        "length": 1.5,
        "strain": "paper",
    },
    "add_beam path": {
        "name": "new",
        "path": [[0, 0, 0], [1, 0, 0], [1, 1, 0.5]],
        "nodes": [0, 0.5, 1.0],
        "length": 1.0,
    },
    "add_beam solid": {
        "name": "new",
        "start": [0, 0, 0],
        "end": [1, 1, 0],
        "elements": 2,
        "y_axis": [0, 0, 1],
    },
    "add_point_mass": {"name": "new", "at": [1, 2, 3], "mass": 1.0},
    "add_rigid_body": {
        "name": "new",
        "at": [1, 2, 3],
        "mass": 1.0,
        "inertia": [1, 1, 1],
        "axes": np.eye(3).tolist(),
    },
    "pin": {"point": "beam.start", "displacement": ["t", 0, 0], "name": "support"},
    "clamp": {
        "point": "beam.start",
        "stretch": "fixed",
        "rotation": "t",
        "axis": [0, 0, 1],
        "displacement": [0, 0, 0],
    },
    "clamp to": {"point": "beam.end", "to": "hub", "stretch": "free", "name": "joint"},
    "hold": {"point": "beam.start", "position": "xz", "slope": "y", "displacement": ["t", 0, 0]},
    "add_force": {"point": "beam.at(1)", "force": [1, "t", 0]},
    "add_moment": {"point": "bar.end", "moment": [1, "t", 0]},
    "add_distributed_load": {"body": "beam", "load": [0, 0, -1], "between": [0.5, 1.5]},
    "connect": {"a": "tip", "b": "beam.at(1)", "name": "joint"},
    "hinge": {"a": "bar.end", "b": "hub.at(-1, 0, 1)", "axis": [0, 1, 0]},
    "slide": {
        "point": "tip",
        "along": "beam",
        "s": 1.0,
        "mass": 0.1,
        "friction": 0.2,
        "viscous": 0.1,
        "at_end": "stop",
    },
    "add_spring": {
        "a": "tip",
        "b": [0, 0, 0],
        "stiffness": 10.0,
        "damping": 1.0,
        "length": 1.0,
        "slack": True,
    },
    "add_contact": {"point": "tip", "along": "beam", "stiffness": 10.0, "damping": 1.0, "strip": [0, 1, 0]},
    "set_motion": {"velocity": [1, 0, 0], "angular_velocity": [0, 1, 0], "about": [0, 0, 0]},
    "at": {"x": 0.5, "y": 0.0, "z": 0.0},
    "point": {"label": "beam.at(0.5)"},
    "Newton": {
        "tolerance": 1e-10,
        "contraction": 0.5,
        "max_iterations": 20,
        "modified": True,
        "corotate": False,
    },
    "GeneralizedAlpha": {"rho_inf": 0.8, "formulation": "ggl"},
    "Trapezoidal": {"formulation": "ggl"},
    "Radau": {"stages": 2, "tolerance": 1e-6, "adaptive": True, "min_step": 1e-6, "max_step": 0.1},
    "Explicit": {"safety": 0.8, "check": True},
    "TimeFunction": {"given": ["t", 1, "sin(t)"]},
    "Span": {"length": 50.0, "droppers": [5.0, 25.0, 45.0], "pre_sag": 0.05},
    "Wire": {"EA": 1e7, "EI": 100.0, "mass": 1.0, "tension": 2e4, "damping": 0.0},
    "Line": {
        "system_height": 1.2,
        "stagger": 0.2,
        "contact_support": "held",
        "anchors": "fixed",
        "gravity": 9.81,
    },
}


def call(name, arguments):
    """Make the call; what it gave, if that can be looked at."""
    model, beam = base()
    if name in ("Section", "Model", "Newton", "GeneralizedAlpha", "Trapezoidal", "Radau", "Explicit"):
        return getattr(ancf, name)(**arguments)
    if name in ("rectangle", "circle", "from_moments"):
        section = getattr(ancf.Section, name)(**arguments)
        finite(section.EA, section.EI_y, section.EI_z, section.rhoA, section.J, section.I_yyyy)
        return section
    if name == "TimeFunction":
        function = TimeFunction(arguments["given"], 3, "here")
        finite(function.table(np.array([0.0, 0.5, 2.0])))
        return function
    if name == "Span":
        span = Span(**arguments)
        finite(span.droppers, span.pre_sag)
        return span
    if name == "Wire":
        wire = Wire(**arguments)
        wire.check("wire")
        finite(wire.wave_speed)
        return wire
    if name == "Line":
        wire = Wire(EA=1e7, EI=100.0, mass=1.0, tension=2e4)
        parts = {"contact_wire": wire, "messenger_wire": wire, "steady_arm": SteadyArm(vertical=0.0)}
        spans = [Span(length=50.0, droppers=(5.0, 25.0, 45.0))] * 2
        line = Line(spans=spans, droppers=Droppers(stiffness=1e5), **parts, **arguments)
        finite(line.supports, line.stagger, line.system_height)
        return line
    if name in ("set_motion", "at"):
        return getattr(beam, name)(**arguments)
    if name.startswith("add_beam"):
        given = ancf.Section(**ROPE)
        if name == "add_beam solid":
            arguments = {"element": "nonlocking", **arguments}
            given = ancf.Section.rectangle(0.03, 0.02, **MATERIAL)
        new = model.add_beam(section=given, **arguments)
        finite(new.length, new.stretch, new.node_x, new.node_position, new.node_tangent, new.node_y)
        return new
    if name == "point":
        return model.point(arguments["label"])
    made = getattr(model, name.split()[0])(**arguments)
    finite(model.size, model.gravity)
    assert str(model)
    return made


@pytest.mark.parametrize("name", CALLS)
def test_right_arguments_are_right(name):
    assert repr(call(name, CALLS[name]))


def only_known(arguments, right):
    """Misspelt and missing keywords are Python's own matter."""
    return {**right, **{key: value for key, value in arguments.items() if key in right}}


@cases(0.23)
@given(data=st.data())
def test_any_arguments(data):
    name = data.draw(st.sampled_from(sorted(CALLS)))
    right = CALLS[name]
    arguments = only_known(data.draw(changed(right, most=2, values=odd)), right)
    if isinstance(arguments.get("elements"), int):
        assume(arguments["elements"] < 10_000)
    with warnings.catch_warnings(), refused_or_fine():
        warnings.simplefilter("ignore")
        assert repr(call(name, arguments))


LETTERS = [
    "t",
    "pi",
    "2",
    "1e9",
    "+",
    "-",
    "*",
    "/",
    "**",
    "(",
    ")",
    "sin",
    "sqrt",
    "where",
    "<",
    ",",
    " ",
    "ramp",
    "t0",
]


@cases(0.07)
@given(
    parts=st.lists(
        st.sampled_from([*LETTERS, "[", "'", "lambda", "0", "log", "step", "max", "and"]), max_size=9
    )
)
def test_formulas(parts):
    with refused_or_fine(), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        function = TimeFunction("".join(parts), 1, "loads[0].force")
        finite(function.table(np.array([0.0, 0.3, 7.0])))


class TestEdges:
    """Limits that generated values seldom meet."""

    def test_limits_of_poissons_ratio(self):
        given = {"width": 1.0, "height": 1.0, "E": 1.0, "rho": 1.0}
        for nu in (-1.0, 0.5, -1.5, 0.6):
            with pytest.raises(ancf.ModelError, match="nu"):
                ancf.Section.rectangle(nu=nu, **given)
        for nu in (np.nextafter(-1.0, 0.0), 0.499999):
            assert ancf.Section.rectangle(nu=nu, **given).G > 0.0

    @pytest.mark.parametrize("size", [5e-324, 1e-200, 1.0, 1e200, 1e308])
    def test_directions_of_any_size(self, size):
        found = checks.direction([size, 0.0, -size], "axis")
        assert found == pytest.approx(np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0))

    def test_a_step_is_no_longer_than_the_run(self):
        SimulationSettings(t_end=1.0, step=1.0)
        with pytest.raises(ancf.ModelError, match="longer than the whole run"):
            SimulationSettings(t_end=1.0, step=1.5)

    def test_counted_words(self):
        assert [plural(k, "step") for k in range(3)] == ["0 steps", "1 step", "2 steps"]

    def test_a_place_a_hair_beyond_the_end_is_the_end(self):
        _, beam = base()
        assert beam.at(2.0 + 1e-10).x == 2.0
        assert beam.at(-1e-10).x == 0.0

    def test_step_of_a_formula_is_there_at_zero(self):
        assert TimeFunction("step(t - 1)", 1, "here").table(np.array([0.9, 1.0, 1.1])).ravel().tolist() == [
            0,
            1,
            1,
        ]

    def test_a_function_that_is_no_number_later_is_refused_then(self):
        function = TimeFunction(lambda t: (np.nan if t > 1 else 0.0, 0.0, 0.0), 3, "loads[0].force")
        with pytest.raises(ancf.ModelError, match=r"at t = 2 s .* must be finite"):
            function.table(np.array([0.0, 0.5, 2.0]))

    def test_axes_are_carried_by_the_smallest_rotation(self):
        """By 1.9 rad: about the normal of both tangents, the axis along it stays."""
        old, new = np.array([[1.0, 0, 0]]), np.array([[np.cos(1.9), np.sin(1.9), 0]])
        for vector, wanted in (((0, 0, 1.0), (0, 0, 1.0)), ((0, 1.0, 0), (-np.sin(1.9), np.cos(1.9), 0))):
            assert carried(np.array([vector]), old, new)[0] == pytest.approx(wanted, abs=1e-15)

    def test_sizes_of_a_model(self):
        model, beam = base()
        assert node_count(model) == 3 + 2 + 1 + 1
        bar = 6e-4 * 1e3 * 1.0
        assert total_mass(model) == pytest.approx(0.7 * beam.length + bar + 1.5 + 0.3)
