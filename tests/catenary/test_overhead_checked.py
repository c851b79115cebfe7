"""``ancf check`` of a line: what its form shows before anything is run."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from ancf import ModelError
from ancf.catenary import SteadyArm, form, read_line
from ancf.catenary.checked import at_rest
from ancf.catenary.fittings import Droppers
from ancf.cli.app import app
from overhead_lines import TOML, short_line


def told(line):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return at_rest(line)


class TestSaid:
    def test_nothing_of_a_good_line(self):
        assert told(short_line()) == []
        assert told(read_line("en50318-2018-ac-simple")) == []

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
