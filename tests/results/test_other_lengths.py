"""Lengths that differ from what is drawn: by print(model), ancf check and the notes of runs."""

import pytest

import ancf
from ancf.model.file import read_study

ROPE = ancf.Section(EA=1e4, EI=0.5, rhoA=0.5, axial_damping=100.0)


def hung(length=5.0, drawn=5.0, element="cable"):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ROPE if element == "cable" else ancf.Section.rectangle(width=0.02, height=0.02, E=1e8, rho=1e3)
    rope = model.add_beam(
        "rope",
        start=(0, 0, 0),
        end=(0, 0, -drawn),
        length=length,
        elements=5,
        section=section,
        element=element,
    )
    model.pin(rope.start)
    return model, rope


class TestPrinted:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    @pytest.mark.parametrize(("length", "said"), [(4.0, "25 % longer"), (6.25, "20 % shorter"), (5.0, None)])
    def test_natural_lengths(self, length, said, element):
        """The same words as those of ancf check."""
        model, _ = hung(length, element=element)
        shown = " ".join(str(model).split())
        assert (f'note body "rope" starts {said} than its natural length {length:g} m' in shown) == bool(said)
        assert shown.count("natural length") == bool(said)

    @pytest.mark.parametrize("friction", [0.3, 35.0])
    @pytest.mark.parametrize("E", [200.0, 2e8])
    def test_what_looks_like_other_units(self, friction, E):
        model = ancf.Model()
        section = ancf.Section.rectangle(width=0.02, height=0.02, E=E, rho=1e3)
        model.add_beam("bar", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.add_ground("soil", height=-1.0, stiffness=1e5, friction=friction)
        assert ("per cent" in str(model)) == (friction > 3.0)
        assert ("in GPa" in str(model)) == (E < 1e3)

    @pytest.mark.parametrize("length", [4.9, 5.0])
    def test_commands_say_the_same(self, call, tmp_path, length):
        (tmp_path / "model.toml").write_text(
            f"""
            [[bodies]]
            name = "rope"
            start = [0, 0, 0]
            end = [0, 0, -5]
            length = {length}
            elements = 5
            section = {{ EA = 1e4, EI = 0.5, rhoA = 0.5 }}
            [[supports]]
            type = "clamp"
            point = "rope.start"
            [equilibrium]
            """,
            encoding="utf-8",
        )
        ran = call("check", "model.toml")
        printed = str(read_study(tmp_path / "model.toml").model)
        notes = [
            line.removeprefix("note: ") for line in ran.out.splitlines() if line.startswith("note: body")
        ]
        assert len(notes) == (length != 5.0)
        assert all(note in printed for note in notes)


class TestWinches:
    @pytest.mark.parametrize("at_start", [True, False])
    @pytest.mark.parametrize("share", [0.9, 0.98, 0.995, 1.0, 1.005, 1.02, 1.2])
    def test_run_says_what_is_drawn_otherwise(self, share, at_start):
        model, rope = hung()
        model.winch(rope.start if at_start else rope.end, length=f"{5.0 * share} + 0*t", name="drum")
        if not at_start:
            model.pin(rope.end)
        result = ancf.simulate(model, t_end=2e-4, step=1e-4)
        said = [text for text in result.notes if "a jolt" in text]
        assert len(said) == (abs(share - 1.0) > 0.01)
        for text in said:
            assert text.startswith(
                f'"drum" has {5.0 * share:.4g} m of "rope" out and the initial shape has 5 m'
            )

    @pytest.mark.parametrize("share", [0.9, 1.2])
    @pytest.mark.parametrize("then", [1.0, 1.1])
    def test_from_an_equilibrium_only_if_it_has_another(self, share, then):
        """That of the same model has its length; the model may have changed since."""
        starts = []
        for factor in (1.0, then):
            model, rope = hung()
            model.winch(rope.start, length=f"{5.0 * share * factor} + 0*t")
            starts.append(ancf.equilibrium(model))
        result = ancf.simulate(model, t_end=2e-4, step=1e-4, start=starts[0])
        said = [text for text in result.notes if "a jolt" in text]
        assert len(said) == (then > 1.01)
        assert all("the given start has" in text for text in said)
