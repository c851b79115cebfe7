"""The command line: what each command prints and writes, its exit codes, and how it ends when stopped."""

import json
import re
from pathlib import Path

import pytest

import ancf
from ancf.cli.app import app
from ancf.cli.screen import _Lines, duration
from ancf.cli.summary import coordinate
from ancf.model.file import parse_study
from commands import EQUILIBRIUM, FORCE, LONG, MODEL, SIMULATION, write

# run


def test_run_writes_results_and_summary(call):
    ran = call("run", write(MODEL + SIMULATION), "-o", "a/b")
    assert ran.code == 0
    result = ancf.load("a/b/results.h5")
    assert result.status == "complete"
    assert len(result.t) == 1601
    assert result.position("beam.end")[-1] == pytest.approx([0.5960180, 0, -0.7276397], abs=2e-7)
    for text in ("Cantilever [1] of Größe 1: complete", "beam.end", "0.596018", "-0.727640", "written: a/b"):
        assert text in ran.out


def test_summary_of_a_simulation(call):
    call("run", write(MODEL + SIMULATION), "-o", "out")
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    result = ancf.load("out/results.h5")
    assert summary["title"] == "Cantilever [1] of Größe 1"
    assert (summary["status"], summary["kind"], summary["t"]) == ("complete", "simulation", 0.4)
    assert summary["stored_times"] == 1601
    assert summary["model"]["elements"] == 4
    assert summary["model"]["mass"] == pytest.approx(0.05)
    assert summary["settings"]["simulation"]["step"] == 2.5e-4
    tip = summary["outputs"]["beam.end"]
    assert tip["position"] == pytest.approx(result.position("beam.end")[-1])
    assert tip["velocity"] == pytest.approx(result.velocity("beam.end")[-1])
    assert tip["tension"] == pytest.approx(result.tension("beam.end")[-1])
    assert tip["support"] is None
    assert summary["energy"]["start"]["total"] == pytest.approx(result.energy.total[0])
    assert summary["energy"]["end"]["kinetic"] == pytest.approx(result.energy.kinetic[-1])
    assert 0 <= summary["energy"]["balance_drift"] < 1e-6
    assert summary["counters"]["steps"] == 1600
    assert summary["counters"]["newton_iterations"] >= 1600
    assert summary["versions"]["ancf"] == ancf.__version__
    assert 0 < summary["cpu_seconds"] <= summary["process_cpu_seconds"]
    assert summary["wall_seconds"] > 0
    assert "error" not in summary


SUNK = """
[[bodies]]
type = "point_mass"
name = "bob"
at = [0, 0, -1]
mass = 1.0
[[grounds]]
name = "floor"
height = -0.5
stiffness = 1.0
"""
PRESSED = """
[[supports]]
type = "clamp"
point = "beam.end"
displacement = [-0.001, 0, 0]
"""


def test_notes_of_a_summary(call):
    """Those of the result, and of an equilibrium, each once."""
    for more, about in (
        (SIMULATION.replace("0.4", "0.01") + SUNK, "below the ground"),
        (EQUILIBRIUM + PRESSED, "pressed"),
    ):
        path = write(
            MODEL.replace("gravity = [0, 0, -9.81]", "").replace("rho =", "diameter = 0.01\nrho =") + more
        )
        assert call("run", path, "-q").code == 0
        notes = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))["notes"]
        result = ancf.load("out/results.h5")
        assert notes == (result.notes if "simulation" in more else result.state().notes)
        assert sum(about in note for note in notes) == 1


def test_resumed_run(call):
    """A later t_end in the file, then --resume: one history, one summary."""
    sensors = 'sensors = ["beam.end"]\n'
    path = write(MODEL + SIMULATION.replace("0.4", "0.1") + sensors)
    assert call("run", path, "-q").code == 0
    first = ancf.load("out/results.h5")
    write(MODEL + SIMULATION.replace("0.4", "0.15") + sensors)
    ran = call("run", path, "--resume")
    assert ran.code == 0, ran.err
    result = ancf.load("out/results.h5")
    assert (result.status, result.t[-1], len(result.t)) == ("complete", 0.15, 601)
    assert [entry["t"] for entry in result.provenance["resumed"]] == [first.t[-4]]  # the rest knew its end
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert (summary["t"], summary["stored_times"], summary["counters"]["steps"]) == (0.15, 601, 600)
    assert len(Path("out/sensors.csv").read_text(encoding="utf-8").splitlines()) == 602


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        (MODEL.replace("E = 1e8", "E = 2e8") + SIMULATION, "is of another model"),
        (
            MODEL + SIMULATION.replace("2.5e-4", "1e-4"),
            "was computed with step = 0.00025, the model",
        ),
        (MODEL + SIMULATION + 'integrator = "radau"\n', "was computed with integrator = 'trapezoidal'"),
        (MODEL + SIMULATION.replace("0.4", "0.005"), "has reached t = 0.01 s"),
        (MODEL + EQUILIBRIUM, "asks for no simulation"),
    ],
)
def test_resumed_run_is_refused(call, text, phrase):
    path = write(MODEL + SIMULATION.replace("0.4", "0.01"))
    assert call("run", path, "-q").code == 0
    before = Path("out/results.h5").read_bytes()
    ran = call("run", write(text), "--resume")
    assert ran.code == 2
    assert phrase in ran.err
    assert Path("out/results.h5").read_bytes() == before


