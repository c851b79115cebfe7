"""What a state and a history say of their own accuracy, against what is known of them."""

import json
import re

import numpy as np
import pytest

import ancf

LOAD = 0.03  # P L^2/EI


def cantilever(elements, ratio, *, length=1.0, EI=1.0, strain="material"):
    """A cable under a force at its tip; ``ratio``: EA L^2/EI."""
    model = ancf.Model()
    section = ancf.Section(EA=ratio * EI / length**2, EI=EI, rhoA=1.0)
    ends = {"start": (0, 0, 0), "end": (length, 0, 0)}
    beam = model.add_beam("beam", elements=elements, section=section, strain=strain, **ends)
    model.clamp(beam.start)
    model.add_force(beam.end, (0, 0, -LOAD * EI / length**2))
    return model, beam


class TestLocking:
    """Deflection of the elastica for small loads: P L^3/(3 EI) (1 - 4/35 (P L^2/EI)^2)."""

    EXACT = LOAD / 3 * (1 - 4 / 35 * LOAD**2)

    def error(self, state, beam):
        return abs(state.position(beam.end)[2] / beam.length / self.EXACT + 1)

    @pytest.mark.parametrize(
        ("elements", "ratio", "length", "EI"),
        [(16, 1e12, 1.0, 1.0), (8, 1e12, 1.0, 50.0), (16, 1e12, 1e5, 1.0), (8, 1e10, 20.0, 1e-3)],
    )
    def test_a_locked_cable_says_so(self, elements, ratio, length, EI):
        """The error in the note is the true one within a factor of four."""
        model, beam = cantilever(elements, ratio, length=length, EI=EI)
        state = ancf.equilibrium(model)
        error = self.error(state, beam)
        assert error > 5e-4
        (note,) = state.notes
        assert note.startswith('"beam" may bend too little')
        said = float(re.search(r"about (\S+) m", note)[1]) / (length * self.EXACT)
        assert error / 4 < said < 4 * error
        assert note in " ".join(str(state).split())

    def test_on_the_command_line(self, call, tmp_path):
        """The note stands in the summary and on the screen."""
        (tmp_path / "model.toml").write_text(
            f"""
            [[bodies]]
            name = "beam"
            start = [0, 0, 0]
            end = [1, 0, 0]
            elements = 8
            section = {{ EA = 1e12, EI = 1.0, rhoA = 1.0 }}
            [[supports]]
            type = "clamp"
            point = "beam.start"
            [[loads]]
            type = "force"
            point = "beam.end"
            force = [0, 0, {-LOAD}]
            [equilibrium]
            """,
            encoding="utf-8",
        )
        ran = call("run", "model.toml")
        (note,) = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))["notes"]
        assert '"beam" may bend too little' in note
        assert f"note: {note}" in ran.out

    @pytest.mark.parametrize(("elements", "ratio"), [(4, 1e4), (16, 1e6), (64, 1e8)])
    def test_others_do_not(self, elements, ratio):
        model, beam = cantilever(elements, ratio)
        state = ancf.equilibrium(model)
        assert self.error(state, beam) < 1e-5
        assert state.notes == []

    def test_refined_cable_says_nothing(self):
        """What the note advises helps."""
        notes = [ancf.equilibrium(cantilever(n, 1e10)[0]).notes for n in (8, 32)]
        assert len(notes[0]) == 1
        assert notes[1] == []

    @pytest.mark.parametrize("EA", [1e4, 1e7])
    def test_hanging_rope_says_nothing(self, EA):
        """Taut by its weight: stretch and bending do not fight."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=EA, EI=0.01, rhoA=0.1)
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(4, 0, 0.5), elements=32, length=4.2, section=section
        )
        model.pin(rope.start)
        model.pin(rope.end)
        assert ancf.equilibrium(model).notes == []

    def test_nothing_held_says_nothing(self):
        model, _ = cantilever(4, 1e12)
        model.supports.clear()
        model.loads.clear()
        assert ancf.modes(model, count=1).about.notes == []


@pytest.mark.parametrize(("EA", "EI", "says"), [(1e15, 1e3, True), (1e6, 1.0, False)])
def test_energy_from_nowhere_is_said(EA, EI, says):
    """Round-off of EA L 1e-16 is all that moves a beam that is too stiff for its load."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=EA, EI=EI, rhoA=0.1)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    model.clamp(beam.start)
    result = ancf.simulate(model, t_end=0.02, step=1e-3)
    energy = result.energy
    exchanged = max(np.max(energy.kinetic), np.max(energy.strain))
    assert (np.max(np.abs(energy.drift)) > 0.02 * exchanged) == says
    assert any("of the energy exchanged" in note for note in result.notes) == says
