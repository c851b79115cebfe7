"""A model comes out of its description and out of a results file as it went in, to the last bit."""

import json

import h5py
import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.model.bodies.rigid import as_inertia
from ancf.system.system import System
from helpers import SOLIDS, arc, square

ELEMENTS = ("cable", *SOLIDS)


def again(model):
    """What JSON leaves of a model."""
    return ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))


def arrays(value, path=""):
    """All numbers in nested tuples of arrays, by their place."""
    if isinstance(value, np.ndarray):
        yield path, value
    elif isinstance(value, Batches):  # in compiled code addresses
        yield from arrays(tuple(value), path)
    elif isinstance(value, tuple):
        names = getattr(value, "_fields", range(len(value)))
        for name, part in zip(names, value, strict=True):
            yield from arrays(part, f"{path}.{name}")
    elif isinstance(value, int | float | bool):
        yield path, np.asarray(value)


def assert_same_system(model, other):
    """Every number that the kernels work on is the same bit by bit, also those of the initial state."""
    one, two = System(model), System(other)
    mine, theirs = dict(arrays(one.core)), dict(arrays(two.core))
    assert mine.keys() == theirs.keys()
    for name in mine.keys() - {".ws"}:
        assert np.array_equal(mine[name], theirs[name], equal_nan=True), name
    for a, b in zip(one.initial_state(), two.initial_state(), strict=True):
        assert np.array_equal(a, b)


def crooked(element, rng):
    """Bodies in places and directions whose numbers have all digits."""
    model = ancf.Model(gravity=rng.normal(size=3), title="crooked")
    section = square(element, EA=2e3, EI=0.1, rhoA=0.4, damping=0.1, axial_damping=1 / 3)
    start, end = rng.normal(size=3), 3 + rng.normal(size=3)
    given = {"section": section, "element": element, "elements": 3}
    line = model.add_beam("line", start=start, end=end, y_axis=rng.normal(size=3), **given)
    line.set_motion(rng.normal(size=3), rng.normal(size=3), about=rng.normal(size=3))
    model.add_beam("slack", start=start, end=end, length=1.1 * float(np.linalg.norm(end - start)), **given)
    pulled = model.add_beam("pulled", start=end, end=start, **given)
    pulled.node_position[1] += 0.01 * rng.normal(size=3)  # as lines do that hang
    bow = model.add_beam("bow", path=arc, y_axis=rng.normal(size=3), **given)
    points = np.cumsum(1 + rng.random((5, 3)), axis=0)
    nodes = np.sort(rng.random(2)) * 2
    uneven = {**given, "length": 2.0, "nodes": [0.0, *nodes, 2.0], "natural_shape": "straight"}
    del uneven["elements"]
    model.add_beam("spline", path=points, **uneven)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes *= np.sign(np.linalg.det(axes))
    hub = model.add_rigid_body("hub", at=line.end.initial_position, mass=1 / 3, inertia=SPREAD, axes=axes)
    hub.set_motion(rng.normal(size=3), rng.normal(size=3))
    model.add_point_mass("bead", at=rng.normal(size=3), mass=0.1).set_motion(rng.normal(size=3))
    model.clamp(bow.start, rotation="sin(t)", axis=rng.normal(size=3), displacement=("t", 0, 1 / 7 * 0))
    model.connect(line.end, hub)
    place = (1 / 3, 0.001 / 7, 0.0) if element in SOLIDS else (1 / 3,)
    model.add_force(line.at(*place), {"t": [0, 1 / 3], "value": [[0, 0, 0], [1 / 7, 0, 1]]})
    model.add_spring(hub.at(1 / 3, 1 / 7, 0), rng.normal(size=3), stiffness=1 / 3, slack=True)
    model.add_contact("bead", bow, stiffness=1e3 / 7, strip=STRIP, normal=NORMAL, s=0.3)
    return model