@pytest.mark.parametrize("more", [[], ["-q"]])
def test_resumed_run_that_is_complete(call, more):
    """Nothing to do is no error: a loop that always resumes ends well, with summary and table."""
    path = write(MODEL + SIMULATION.replace("0.4", "0.01") + 'sensors = ["beam.end"]\n')
    assert call("run", path, "-q").code == 0
    files = [Path("out/results.h5"), Path("out/sensors.csv")]
    before = [file.read_bytes() for file in files]
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    for _ in range(2):
        ran = call("run", path, "--resume", *more)
        assert ran.code == 0, ran.err
        assert (
            "results.h5 is complete up to t = 0.01 s, there is nothing to do" in ran.said + ran.out
        ) != bool(more)
        assert [file.read_bytes() for file in files] == before
    again = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    for key in summary.keys() - {"wall_seconds", "process_cpu_seconds"}:
        assert again[key] == summary[key]


def test_resumed_run_without_a_file(call):
    ran = call("run", write(MODEL + SIMULATION), "--resume")
    assert ran.code == 2
    assert "out/results.h5: there is no such file" in ran.err


def test_run_with_other_values(call):
    """As if the file had them; the summary says which they were."""
    path = write(MODEL + SIMULATION.replace("0.4", "0.01"))
    assert (
        call("run", path, "-q", "--set", "sections.strip.E=5e7", "--set", "bodies.beam.elements=2").code == 0
    )
    beam = ancf.load("out/results.h5").model.beams["beam"]
    assert (beam.section.E, beam.elements) == (5e7, 2)
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert summary["set"] == {"sections.strip.E": 5e7, "bodies.beam.elements": 2}
    assert call("check", path, "--set", "sections.strip.E=5e7").code == 0


@pytest.mark.parametrize(
    ("given", "phrase"),
    [
        ("sections.strap.E=1", "sections.strap.E"),
        ("sections.strip.E=-1", "must be > 0, is -1"),
        ("sections.strip.E=1,5", "must be a number, is '1,5' (str)"),
        ("sections.strip.E", "must be PATH=VALUE"),
    ],
)
@pytest.mark.parametrize("command", ["run", "check"])
def test_other_values_that_are_wrong(call, command, given, phrase):
    ran = call(command, write(MODEL + SIMULATION), "--set", given)
    assert ran.code == 2
    assert phrase in ran.said
    assert not Path("out").exists()


def test_results_have_no_values_to_set(call):
    assert call("run", write(MODEL + EQUILIBRIUM), "-q").code == 0
    ran = call("check", "out/results.h5", "--set", "title=x")
    assert ran.code == 2
    assert "changes model files and line files" in ran.said


def test_quiet_run_prints_nothing(call):
    ran = call("run", write(MODEL + SIMULATION), "--quiet")
    assert (ran.code, ran.out, ran.err) == (0, "", "")
    assert Path("out/summary.json").exists()


def test_without_a_terminal_a_line_for_every_tenth(call):
    said = []
    lines = _Lines(said.append)
    for step in range(0, 1001, 7):
        lines(type("Progress", (), {"step": step, "steps": 1000, "t": 0.1 * step, "t_end": 100.0}))
    assert len(said) == 9
    assert said[0].startswith(" 10 %  step 105 of 1000, t = 10.5 s")
    ran = call("run", write(MODEL + SIMULATION))
    assert "100 %  step 1600 of 1600, t = 0.4 s" in ran.err
    assert "\x1b" not in ran.err + ran.out


def test_default_outputs_are_start_middle_and_end(call):
    ran = call("run", write(MODEL + SIMULATION.replace('outputs = ["beam.end"]', "")))
    assert ran.code == 0
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert list(summary["outputs"]) == ["beam.start", "beam.at(0.5)", "beam.end"]


