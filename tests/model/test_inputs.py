"""Inputs of a model: names, formulas of them, descriptions and files."""

import copy
import json

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study, schema
from ancf.model.functions.function import TimeFunction

SECTION = ancf.Section(EA=1e3, EI=0.1, rhoA=0.4)


def cable():
    model = ancf.Model(gravity=(0, 0, -9.81))
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=SECTION)
    model.pin(beam.start)
    return model, beam


class TestFormulas:
    """Sums and products against the same with numbers."""

    @pytest.mark.parametrize(
        "formula",
        [
            lambda u, w: u,
            lambda u, w: 2 * u + 1,
            lambda u, w: 1 - u / 4,
            lambda u, w: -(u - w) * 3,
            lambda u, w: (u + 1) * (w - 2) / 2 - w,
            lambda u, w: np.float64(0.5) * u - np.int64(2),
            lambda u, w: 1e-30 * u + 1e20,
            lambda u, w: -u * -w,
        ],
    )
    def test_values(self, formula):
        model, _ = cable()
        u, w = model.add_input("u", 0.7), model.add_input("w2", -1.3)
        function = TimeFunction(formula(u, w), 1, "here")
        rng = np.random.default_rng(5)
        assert function(3.0)[0] == pytest.approx(formula(0.7, -1.3), rel=1e-15)
        for _ in range(10):
            now = dict(zip(("u", "w2"), rng.uniform(-5, 5, 2).tolist(), strict=True))
            found = function.under(now, np.array([0.0, 2.0]))[:, 0]
            assert found == pytest.approx(formula(*now.values()), rel=1e-14)

    def test_is_no_constant(self):
        model, _ = cable()
        u = model.add_input("u")
        assert not TimeFunction((u, 0, 0), 3, "").constant
        assert TimeFunction((1, 0, 0), 3, "").constant
        assert TimeFunction((u, "2*t", 0), 3, "").inputs == {"u": 0.0}

    @pytest.mark.parametrize("other", ["2", None, (1, 2), [1.0], True])
    def test_terms_that_are_none(self, other):
        u = cable()[0].add_input("u")
        for combine in (lambda: u + other, lambda: other * u, lambda: u / other):
            with pytest.raises(TypeError):
                combine()


class TestNames:
    @pytest.mark.parametrize(
        ("name", "what"),
        [
            ("t", "must be a name that can stand in a formula"),
            ("vx", "must be a name"),
            ("sin", "must be a name"),
            ("pi", "must be a name"),
            ("two words", "must be a name"),
            ("2nd", "must be a name"),
            ("", "must be a name"),
            (3, "must be text"),
        ],
    )
    def test_refused(self, name, what):
        with pytest.raises(ancf.ModelError, match=what) as caught:
            cable()[0].add_input(name)
        assert caught.value.where.endswith(".name")

    def test_taken_and_values(self):
        model, _ = cable()
        assert repr(model.add_input("thrust", 3)) == "Input('thrust', 3)"
        with pytest.raises(ancf.ModelError, match='"thrust" is the name of an input already'):
            model.add_input("thrust")
        for value in ("fast", None, float("inf"), True):
            with pytest.raises(ancf.ModelError, match="must be"):
                model.add_input("w", value)
        assert list(model.inputs) == ["thrust"]

    def test_of_another_model(self):
        other = cable()[0].add_input("u")
        model, beam = cable()
        with pytest.raises(ancf.ModelError, match='depends on the input "u", which this model does not have'):
            model.add_force(beam.end, (other, 0, 0))
        assert model.loads == []

    def test_motions_of_supports(self):
        model, beam = cable()
        u, half = model.add_input("u"), model.add_input("half", 0.5)
        tip = model.add_point_mass("tip", at=(0.5, 0, 0), mass=1.0)
        for move in (
            lambda: model.pin(beam.end, displacement=(0, 0, u)),
            lambda: model.hold(beam.end, position="x", displacement=(u, 0, 0)),
            lambda: model.clamp(beam.end, rotation=0.1 * u),
            lambda: model.slide(tip, along=beam, s=0.5, motion=half),
        ):
            with pytest.raises(
                ancf.ModelError, match=r'given by the input "(u|half)", whose velocity nobody knows'
            ):
                move()
        assert len(model.supports) == 1
        assert model.connections == []


class TestDescribed:
    def test_made_again(self):
        model, beam = cable()
        u = model.add_input("thrust", 1.5)
        model.add_force(beam.end, (2 * u, "sin(t)", -u + 1))
        model.add_moment(beam.at(0.5), (0, 0.1 * u, 0))
        plain = json.loads(json.dumps(model.to_dict()))
        assert plain["inputs"] == [{"name": "thrust", "value": 1.5}]
        again = ancf.Model.from_dict(plain)
        assert again.to_dict() == plain
        runs = [ancf.simulate(m, t_end=0.02, step=1e-3).q for m in (model, again)]
        assert np.array_equal(*runs)
        assert "thrust" in str(model)
        assert str(again) == str(model)

    def test_without_inputs_nothing_is_said(self):
        model, _ = cable()
        assert "inputs" not in model.to_dict()
        assert "input" not in str(model)

    def test_snapshots_and_copies(self):
        model, beam = cable()
        early = model.snapshot()
        u = model.add_input("u")
        model.add_force(beam.end, (u, 0, 0))
        assert list(early.inputs) == []
        assert list(copy.deepcopy(model).inputs) == ["u"]


class TestFiles:
    def study(self, **more):
        section = {"EA": 1e3, "EI": 0.1, "rhoA": 0.4}
        body = {"name": "beam", "section": section, "start": [0.0, 0, 0], "end": [1.0, 0, 0], "elements": 2}
        return {"bodies": [body], "supports": [{"type": "pin", "point": "beam.start"}], **more}

    def force(self, *values):
        return [{"type": "force", "point": "beam.end", "force": list(values)}]

    def test_read(self):
        given = [{"name": "thrust", "value": 2.0}, {"name": "side"}]
        study = parse_study(self.study(inputs=given, loads=self.force("2*thrust + side*t", 0.0, "-side")))
        [load] = study.model.loads
        assert load.force(3.0).tolist() == [4.0, 0.0, 0.0]
        assert load.force.under({"thrust": 1.0, "side": 5.0}, np.array([2.0])).tolist() == [[12.0, 0.0, -5.0]]
        assert study.model.inputs["thrust"].value == 2.0

    @pytest.mark.parametrize(
        ("inputs", "loads", "said"),
        [
            ([], ("trust", 0, 0), 'unknown name "trust"'),
            ([{"name": "thrust"}], ("trust", 0, 0), 'did you mean "thrust"'),
            ([{"name": "thrust"}, {"name": "thrust"}], (1, 0, 0), "inputs[1].name"),
            ([{"name": "t"}], (1, 0, 0), "inputs[0].name"),
            ([{"name": "u", "value": "x"}], ("u", 0, 0), "inputs[0].value"),
            ([{"value": 1.0}], (1, 0, 0), "inputs[0].name"),
            ([{"name": "u", "unt": "N"}], (1, 0, 0), "inputs[0].unt"),
            ("u", (1, 0, 0), "inputs"),
            ([3], (1, 0, 0), "inputs[0]"),
        ],
    )
    def test_refused(self, inputs, loads, said):
        numbers = (float(x) if x in (0, 1) else x for x in loads)
        study = self.study(inputs=inputs, loads=self.force(*numbers))
        with pytest.raises(ancf.ModelError) as caught:
            parse_study(study)
        assert said in str(caught.value)

    def test_schema(self):
        assert "inputs" in schema()["properties"]
