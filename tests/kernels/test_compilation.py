"""What is said and done when kernels are compiled: the process that helps, and claims between processes."""

import re
import subprocess

import numba
import pytest

import ancf
from ancf import compilation
from ancf.cli import warmup
from ancf.compiled import _DOES, add_force
from ancf.model.joints.connections import Spring
from ancf.records import RecordType
from ancf.solvers.newmark import advance
from commands import python

#: Kinds that are compiled when they are used first.
RARE = {"ContactBatch", "StateForceBatch", "PressBatch", "RubBatch"}
RARE |= {"StrandBatch", "GripBatch", "BumpBatch", "RollBatch", "WinchedBatch"}


def rope(**more):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1, **more)
    beam = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.pin(beam.start)
    return model, beam


def hung():
    model, beam = rope(bending_damping=1e-4)
    mass = model.add_point_mass("mass", at=(1, 0, 0), mass=1.0)
    model.connect(beam.end, mass)
    model.add_spring(mass, (1, 0, 1), stiffness=10.0, slack=True)
    return model


class TestHelp:
    @pytest.mark.parametrize("made", [lambda: rope()[0], hung], ids=["rope", "hung"])
    def test_the_stepping_is_the_one_that_runs_take(self, made):
        """The types are found without compiling; they are those that a run calls it with."""
        model = ancf.Model.from_dict(made().to_dict())
        dispatcher, signature = compilation.needed(model, ancf.GeneralizedAlpha()).steps
        assert dispatcher is advance
        before = set(advance.overloads)
        ancf.simulate(made(), t_end=0.002, step=1e-3)
        assert set(advance.overloads) - before <= {signature}
        assert signature in advance.overloads

    def test_models_share_the_stepping(self):
        """Without slack springs and contacts: what one model has compiled another does not."""
        mass = ancf.Model()
        mass.add_point_mass("m", at=(0, 0, 0), mass=1.0)
        wanted = compilation.needed(mass, ancf.Trapezoidal()).steps
        assert compilation.needed(rope()[0], ancf.Trapezoidal()).steps == wanted

    @pytest.mark.parametrize("made", [lambda: rope()[0], hung], ids=["rope", "hung"])
    def test_the_operations_are_those_of_the_model(self, made):
        """Found without compiling; then the model is compiled, and nothing else is missing."""
        found = compilation.needed(ancf.Model.from_dict(made().to_dict()), ancf.Trapezoidal())
        model = made()
        springs = [connection.name for connection in model.connections if isinstance(connection, Spring)]
        ancf.simulate(model, t_end=0.002, step=1e-3, sensors=["rope.start", *springs])
        sensors = {kernel.py_func.__name__: (kernel, types) for kernel, types in found.sensors}
        assert len(found.operations) >= 3
        assert [*sensors] == ["note_now", "sample", *["measure_at"] * len(springs)]
        sensors.pop("note_now")
        for dispatcher, signature in [*found.operations, *found.apart, *sensors.values()]:
            assert signature in dispatcher.overloads

    def test_an_equilibrium_needs_more(self):
        """A cable on a rough cylinder: what holds it and lets it go is among what was found."""
        model, beam = rope(diameter=0.01)
        drum = model.add_surface("drum", ancf.Cylinder(at=(0.5, 0, -0.05), axis=(0, 1, 0), radius=0.044))
        model.add_surface_contact(beam, drum, stiffness=1e5, damping=1.0, friction=0.1)
        model.pin(beam.end)
        found = compilation.needed(ancf.Model.from_dict(model.to_dict()), None).resting
        ancf.equilibrium(model)
        names = [kernel.py_func.__name__ for kernel, _ in found]
        assert names == ["press_lost", "press_free", "grip", "renew_limits"]
        assert all(signature in kernel.overloads for kernel, signature in found)

    def test_nothing_helps_where_all_is_there(self, monkeypatch):
        model, _ = rope()
        ancf.simulate(model, t_end=0.002, step=1e-3)
        monkeypatch.setattr(subprocess, "Popen", lambda *_, **__: pytest.fail("a process was started"))
        ancf.simulate(model, t_end=0.002, step=1e-3)

    def test_a_process_helps(self, monkeypatch):
        """A kernel is compiled while a model is expected: a process gets the model, and ends with the run."""
        monkeypatch.delenv("ANCF_HELPS", raising=False)
        monkeypatch.setattr(compilation, "_useful", lambda: True)
        said = []
        monkeypatch.setattr(compilation._listener, "say", said.append)
        model, _ = rope()
        with compilation.expected(model, ancf.Trapezoidal()):
            numba.njit(lambda x: x + 1.0)(2.0)
            helper = compilation._listener.helper
            assert helper.poll() is None
        assert helper.poll() is not None
        assert re.match(r"compiled in \d+ s: ", said[-1])

    @pytest.mark.parametrize(
        ("other", "method", "same"),
        [
            (lambda: rope()[0], ancf.GeneralizedAlpha(), True),
            (lambda: rope(bending_damping=0.0)[0], None, True),
            (lambda: rope()[0], ancf.Explicit(), False),
            (hung, ancf.Trapezoidal(), False),
        ],
        ids=["equilibrium, then steps", "other numbers", "other steps", "other kinds"],
    )
    def test_the_process_works_on_what_is_next(self, monkeypatch, other, method, same):
        monkeypatch.delenv("ANCF_HELPS", raising=False)
        monkeypatch.setattr(compilation, "_useful", lambda: True)
        monkeypatch.setattr(compilation._listener, "say", lambda text: None)
        processes = []
        for model, used in ((rope()[0], None), (other(), method)):
            with compilation.expected(model, used):
                numba.njit(lambda x: x + 1.0)(2.0)
                processes.append(compilation._listener.helper)
                if used is None:  # it may have found all compiled
                    monkeypatch.setattr(processes[0], "poll", lambda: None)
        compilation._listener.end()
        assert (processes[0] is processes[1]) == same

    def test_it_is_said_in_python_too(self):
        """On stderr, before and after, with what it is; a quiet command says nothing."""
        lines = (
            "import ancf, numba",
            "from ancf import compilation",
            "compilation._useful = lambda: False",
            "with compilation.expected(ancf.Model()): numba.njit(lambda x: x + 1)(1)",
        )
        ran = python("\n".join(lines))
        assert ran.out == ""
        first, last = ran.err.splitlines()
        assert first.startswith(
            "ancf: compiling the numerical core, once on this machine: your functions first"
        )
        assert re.fullmatch(r"ancf: compiled in \d+ s: your functions", last)


@pytest.mark.parametrize("name", [name for name, _ in warmup.parts()])
def test_what_warms_up_runs(name):
    dict(warmup.parts())[name]()


def test_warmup_has_every_kind():
    """Kinds of batches that its models have, found without compiling, against all that have operations."""
    found = set()
    for made in (warmup._cable, warmup._beams, warmup._joints, warmup._bead, warmup._surrounded):
        operations = compilation.needed(made(), None).operations
        records = [signature[0] for _, signature in operations if isinstance(signature[0], RecordType)]
        found |= {record.batch.instance_class for record in records}
    own = {kind for kind, stub in _DOES if stub is add_force and kind.__module__.startswith("ancf.")}
    assert {kind.__name__ for kind in own - found} <= RARE
