"""Pantographs in steps one by one, whole lines and such of which spans sleep, beside runs."""

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.solvers.sleeping.far import LOOKED
from ancf.system.far import ASLEEP, RATE
from overhead_lines import COARSE, STEP, collector, droppers, short_line

SETTINGS = {"speed": 60.0, "pantograph": collector(), "mesh": COARSE, "step": STEP}
TWO = {"spacing": 30.0, "start": 12.0}
LONG = {"spans": [catenary.Span(length=36.0, droppers=droppers(36.0))] * 8, "stagger": 0.2}


def steps(line, count, **given):
    """A stepper after some steps, and what its pantographs were before each, (steps, pantographs, 5)."""
    run = catenary.stepper(line, **SETTINGS | given)
    seen = []
    for _ in range(count):
        seen.append([run.pantograph(k) for k in range(len(run.collectors))])
        run.advance()
    return run, np.array(seen)


@pytest.mark.parametrize("reduce", [False, True])
@pytest.mark.parametrize("given", [{}, TWO, {"contact_damping": 50.0}], ids=["one", "two", "damped"])
def test_steps_are_those_of_a_run(given, reduce):
    line = short_line(**LONG) if given is TWO else short_line(height=(0.0, 0.0, 0.03, 0.06, 0.06, 0.06))
    whole = catenary.run(line, **SETTINGS, **given, reduce=reduce)
    _, seen = steps(line, 250, **given, reduce=reduce)
    for k, one in enumerate(whole.recordings):
        wanted = np.stack([one.position, one.force, one.height, one.stagger, one.strip], axis=1)
        assert seen[:, k] == pytest.approx(wanted[:250], rel=1e-9, abs=1e-9)


def test_sliding_joints_too():
    line, given = short_line(), {"contact": "joint", "contact_stiffness": 50e3}
    whole = catenary.run(line, **SETTINGS, **given)
    _, seen = steps(line, 120, **given)
    assert seen[:, 0, 1] == pytest.approx(whole.recordings[0].force[:120], rel=1e-7)


def sleepers(run):
    """Number of the parts that sleep."""
    return int(run._run.far.far.counts[1])


@pytest.fixture(scope="module")
def late():
    """Steppers of the same line at the same time: whole, and with spans that sleep."""
    line = short_line()
    return [steps(line, 400, reduce=reduce)[0] for reduce in (False, True)]


def test_questions_about_spans_that_sleep(late):
    whole, less = late
    assert sleepers(less) >= 2
    for wire in whole.overhead.contact_wires + [b for w in whole.overhead.messengers for b in w.beams]:
        for share in np.linspace(0.03, 0.97, 21):
            point = f"{wire.name}.at({share * wire.length})"
            assert np.abs(less.position(point) - whole.position(point)).max() < 2e-4
            assert np.abs(less.velocity(point) - whole.velocity(point)).max() < 2e-2
    forces = [[run.spring_force(d) for d in run.overhead.droppers] for run in late]
    assert np.abs(np.subtract(*forces)).max() < 0.03 * np.ptp(forces[0])


def test_reactions_and_energies_are_of_the_whole_line(late):
    """At the ends of the wires, in spans that sleep and in others."""
    whole, less = late
    for name in whole.model.supports:
        wanted, mine = whole.reaction(name), less.reaction(name)
        assert np.abs(mine - wanted).max() < 5e-3 * max(np.abs(wanted).max(), 100.0)
    for mine, wanted in ((less, whole), (less.state(), whole.state())):
        assert float(mine.energy.strain) == pytest.approx(float(wanted.energy.strain), rel=1e-3)
        assert float(mine.energy.potential) == pytest.approx(float(wanted.energy.potential), rel=1e-3)
        # J; nearly all of it is that of the pantograph along the track, of spans that sleep 0.4
        assert float(mine.energy.kinetic) == pytest.approx(float(wanted.energy.kinetic), abs=0.05)


def test_a_state_stays_as_it_is_while_spans_wake_and_sleep():
    run = catenary.stepper(short_line(), **SETTINGS, reduce=True)
    run.advance(150)
    state, energy, support = run.state(), run.energy, next(iter(run.model.supports))
    reaction = run.reaction(support)
    assert state.energy.strain == energy.strain
    run.advance(300)
    assert state.energy.strain == energy.strain
    assert state.reaction(support) == pytest.approx(reaction, rel=1e-3)