SOFT = ancf.Section(EA=1e3, EI=0.1, rhoA=0.1)
SPREAD = as_inertia([[2.0, 0.1, 1 / 7], [0.1, 2.0, 0.3], [1 / 7, 0.3, 2.0]], "")
#: Directions for which strip x normal runs along the arc.
STRIP, NORMAL = (0.1, 1.0, 0.0), (0.0, 0.0, 1.0)


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("element", ELEMENTS)
class TestRandomModels:
    def test_description_is_the_same_again(self, element, seed):
        model = crooked(element, np.random.default_rng(seed))
        assert again(model).to_dict() == model.to_dict()

    def test_numbers_are_the_same_bit_by_bit(self, element, seed):
        model = crooked(element, np.random.default_rng(seed))
        assert_same_system(model, again(model))
        for name, body in model.bodies.items():
            for key in ("node_position", "node_tangent", "node_y", "axes", "inertia", "about"):
                if hasattr(body, key):
                    assert np.array_equal(getattr(body, key), getattr(again(model).bodies[name], key)), key


class TestFunctions:
    def model(self):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=SOFT)

        def sway(t):
            return (0.0, 0.1 * t, 0.0)

        model.pin(beam.start, displacement=sway, name="foot")
        model.add_force(beam.end, lambda t: (0, 0, t), name="push")
        bead = model.add_point_mass("bead", at=(0.5, 0, 0), mass=0.1)
        model.slide(bead, along=beam, motion=lambda t: 0.5 + t, name="drive")
        return model

    def test_are_named_and_refuse(self):
        model = again(self.model())
        assert model.missing_functions() == [("foot", "sway"), ("push", "<lambda>"), ("drive", "<lambda>")]
        assert model.to_dict() == self.model().to_dict()
        assert "<function sway>" in str(model)
        for call in (ancf.equilibrium, lambda m: ancf.simulate(m, t_end=0.1, step=0.01)):
            with pytest.raises(ancf.ModelError, match='is the Python function "') as caught:
                call(model)
            assert "build the model with the script" in caught.value.hint

    def test_not_in_model_files(self):
        """What a description says of a function is no formula."""
        model = ancf.Model()
        mass = model.add_point_mass("m", at=(0, 0, 0), mass=1)
        with pytest.raises(ancf.ModelError):
            model.add_force(mass, ("<function f>", 0, 0))


class TestWrongDescriptions:
    @pytest.mark.parametrize(
        ("change", "where", "phrase"),
        [
            (lambda p: p.pop("gravity"), "model.gravity", "is missing"),
            (lambda p: p.update(bodies=3), "bodies", "must be a list"),
            (lambda p: p["bodies"].append(3), "bodies[7]", "must be a table"),
            (lambda p: p["bodies"][0].pop("section"), "bodies[0].section", "is missing"),
            (lambda p: p["bodies"][0]["section"].pop("EA"), "bodies[0].section.EA", "is missing"),
            (lambda p: p["bodies"][3]["node_y"].pop(), "bodies[3].node_y", "3 rows for 4 nodes"),
            (lambda p: p["bodies"][0]["section"].update(EA=-1), "bodies[0].section.EA", "must be > 0"),
            (lambda p: p["bodies"][3]["node_y"][1].__setitem__(0, 3.0), "bodies[3].node_y", "unit vectors"),
            (lambda p: p["bodies"][0].update(type="plate"), "bodies[0].type", "must be one of"),
            (lambda p: p["bodies"][1].update(name="line"), "bodies[1].name", "is the name of a body already"),
            (lambda p: p["bodies"][5].update(mass=-1), "bodies[5].mass", "must be > 0"),
            (lambda p: p["loads"][0].update(type="wind"), "loads[0].type", "there are: force"),
            (lambda p: p["loads"][0].update(size=2), "loads[0]", "size"),
            (lambda p: p["loads"][0].pop("point"), "loads[0]", "point"),
            (lambda p: p["loads"][0].update(point="lime.end"), "loads[0].point", "unknown body"),
            (lambda p: p["connections"][1].update(stiffness="a"), "connections[1].stiffness", "number"),
        ],
    )
    def test_place_and_reason(self, change, where, phrase):
        plain = json.loads(json.dumps(crooked("cable", np.random.default_rng(0)).to_dict()))
        change(plain)
        with pytest.raises(ancf.ModelError) as caught:
            ancf.Model.from_dict(plain)
        assert caught.value.where == where
        assert phrase in caught.value.what

    @pytest.mark.parametrize("given", [None, 3, [], "model", {"title": "a"}])
    def test_no_table(self, given):
        with pytest.raises(ancf.ModelError, match=r"model"):
            ancf.Model.from_dict(given)