def test_statics_alone(call):
    ran = call("run", write(MODEL + EQUILIBRIUM + "load_steps = 2\n"))
    assert ran.code == 0
    assert "clamp at beam.start" in ran.out
    result = ancf.load("out/results.h5")
    assert len(result.t) == 1
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert summary["kind"] == "equilibrium"
    assert summary["outputs"]["beam.start"]["support"] == "clamp at beam.start"
    assert summary["outputs"]["beam.end"]["velocity"] == [0, 0, 0]
    state = ancf.equilibrium(parse_study_of(MODEL).model)
    assert summary["outputs"]["beam.end"]["position"] == pytest.approx(state.position("beam.end"), abs=1e-9)
    assert result.position("beam.end")[0] == pytest.approx(state.position("beam.end"), abs=1e-9)


def parse_study_of(text):
    import tomllib

    return parse_study(tomllib.loads(text))


def test_start_from_equilibrium(call):
    start = SIMULATION + 'start = "equilibrium"\nintegrator = { type = "generalized_alpha", rho_inf = 0.8 }\n'
    assert call("run", write(MODEL + start)).code == 0
    tip = ancf.load("out/results.h5").position("beam.end")
    assert tip[-1] == pytest.approx(tip[0], abs=1e-6)
    assert tip[0, 2] < -0.1


def test_equilibrium_of_some_bodies(call):
    second = (
        '[[bodies]]\nname = "free"\nstart = [0, 1, 0]\nend = [1, 1, 0]\nelements = 2\nsection = "strip"\n'
    )
    start = SIMULATION + 'start = "equilibrium"\nequilibrium_of = ["beam"]\n'
    assert call("run", write(MODEL + second + start)).code == 0
    result = ancf.load("out/results.h5")
    assert result.position("beam.end")[0, 2] < -0.1
    assert result.position("free.end")[0] == pytest.approx([1, 1, 0], abs=1e-12)
    assert result.position("free.end")[-1, 2] == pytest.approx(-9.81 / 2 * 0.4**2)


# bad input

