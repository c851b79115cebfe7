"""What a check is, where the reference numbers come from, and tables of numbers."""

import math

import pytest

from ancf.paper import Table, references
from ancf.paper.check import Check


class TestCheck:
    @pytest.mark.parametrize(
        ("value", "rule", "tolerance", "passed"),
        [
            (10.4, "within", 0.5, True),
            (9.5, "within", 0.5, True),
            (10.6, "within", 0.5, False),
            (10.0, "within", 0.0, True),
            (29.0, "factor", 3.0, True),
            (3.4, "factor", 3.0, True),
            (31.0, "factor", 3.0, False),
            (3.3, "factor", 3.0, False),
            (-10.0, "factor", 3.0, False),
            (1e9, "at least", 0.0, True),
            (9.9, "at least", 0.2, True),
            (9.7, "at least", 0.2, False),
            (-1e9, "at most", 0.0, True),
            (10.1, "at most", 0.2, True),
            (10.3, "at most", 0.2, False),
        ],
    )
    def test_rules(self, value, rule, tolerance, passed):
        assert Check("x", value, 10.0, tolerance, "m", "formula", rule).passed is passed

    @pytest.mark.parametrize("rule", ["within", "factor", "at least", "at most"])
    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    def test_what_is_no_number_fails(self, value, rule):
        assert not Check("x", value, 10.0, 1e9, "m", "formula", rule).passed
        assert not Check("x", 1.0, math.nan, 1.0, "m", "formula", rule).passed

    def test_plain(self):
        check = Check("x", 10.5, 10.0, 1.0, "m", "formula")
        assert check.deviation == 0.5
        assert check.plain() == {
            "name": "x", "value": 10.5, "reference": 10.0, "tolerance": 1.0, "passed": True, "rule": "within",
            "unit": "m", "origin": "formula",
        }  # fmt: skip


class TestReferences:
    def test_files_do_not_overlap(self):
        count = sum(len(references._read(name)["entries"]) for name in references.FILES)
        assert len(references.values()) == count > 150

    def test_values(self):
        assert references.reference("7.3.converged.uy7") == -0.531999
        assert not references.exists("7.1.tip.ho.n64.h0.25ms")
        with pytest.raises(KeyError):
            references.reference("7.1.tip")

    @pytest.mark.parametrize(
        ("key", "text"),
        [
            ("7.1.tip.cable.n4.h0.25ms", "of the same discretisation"),
            ("7.1.tip.cable.n4.step_converged", "limit of small steps"),
            ("7.4.converged.t1", "limit of many elements"),
            ("elastica.moment1.exact.solid3d", "by shooting"),
            ("jac.7.1.cable.f1.theta0.5.tol1e-08", "same contraction"),
        ],
    )
    def test_origins(self, key, text):
        assert references.exists(key)
        assert text in references.origin(key)
        assert key in references.origin(key)

    def test_about(self):
        assert len(references.about()) > 8
        assert all("independent implementation" in text for text in references.about()[::8])


class TestTable:
    table = Table("t", ("name", "t", "u"), [("a", 0.1 + 0.2, 1), ("a", 0.4, 2), ("b", 0.3, 3)], [])

    def test_row(self):
        assert self.table.row(name="a", t=0.3) == {"name": "a", "t": 0.1 + 0.2, "u": 1}
        assert self.table.row(name="b")["u"] == 3
        assert self.table.row(name="a", t=0.31) is None
        assert self.table.row(name="c") is None