def hung(length=1.02):
    """A wire on two pins with a spring, a bead that slides, and one that stands on it."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="hung")
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.3, damping=0.5)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), length=length, elements=4, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    bead = model.add_point_mass("bead", at=(0.3, 0, 0), mass=0.05)
    model.slide(bead, along=wire, name="ring", viscous=0.1)
    head = model.add_point_mass("head", at=(2 / 3, 0, -0.05), mass=0.05)
    model.add_spring(head, (2 / 3, 0, -0.5), stiffness=50.0, length=0.6, damping=0.2, name="mast")
    model.hold(head, position="xy")
    model.add_contact(head, wire, stiffness=1e3, damping=1.0, name="strip")
    model.add_force(bead, ("0.1*sin(9*t)", 0, 0), name="pull")
    model.add_force(head, (0, 0, "-20*sin(100*t)"), name="tear")
    return model


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run in memory, the same in a file, and its start."""
    path = tmp_path_factory.mktemp("run") / "run.h5"
    model = hung()
    start = ancf.equilibrium(model)
    given = {"t_end": 0.06, "step": 1e-3, "output_step": 2e-3, "sensors": ["bead", "strip", "mast"]}
    memory = ancf.simulate(model, start=start, **given)
    ancf.simulate(model, start=start, file=path, **given)
    return memory, path, start


class TestLoaded:
    """A loaded result answers what the one in memory answers."""

    @pytest.mark.parametrize(
        ("question", "item"),
        [
            ("contact_force", "strip"),
            ("contact_gap", "strip"),
            ("contact_offset", "strip"),
            ("arc_length", "strip"),
            ("arc_length", "ring"),
            ("arc_rate", "ring"),
            ("multiplier", "ring"),
            ("spring_force", "mast"),
            ("spring_length", "mast"),
            ("position", "head"),
            ("tension", "wire.at(0.3)"),
        ],
    )
    def test_questions(self, run, question, item):
        memory, path, _ = run
        loaded = ancf.load(path)
        for one, two in (
            (memory, loaded),
            (memory.state(), loaded.state()),
            (memory.state(7), loaded.state(7)),
        ):
            assert np.array_equal(getattr(one, question)(item), getattr(two, question)(item)), question
        assert np.any(getattr(memory, question)(item) != 0.0) or question == "contact_offset"

    def test_contact_opens_and_closes(self, run):
        force = run[0].contact_force("strip")
        assert 0.0 in force
        assert force.max() > 0.1

    def test_energy_notes_and_names(self, run):
        memory, path, _ = run
        loaded = ancf.load(path)
        assert loaded.notes == memory.notes
        assert loaded.state().energy.total == memory.state().energy.total
        assert loaded.model.to_dict() == memory.model.to_dict() == hung().to_dict()
        assert str(loaded.model) == str(memory.model)

    def test_equilibrium_is_the_same_bit_by_bit(self, run):
        """Also the reactions of its supports."""
        state = ancf.equilibrium(ancf.load(run[1]).model)
        assert np.array_equal(state.q, run[2].q)
        for support in ("pin at wire.start", "hold at head"):
            assert np.array_equal(state.reaction(support), run[2].reaction(support))

    def test_later_changes_of_the_model_are_not_in_the_result(self, run):
        model = hung()
        state = ancf.equilibrium(model)
        model.add_point_mass("late", at=(0, 0, 5), mass=1.0)
        model.pin("late")
        assert "late" not in state.bodies
        assert "late" not in str(state)

    def test_file_without_a_model(self, run, tmp_path):
        cases = (
            (lambda m: m.pop("bodies"), "unknown body"),
            (lambda m: m["bodies"][0].update(length=-1.0), r"bodies\[0\].length: must be > 0"),
            (lambda m: m["bodies"][0].update(elements=3), "bodies/wire/slots has shape"),
            (lambda m: m["connections"][0].update(type="rail"), r"connections\[0\].type: is 'rail'"),
        )
        for number, (change, phrase) in enumerate(cases):
            path = tmp_path / f"{number}.h5"
            ancf.load(run[1]).save(path)
            header = json.loads(json.dumps(ancf.load(run[1]).provenance))
            change(header["model"])
            with h5py.File(path, "r+") as file:
                file.attrs["header"] = json.dumps(header)
            with pytest.raises(ancf.ModelError, match=phrase) as caught:
                ancf.load(path)
            assert caught.value.where == str(path)
