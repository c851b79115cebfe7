"""Every example runs, its file and its script describe one model."""

import runpy

import numpy as np
import pytest

import ancf
from ancf.model.file import read_study
from ancf.paper import cantilever, pendulum, sliding, spin_up
from example_scripts import script
from places import EXAMPLES

WITH_MAIN = ("cantilever", "pendulum", "spin_up", "coupled_wires", "sliding_beam")
#: Scripts of tests/control/test_control_examples.py.
CONTROLLED = ("active_pantograph", "crane", "crane_env")
#: Scripts of tests/design/test_calibrate.py and test_measured_cable.py.
CALIBRATED = ("calibrate", "measured_cable")
#: Model files; three describe overhead lines, study.toml and tolerances.toml studies, calibrate.toml
#: a calibration, and droppers.toml and droppers_13.toml what ancf optimise looks for.
OTHERS = {
    "line.toml",
    "tension_length.toml",
    "study.toml",
    "tolerances.toml",
    "calibrate.toml",
    "droppers.toml",
    "droppers_line.toml",
    "droppers_13.toml",
    "droppers_13_line.toml",
}
FILES = sorted({path.name for path in EXAMPLES.glob("*.toml")} - OTHERS)


def described(model):
    """Plain description without the texts that may differ."""
    plain = model.to_dict()
    plain.pop("title")
    for body in plain["bodies"]:
        for key in ("shape", "width", "height", "diameter", "E", "nu", "rho"):
            body.get("section", {}).pop(key, None)
    return plain


def start_of(study):
    if study.simulation.start == "reference":
        return None
    return ancf.equilibrium(study.model, of=study.simulation.equilibrium_of)


class TestScripts:
    @pytest.mark.parametrize("name", WITH_MAIN)
    def test_runs(self, name, capsys):
        script(name).main(t_end=0.05)
        assert len(capsys.readouterr().out.splitlines()) >= 3

    def test_the_whole_face_runs(self, capsys):
        runpy.run_path(str(EXAMPLES / "model_face.py"))
        assert "rad/s" in capsys.readouterr().out

    @pytest.mark.filterwarnings("ignore:beam node")  # the pin stops the end that set_motion starts
    def test_everything_on_one_beam(self):
        section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.0)
        model = ancf.Model(gravity=(0.0, 0.0, -9.81))
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
        beam.set_motion(velocity=(0, 0, 0), angular_velocity=(0, 0, 4.0), about=(0, 0, 0))
        model.clamp(beam.start, stretch="free")
        model.clamp(beam.start, rotation=lambda t: t**3, axis=(0, 0, 1))
        model.pin(beam.end)
        model.add_force(beam.end, (0.0, 0.0, -1.0))
        model.add_moment(beam.end, (0.0, 0.5, 0.0))
        state = ancf.equilibrium(model)
        result = ancf.simulate(model, t_end=0.1, step=2.5e-4, start=state, integrator=ancf.Trapezoidal())
        assert result.t.shape == (401,)
        assert result.position(beam.end) == pytest.approx(np.tile([1.0, 0.0, 0.0], (401, 1)), abs=1e-12)
        for history in (result.velocity(beam.at(0.5)), result.tension(beam.at(0.5)), result.energy.total):
            assert np.all(np.isfinite(history))
        assert ancf.modes(model, about=state, count=10).frequencies.shape == (10,)

    def test_all_scripts_are_tested(self):
        tested = [*WITH_MAIN, "model_face", *CONTROLLED, *CALIBRATED]
        assert sorted(path.stem for path in EXAMPLES.glob("*.py")) == sorted(tested)


class TestFiles:
    @pytest.mark.parametrize("name", FILES)
    def test_runs(self, name):
        study = read_study(EXAMPLES / name)
        settings = study.simulation
        result = ancf.simulate(
            study.model,
            t_end=20 * settings.step,
            step=settings.step,
            start=start_of(study),
            integrator=settings.integrator,
        )
        assert result.status == "complete"
        assert settings.outputs
        for label in settings.outputs:
            assert np.all(np.isfinite(result.position(label)))

    @pytest.mark.slow
    @pytest.mark.parametrize("name", FILES)
    def test_runs_to_its_end(self, name, call):
        """As its page has it; what is drawn from it is finite."""
        ran = call("run", EXAMPLES / name, "-o", "out")
        assert ran.code == 0, ran.err
        result = ancf.load("out/results.h5")
        assert result.status == "complete"
        assert np.all(np.isfinite(result.energy.total))

    @pytest.mark.parametrize("name", WITH_MAIN)
    def test_describes_the_model_of_the_script(self, name):
        from_file, from_script = (
            described(m) for m in (read_study(EXAMPLES / f"{name}.toml").model, script(name).build())
        )
        assert from_file == approximately(from_script)

    @pytest.mark.parametrize(
        ("name", "build"),
        [
            ("cantilever", lambda: cantilever.build(16)),
            ("pendulum", pendulum.build),
            ("spin_up", spin_up.build),
            ("sliding_beam", lambda: sliding.build(64, 4)),
        ],
    )
    def test_describes_the_model_of_the_paper(self, name, build):
        from_file, wanted = described(read_study(EXAMPLES / f"{name}.toml").model), described(build())
        assert from_file["bodies"] == approximately(wanted["bodies"])
        assert from_file["gravity"] == wanted["gravity"]


def approximately(value):
    """The same nested description with its numbers compared within 1e-7 relative."""
    if isinstance(value, dict):
        return {key: approximately(part) for key, part in value.items()}
    if isinstance(value, list):
        return [approximately(part) for part in value]
    return pytest.approx(value, rel=1e-7) if isinstance(value, float) else value