def test_a_result_is_of_the_whole_line():
    """Of supports in spans that slept to the end."""
    results = [
        catenary.run(short_line(), **SETTINGS, reduce=r, output_step=0.5).result for r in (False, True)
    ]
    for name in results[0].model.supports:
        wanted, mine = (result.reaction(name)[-1] for result in results)
        assert np.abs(mine - wanted).max() < 5e-3 * max(np.abs(wanted).max(), 100.0)


def test_asking_changes_nothing():
    line = short_line()
    plain, curious = (catenary.stepper(line, **SETTINGS, reduce=True) for _ in range(2))
    support = next(iter(curious.model.supports))
    for _ in range(150):
        plain.advance()
        curious.advance()
        _ = curious.q, curious.reaction(support), curious.energy
    curious.state()
    assert np.array_equal(plain.q, curious.q)
    assert np.array_equal(plain.v, curious.v)


@pytest.mark.parametrize("reduce", [False, True])
def test_inputs_push(reduce):
    """A controller's run and the same inputs between steps are one; spans that sleep change little of it."""
    line = short_line()

    def force(t):
        return 30.0 * np.sin(25.0 * t)

    def controller(run):
        missing = run.contact_force("pantograph contact") - 120.0
        run.inputs["pantograph_force"] = force(run.t) + 0.05 * missing

    whole = catenary.run(line, **SETTINGS, controller=controller, reduce=reduce)
    run = catenary.stepper(line, **SETTINGS, reduce=reduce)
    mine = []
    for _ in range(250):
        mine.append(run.pantograph().force)
        run.inputs["pantograph_force"] = float(force(run.t) + 0.05 * (mine[-1] - 120.0))
        run.advance()
    assert mine == pytest.approx(whole.recordings[0].force[:250].tolist(), rel=1e-9)
    free = catenary.run(line, **SETTINGS, reduce=reduce).recordings[0].force[:250]
    assert np.std(mine - free) > 5.0


@pytest.mark.parametrize("delay", [0.0, 4e-3])
def test_a_controller_asks_for_pantographs(delay):
    """What it is told at each step is what the run records there; with a dead time as well."""
    told = []

    def controller(run):
        told.append((run.t, run.pantograph(0), run.pantograph(1)))
        run.inputs["pantograph_1_force"] = 0.0

    made = catenary.run(
        short_line(), speed=40.0, pantograph=collector(), spacing=30.0, step=STEP, mesh=COARSE, start=5.0,
        window=(98.0, 100.0), until=101.0, controller=controller, control_delay=delay,
    )  # fmt: skip
    assert len(told) > 100
    for t, *both in told:
        j = int(np.argmin(np.abs(made.t - t)))
        for k, one in enumerate(both):
            assert one.force == pytest.approx(made.recordings[k].force[j], abs=1e-9)
            for name in ("position", "height", "stagger", "strip"):
                recorded = getattr(made.recordings[k], name)[j]
                assert getattr(one, name) == pytest.approx(recorded, abs=1e-9)
    with pytest.raises(ancf.ModelError, match=r"pantograph\.number"):
        catenary.run(
            short_line(), speed=40.0, pantograph=collector(), step=STEP, mesh=COARSE, window=(66.0, 70.0),
            until=71.0, controller=lambda run: run.pantograph(1),
        )  # fmt: skip


def test_a_controller_feels_the_same_line():
    line = short_line()

    asked = []

    def controller(run):
        asked[-1].append(run.t)
        run.inputs["pantograph_force"] = 0.3 * (120.0 - run.contact_force("pantograph contact"))

    led, runs = {"controller": controller, "control_step": 4e-3}, []
    for reduce in (False, True):
        asked.append([])
        runs.append(catenary.run(line, **SETTINGS, **led, reduce=reduce))
    assert np.diff(asked[0]) == pytest.approx(4e-3)
    assert asked[1] == pytest.approx(asked[0], abs=1e-12)
    forces = [run.recordings[0].force for run in runs]
    assert np.sqrt(np.mean(np.square(np.subtract(*forces)))) < 0.05 * np.std(forces[0])


