"""``ancf check`` of a line: what its form shows before anything is run."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from ancf import ModelError
from ancf.catenary import Rayleigh, Route, SteadyArm, form, read_line, run
from ancf.catenary.checked import at_rest
from ancf.catenary.lines.fittings import Droppers
from ancf.cli.app import app
from overhead_lines import COARSE, STEP, TOML, collector, short_line


def told(line):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return at_rest(line)


class TestSaid:
    def test_nothing_of_a_good_line(self):
        assert told(short_line()) == []
        assert told(read_line("en50318-2018-ac-simple")) == []

    @pytest.mark.parametrize("mass", [1.0, 30.0, 99.0, 100.0, 500.0, 1500.0])
    @pytest.mark.parametrize("one", [True, False])
    def test_masses_of_arms_in_other_units(self, mass, one):
        """Of all arms, or of one of them: a kilogram is not said as 1000 g."""
        plain, heavy = SteadyArm(vertical=300.0, mass=1.0), SteadyArm(vertical=300.0, mass=mass)
        arms = heavy if one else (plain, plain, heavy, plain, plain, plain)
        texts = told(short_line(steady_arm=arms))
        place = "line.steady_arm.mass" if one else "line.steady_arm[2].mass"
        assert [text.partition(":")[0] for text in texts] == [place] * (mass >= 100.0)

    @pytest.mark.parametrize(
        ("given", "said"),
        [
            ({"alpha": 0.0125, "beta": 1e-4}, []),
            ({"alpha": 2.0, "beta": 1e-2}, []),
            ({"alpha": 100.0}, ["alpha"]),
            ({"beta": 0.1}, ["beta"]),
            ({"alpha": 12.5, "beta": 0.1}, ["alpha", "beta"]),
        ],
    )
    def test_damping_in_other_units(self, given, said):
        """The share of the critical damping is that of a string of the longest span."""
        line = short_line(damping=Rayleigh(**given))
        w = np.pi * np.sqrt(20e3 / 1.35) / 38.0
        shares = {"alpha": given.get("alpha", 0.0) / (2.0 * w), "beta": 0.5 * given.get("beta", 0.0) * w}
        texts = told(line)
        assert [text.partition(":")[0] for text in texts] == [f"line.damping.{key}" for key in said]
        for key, text in zip(said, texts, strict=True):
            assert f"by {100.0 * shares[key]:.2g} % of critical" in text

    @pytest.mark.parametrize("sections", [(0,), (1,), (0, 1)])
    def test_of_sections(self, sections):
        lines = [
            short_line(
                stagger=0.0,
                height=(0.1, *[0.0] * 4, 0.1),
                damping=Rayleigh(beta=0.1 if k in sections else 1e-4),
            )
            for k in (0, 1)
        ]
        texts = told(Route(lines=tuple(lines), starts=(0.0, 136.0)))
        assert [text.partition(":")[0] for text in texts] == [f"sections[{k}].damping.beta" for k in sections]

    @pytest.mark.parametrize(("beta", "said"), [(0.1, True), (1e-4, False)])
    def test_runs_say_it_too(self, beta, said):
        given = {"speed": 40.0, "pantograph": collector(), "step": STEP, "start": 10.0, "until": 72.0}
        with warnings.catch_warnings(record=True) as seen:
            warnings.simplefilter("always")
            found = form(short_line(damping=Rayleigh(beta=beta)), COARSE)
            run(found, **given, window=(61.0, 70.0))
        assert any("line.damping.beta: is 0.1 s" in str(one.message) for one in seen) == said

    def test_arms_that_would_hang_down(self):
        """Half of the arm's weight above what the stagger pulls: T times the kink."""
        stagger = (0.02, -0.02, 0.02, -0.02, 0.02, -0.02)
        pull = 20e3 * 0.04 * (1 / 30 + 1 / 36)
        arm = SteadyArm(length=1.1, mass=2.2 * pull / 9.81)
        line = short_line(stagger=stagger, contact_support="free", steady_arm=arm)
        with pytest.raises(ModelError, match=rf"pulls sideways with {pull:.0f} N .* larger than that"):
            told(line)

    def test_arms_that_pull_little(self):
        arm = SteadyArm(length=1.1, mass=30.0)  # 147 N of it on the wire
        stagger = (0.1, -0.1, 0.1, -0.1, 0.1, -0.1)
        line = short_line(stagger=stagger, contact_support="free", steady_arm=arm)
        pull = 20e3 * 0.2 * (1 / 30 + 1 / 36)
        assert 147.0 < pull < 2 * 147.0
        found = re.search(r"support 2 pulls with (\d+) N and carries 147 N, less than 2 times", told(line)[0])
        assert float(found[1]) == pytest.approx(pull, rel=0.02)
        assert not told(replace(line, steady_arm=replace(arm, mass=10.0)))

    @pytest.mark.parametrize(("stiffness", "said"), [(200.0, True), (1e5, False)])
    def test_droppers_that_stretch(self, stiffness, said):
        line = short_line(droppers=Droppers(stiffness=stiffness))
        found = form(line)
        share = found.dropper_force / stiffness / found.dropper_natural
        assert (share.max() > 0.01) == said
        texts = told(line)
        assert bool(texts) == said
        if said:
            worst = int(np.argmax(share))
            assert texts[0].startswith(line.dropper_label(worst))
            assert f"stretches by {1e3 * found.dropper_force[worst] / stiffness:.1f} mm" in texts[0]

    def test_stagger_beyond_strips(self):
        texts = told(short_line(stagger=(0.2, -0.2, 0.8, -0.1, 0.2, -0.2)))
        assert texts == [
            "line.stagger[2]: is 0.8 m, strips of 1.45 m reach to 0.725 m: runs need a longer one"
        ]

    def test_long_lines(self):
        line = read_line("en50318-2002")
        long = replace(line, spans=line.spans[:1] * 250, stagger=0.0, system_height=1.2)
        assert "of 250 spans and 2250 droppers; ancf catenary form finds it" in told(long)[0]


class TestCommand:
    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("pre_sag = 0", "pre_sag = 0.9", "has to push the contact wire down"),
            ("vertical = 300.0", "length = 1.1\nmass = 300.0", "a hinged arm would hang down"),
        ],
    )
    def test_is_not_right(self, tmp_path, old, new, said):
        text = TOML.replace("[[spans]]", "[[spans]]\npre_sag = 0")
        assert old in text
        (tmp_path / "line.toml").write_text(text)
        assert CliRunner().invoke(app, ["check", str(tmp_path / "line.toml")]).exit_code == 0
        (tmp_path / "line.toml").write_text(text.replace(old, new))
        done = CliRunner().invoke(app, ["check", str(tmp_path / "line.toml")])
        assert done.exit_code == 2
        assert said in " ".join(done.output.split())
