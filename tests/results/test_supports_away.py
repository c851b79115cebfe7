"""Supports away from the shape: print(model), ancf check and the run say the same of them."""

import warnings

import pytest

import ancf
from ancf.model.file import read_study

CABLE = "section = { EA = 1e4, EI = 0.5, rhoA = 0.5 }"
SOLID = 'section = { shape = "rectangle", width = 0.02, height = 0.02, E = 1e8, rho = 1000.0 }\nelement = '
BODIES = {"cable": CABLE, "original": SOLID + '"original"', "nonlocking": SOLID + '"nonlocking"'}
MOTIONS = {
    "lifted": ('displacement = ["0", "0", "0.03*cos(t)"]', "0.03 m away"),
    "turned": ('rotation = "0.2 + t"\naxis = [0, 2, 0]', "turned by 0.2"),
    "turned as a vector": ("rotation_vector = [0, 0, -0.2]", "turned by 0.2"),
    "begins there": ('displacement = ["0", "0", "t**3"]', None),
    "turned about itself": ('rotation = "0.2"\naxis = [1, 0, 0]', "turned by 0.2"),
    "at rest": ("", None),
}


def written(folder, bodies, supports, start="reference"):
    path = folder / "model.toml"
    text = f"""
        gravity = [0, 0, 0]
        [[bodies]]
        name = "arm"
        start = [0, 0, 0]
        end = [2, 0, 0]
        elements = 4
        {bodies}
        {supports}
        [simulation]
        t_end = 2e-4
        step = 1e-4
        start = "{start}"
        """
    path.write_text(text, encoding="utf-8")
    return path


def noted(ran):
    return [line.removeprefix("note: ") for line in ran.out.splitlines() if "a jolt" in line]


def run(study):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        start = ancf.equilibrium(study.model) if study.simulation.start == "equilibrium" else None
        result = ancf.simulate(study.model, t_end=2e-4, step=1e-4, start=start)
    return [text for text in result.notes if "a jolt" in text]


class TestSupports:
    @pytest.mark.parametrize("start", ["reference", "equilibrium"])
    @pytest.mark.parametrize("motion", MOTIONS)
    @pytest.mark.parametrize("kind", BODIES)
    def test_all_say_the_same(self, call, tmp_path, kind, motion, start):
        given, far = MOTIONS[motion]
        if kind == "cable" and motion == "turned about itself":  # it has one slope, which stays
            far = None
        clamp = f'[[supports]]\ntype = "clamp"\npoint = "arm.start"\nname = "wall"\n{given}'
        path = written(tmp_path, BODIES[kind], clamp, start)
        study = read_study(path)
        checked = noted(call("check", str(path)))
        assert checked == run(study)
        assert len(checked) == (far is not None and start == "reference")
        assert all(text.startswith(f'"wall" is {far}') for text in checked)
        printed = " ".join(str(study.model).split())
        assert printed.count("a jolt") == (far is not None)
        assert all(" ".join(text.split()) in printed for text in checked)

    @pytest.mark.parametrize("held", ["x", "z", "xz"])
    @pytest.mark.parametrize("moved", [(0.05, 0.0), (0.0, 0.05), (0.03, 0.04)])
    def test_components_that_are_free_are_not_away(self, call, tmp_path, held, moved):
        hold = f'[[supports]]\ntype = "hold"\npoint = "arm.end"\nposition = "{held}"\n'
        hold += f"displacement = [{moved[0]}, 0, {moved[1]}]"
        path = written(tmp_path, CABLE, '[[supports]]\ntype = "clamp"\npoint = "arm.start"\n' + hold)
        far = sum(d**2 for d, letter in zip(moved, "xz", strict=True) if letter in held) ** 0.5
        checked = noted(call("check", str(path)))
        assert checked == run(read_study(path))
        assert len(checked) == (far > 0.0)
        assert all(f"is {far:.3g} m away" in text for text in checked)


class TestWinches:
    @pytest.mark.parametrize("start", ["reference", "equilibrium"])
    @pytest.mark.parametrize("law", ["", 'speed = "0.1*t"\nacceleration = 1.0'])
    @pytest.mark.parametrize("share", [0.9, 0.995, 1.0, 1.02, 1.3])
    def test_all_say_the_same(self, call, tmp_path, share, law, start):
        length = f"{2 * share}" if law else f'"{2 * share} + 0*t"'
        ends = "".join(f'[[supports]]\ntype = "pin"\npoint = "arm.{end}"\n' for end in ("start", "end"))
        winch = f'[[supports]]\ntype = "winch"\npoint = "arm.start"\nname = "drum"\nlength = {length}\n{law}'
        path = written(tmp_path, CABLE, ends + winch, start)
        checked = noted(call("check", str(path)))
        study = read_study(path)
        if start == "reference" or share < 1.0:  # nothing holds a loose cable without a weight
            assert checked == run(study)
        assert len(checked) == (abs(share - 1.0) > 0.01 and start == "reference")
        assert all(f'"drum" has {2 * share:.4g} m of "arm" out' in text for text in checked)
        assert (" ".join(str(study.model).split()).count("a jolt") == 1) == (abs(share - 1.0) > 0.01)

    @pytest.mark.parametrize("value", [2.0, 2.5])
    def test_first_values_of_inputs(self, value):
        model = ancf.Model()
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=ancf.Section(EA=1e4, EI=0.5, rhoA=0.5)
        )
        model.pin(rope.start)
        model.pin(rope.end)
        wanted = model.add_input("wanted", value, unit="m")
        model.winch(rope.start, length=wanted, speed=1.0, acceleration=1.0)
        assert ("a jolt" in str(model)) == (value != 2.0)


class TestPrint:
    @pytest.mark.parametrize("works", [True, False])
    @pytest.mark.parametrize("moved", ["pin", "winch"])
    def test_does_not_fail_by_a_function_that_has_no_value_any_more(self, moved, works):
        model, given = ancf.Model(), {"lift": 0.1, "length": 1.5}
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=ancf.Section(EA=1e4, EI=0.5, rhoA=0.5)
        )
        if moved == "pin":
            model.pin(rope.start, displacement=lambda t: (0.0, 0.0, given["lift"]))
        else:
            model.winch(rope.start, length=lambda t: given["length"])
        if not works:
            given.clear()
        assert ("a jolt" in str(model)) == works