@pytest.mark.parametrize("speed", [0.0, 1e-3, 0.5, 2.0])
def test_a_slack_dropper_wakes_its_span(speed):
    """A contact wire that is thrown upwards leaves its droppers, of which modes know nothing."""
    run = catenary.stepper(short_line(), **SETTINGS, reduce=True)
    run.advance(60)
    spans = run._run.far
    k = int(np.flatnonzero(spans.far.part[:, ASLEEP])[0])
    part, kind = spans.parts[k], spans.kinds[spans.kind_of[k]]
    thrown = speed * np.isin(part.inner, run._run.system.slots["contact"][:, 0] + 2)
    assert thrown.any() == (speed > 0.0)
    spans._put(k, RATE, spans._get(k, RATE) + kind.project @ thrown)
    run.advance(2 * LOOKED)
    assert (spans.far.part[k, ASLEEP] == 0) == (speed > 0.1)


@pytest.mark.parametrize("force", [1e10, 1e12])
def test_after_a_step_that_failed_spans_sleep_on(force):
    """The strip passes through the wire within a step, which is taken in parts with the whole line awake."""
    run = catenary.stepper(short_line(), **SETTINGS, reduce=True)
    run.advance(60)
    before, retries = sleepers(run), run.stats.retries
    run.inputs["pantograph_force"] = force
    run.advance(3)
    assert run.stats.retries > retries
    assert np.all(np.isfinite(run.q))
    assert sleepers(run) == before > 0


def test_saved_and_gone_on_with(tmp_path):
    run = catenary.stepper(short_line(), **SETTINGS, reduce=True)
    run.advance(100)
    run.save(tmp_path / "stop.h5")
    state = ancf.load(tmp_path / "stop.h5").state()
    assert state.t == pytest.approx(run.t)
    assert np.abs(state.q - run.q).max() < 1e-12
    again = ancf.stepper(run.model, start=tmp_path / "stop.h5")  # the whole line
    again.advance(20)
    run.advance(20)
    assert again.position("pantograph mass 2") == pytest.approx(run.position("pantograph mass 2"), abs=2e-4)


@pytest.mark.parametrize("given", [{"start": 150.0}, TWO | {"start": 120.0}], ids=["one", "two"])
@pytest.mark.parametrize("speed", [60.0, [(0.0, 40.0), (1.0, 60.0)]])
def test_the_end_of_the_line(speed, given):
    """Which the first pantograph reaches first."""
    line = short_line()
    run = catenary.stepper(line, **SETTINGS | {"speed": speed} | given)
    with pytest.raises(ancf.ModelError, match=r"advance\.steps.*end of the line, 166 m, after \d+ steps"):
        run.advance(1000)
    run.advance(run._last)
    assert 165.8 < run.pantograph().position <= 166.0
    with pytest.raises(ancf.ModelError, match="after 0 steps"):
        run.advance()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"reduce": "yes"}, r"catenary\.stepper\.reduce"),
        ({"reduce": True, "contact": "joint"}, r"catenary\.stepper\.reduce.*joint"),
        ({"integrator": ancf.Radau()}, r"catenary\.stepper\.integrator"),
        ({"integrator": 3}, r"catenary\.stepper\.integrator"),
        ({"start": 500.0}, "start"),
        ({"pantograph": "unknown"}, "pantograph"),
        ({"step": -1.0}, "step"),
    ],
)
def test_bad_input(given, said):
    with pytest.raises(ancf.ModelError, match=said):
        catenary.stepper(short_line(), **SETTINGS | given)


@pytest.mark.parametrize("number", [1, -1, "first", 0.5])
def test_no_such_pantograph(number):
    run = catenary.stepper(short_line(), **SETTINGS)
    with pytest.raises(ancf.ModelError, match=r"pantograph\.number"):
        run.pantograph(number)


@pytest.mark.parametrize("count", [0, -1, "two", 1.5])
def test_no_number_of_steps(count):
    run = catenary.stepper(short_line(), **SETTINGS)
    with pytest.raises(ancf.ModelError, match=r"advance\.steps"):
        run.advance(count)