SECTION = 'section = "strip"'
WRONG = {
    "unknown key": ("elements = 4", "elements = 4\nelemnts = 4", "bodies[0].elemnts"),
    "wrong type": ("elements = 4", 'elements = "four"', "bodies[0].elements"),
    "missing modulus": ("E = 1e8", "", "sections.strip.E"),
    "missing step": ("step = 2.5e-4", "", "simulation.step"),
    "negative stiffness": (SECTION, "section = { EA = -1, EI = 1, rhoA = 1 }", "bodies[0].section.EA"),
    "NaN stiffness": ("E = 1e8", "E = nan", "sections.strip.E"),
    "zero elements": ("elements = 4", "elements = 0", "bodies[0].elements"),
    "unknown section": (SECTION, 'section = "stripe"', "bodies[0].section"),
    "unknown body": ('"beam.start"', '"baem.start"', "supports[0].point"),
    "unknown output": ('["beam.end"]', '["beam.tip"]', "simulation.outputs[0]"),
    "duplicate name": ("[[supports]]", "[[bodies]]\nname = 'beam'\n[[supports]]", "bodies[1]"),
    "coincident ends": ("end = [1, 0, 0]", "end = [0, 0, 0]", "bodies[0].end"),
    "wrong number": ("end = [1, 0, 0]", "end = [1, 0]", "bodies[0].end"),
    "load of a wrong shape": (
        "[simulation]",
        FORCE.format(force="[0, 1]") + "[simulation]",
        "loads[0].force",
    ),
    "load that raises": (
        "[simulation]",
        FORCE.format(force='[0, 0, "1/t"]') + "[simulation]",
        "loads[0].force",
    ),
    "load with an unknown name": (
        "[simulation]",
        FORCE.format(force='[0, 0, "sine(t)"]') + "[simulation]",
        "loads[0].force",
    ),
    "step too long for the end": ("step = 2.5e-4", "step = 1.0", "simulation.step"),
    "syntax": ("elements = 4", "elements = = 4", "model.toml, line 14"),
    "nothing to compute": (SIMULATION, "", "nothing to compute"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_model_file(call, case):
    old, new, where = WRONG[case]
    text = MODEL + SIMULATION
    assert old in text
    ran = call("run", write(text.replace(old, new, 1)), "-o", "out")
    assert ran.code == 2
    assert ran.out == ""
    assert ran.err.startswith("error: ")
    assert where in ran.err
    assert not Path("out").exists()


def test_several_problems_come_together(call):
    text = (MODEL + SIMULATION).replace("E = 1e8", "E = -1").replace("elements = 4", "elements = 0")
    ran = call("check", write(text))
    assert ran.code == 2
    assert ran.err.splitlines()[0] == "error: model.toml: 2 problems:"
    assert "bodies[0].elements" in ran.err
    assert "sections.strip.E" in ran.err


@pytest.mark.parametrize("command", ["run", "check", "info"])
def test_files_that_cannot_be_read(call, command, tmp_path):
    write(MODEL)
    assert call(command, "modell.toml").code == 2
    ran = call(command, tmp_path)
    assert ran.code == 2
    assert "folder" in ran.err
    Path("latin.toml").write_bytes('title = "Größe"'.encode("latin-1"))
    ran = call(command, "latin.toml")
    assert ran.code == 2
    assert "UTF-8" in ran.err


def test_misspelt_file_gets_a_hint(call):
    write(MODEL)
    ran = call("run", "modell.toml")
    assert ran.err == 'error: modell.toml: no such file\n  did you mean "model.toml"?\n'


@pytest.mark.parametrize("place", ["file", "file/below", "out/results.h5", "out/summary.json"])
def test_unwritable_output_is_found_before_computing(call, place):
    Path("file").write_text("a regular file stands here")
    folder = Path("file/below" if place == "file/below" else "file" if place == "file" else "out")
    if place.startswith("out"):
        Path(place).mkdir(parents=True)
    ran = call("run", write(MODEL + LONG), "-o", folder)
    assert ran.code == 2
    assert "cannot be written" in ran.err
    assert place in ran.err


@pytest.mark.parametrize("wrong", [["run"], ["run", "a", "b"], ["run", "--loud", "a"], ["fly"], ["info"]])
def test_wrong_usage(call, wrong):
    ran = call(*wrong)
    assert ran.code == 2
    assert "Usage: ancf" in ran.err


# failed solves


def test_floating_body(call):
    floats = MODEL[: MODEL.index("[[supports]]")] + EQUILIBRIUM
    for command in ("check", "run"):
        ran = call(command, write(floats))
        assert ran.code == 2
        assert 'error: supports: nothing holds "beam" in x, y, z: it floats' in ran.err


def test_failed_simulation_keeps_what_was_computed(call):
    ran = call("run", write(MODEL + FORCE.format(force='[0, 0, "where(t < 0.05, 0, 1e9)"]') + SIMULATION))
    assert ran.code == 1
    assert re.match(r"error: t = 0\.0\d+ s, step \d+", ran.err[ran.err.index("error:") :])
    assert "results up to t = 0.05" in ran.err
    assert "kept in out/results.h5" in ran.err
    result = ancf.load("out/results.h5")
    assert result.status == "failed"
    assert result.t[-1] == pytest.approx(0.05, abs=2e-3)
    summary = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "failed"
    assert summary["error"]["where"].startswith("t = ")
    info = call("info", "out/results.h5")
    assert info.code == 0
    assert "the solve failed; reached t = 0.05" in info.out


def test_a_step_far_too_large(call):
    """Parts of steps bridge a few; a run that goes on so is stopped, and keeps what was computed."""
    text = (MODEL + SIMULATION).replace("elements = 4", "elements = 16")
    ran = call("run", write(text.replace("2.5e-4", "0.2").replace("t_end = 0.4", "t_end = 4.0")))
    assert ran.code == 1
    assert re.search(
        r"error: t = [0-3](\.\d+)? s, step \d+, beam node \d+ .*step 0\.2 s\n  try a step of", ran.err
    )
    result = ancf.load("out/results.h5")
    assert result.status == "failed"
    assert 0.0 < result.t[-1] < 4.0


def test_a_load_that_fails_later_keeps_what_was_computed(call):
    ran = call("run", write(MODEL + FORCE.format(force='[0, 0, "log(0.05 - t)"]') + SIMULATION))
    assert ran.code == 2
    assert "error: loads[0].force: " in ran.err
    assert "at t = 0.05" in ran.err
    assert "results up to t = 0.0" in ran.err
    assert ancf.load("out/results.h5").status == "failed"


# check, info, schema


def test_check(call):
    ran = call("check", write(MODEL + SIMULATION))
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.startswith("model.toml: right; 1 body, 4 elements, 1 support")
    assert "1600 steps of 0.00025 s to t = 0.4 s" in ran.out
    assert not Path("out").exists()


def test_notes_on_what_may_not_be_meant(call):
    text = MODEL[: MODEL.index("[[supports]]")].replace('strain = "paper"', "length = 1.1") + LONG
    text = text.replace("output_step = 2.5e-3", "")
    ran = call("check", write(text))
    assert ran.code == 0
    assert 'note: nothing holds "beam" in x, y, z: it floats' in ran.out
    assert 'note: body "beam" starts 9.09 % shorter than its natural length 1.1 m' in ran.out
    assert "give a longer output_step" in ran.out


def test_info_of_a_model(call):
    ran = call("info", write(MODEL + SIMULATION))
    assert (ran.code, ran.err) == (0, "")
    for text in ("Cantilever [1] of Größe 1", "24 free of 30", "half bandwidth 11", "0.05 kg", "as given"):
        assert text in ran.out


def test_info_of_results(call):
    call("run", write(MODEL + SIMULATION), "-q")
    ran = call("info", "out/results.h5")
    assert (ran.code, ran.err) == (0, "")
    expected = ("Cantilever [1] of Größe 1", "complete", "1601 states, t = 0 ... 0.4 s", "steps 1600", "beam")
    for text in (*expected, "numba"):
        assert text in ran.out


def test_info_of_what_is_no_results_file(call):
    import h5py

    with h5py.File("other.h5", "w") as file:
        file["x"] = 1.0
    Path("text.h5").write_text("this is text")
    Path("empty.h5").write_bytes(b"")
    Path("cut.h5").write_bytes(Path("other.h5").read_bytes()[:100])
    for name in ("other.h5", "text.h5", "empty.h5", "cut.h5"):
        ran = call("info", name)
        assert ran.code == 2
        assert ran.err.startswith(f"error: {name}: ")
        assert "not a results file" in ran.err
    ran = call("info", "none.h5")
    assert (ran.code, ran.err) == (2, "error: none.h5: no such file\n")


def test_schema_is_valid_json_schema(call):
    ran = call("schema")
    assert ran.code == 0
    schema = json.loads(ran.out)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    _check_schema(schema, schema)
    assert call("schema", "-o", "deep/ancf.schema.json").code == 0
    assert json.loads(Path("deep/ancf.schema.json").read_text(encoding="utf-8")) == schema
    assert call("schema", "-o", "model.toml/x").code == 0
    assert call("schema", "-o", "model.toml/x/y").code == 2


TYPES = {"array", "boolean", "integer", "null", "number", "object", "string"}


def _check_schema(part, whole):
    """The rules of JSON Schema for the keywords in use; each reference leads somewhere."""
    assert isinstance(part, dict)
    if "$ref" in part:
        assert part["$ref"].removeprefix("#/$defs/") in whole["$defs"]
    assert part.get("type", "null") in TYPES
    assert isinstance(part.get("description", ""), str)
    assert set(part.get("required", [])) <= set(part.get("properties", {}))
    assert len(set(map(repr, part.get("enum", ["one"])))) == len(part.get("enum", ["one"])) > 0
    parts = [*part.get("properties", {}).values(), *part.get("$defs", {}).values()]
    parts += [*part.get("anyOf", []), *part.get("oneOf", [])] + [part[k] for k in ["items"] if k in part]
    if isinstance(part.get("additionalProperties"), dict):
        parts.append(part["additionalProperties"])
    for inner in parts:
        _check_schema(inner, whole)


def test_version_and_help(call):
    assert call("--version").out == f"ancf {ancf.__version__}\n"
    ran = call("--help")
    assert ran.code == 0
    for command in ("run", "check", "schema", "info", "reproduce"):
        assert re.search(rf"^ +{command} ", ran.out, re.MULTILINE)
        assert call(command, "--help").code == 0


# reproduce


def test_reproduce_of_an_unknown_figure(call):
    ran = call("reproduce", "fig99")
    assert ran.code == 2
    assert "fig99" in ran.err
    assert "fig2" in ran.err


def test_an_internal_error_is_one_block(call, monkeypatch):
    from ancf.cli import info

    def broken(path):
        raise RuntimeError("wheel off")

    monkeypatch.setattr(info, "is_hdf5", broken)
    ran = call("info", write(MODEL))
    assert ran.code == 1
    assert ran.err.startswith("internal error: RuntimeError: wheel off\n")
    monkeypatch.setenv("ANCF_TRACEBACK", "1")
    with pytest.raises(RuntimeError, match="wheel off"):
        app(["info", "model.toml"])


def test_small_words():
    assert [duration(s) for s in (1.26, 75.0, 3700.0)] == ["1.3 s", "1:15 min", "1:01:40 h"]
    assert coordinate(1e-17, [1.0, 1e-17]) == "0.000000"
    assert coordinate(-0.5, [1.0]) == "-0.500000"
