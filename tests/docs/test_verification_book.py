"""The verification book in docs/: made from the stored numbers, and these say what it says of them."""

import re
import sys
import tomllib

import pytest

from ancf.paper.check import Check
from ancf.paper.figures import FIGURES
from places import DOCS, TESTS

sys.path.insert(0, str(DOCS))

import verification_book as book
import verification_tables as tables


@pytest.fixture(scope="module")
def made():
    return book.read("checks.json")


def checks(made):
    """The stored checks with the verdict that is stored."""
    for entry in made["checks"]:
        keys = ("name", "value", "reference", "tolerance", "unit", "origin", "rule")
        yield Check(**{key: entry[key] for key in keys}), entry["passed"]


class TestPages:
    def test_are_what_the_generator_makes(self):
        pages = book.pages()
        stored = {path.name: path.read_text(encoding="utf-8") for path in book.FOLDER.glob("*.md")}
        assert stored.keys() == pages.keys()
        for name, text in pages.items():
            assert stored[name] == text, f"{name} is out of date: python docs/verification_book.py"

    def test_every_check_is_in_a_chapter(self, made):
        pages = book.pages()
        judged = "".join(pages[f"{name}.md"] for name in book.JUDGED)
        for entry in made["checks"]:
            unit = f" [{entry['unit']}]" if entry["unit"] else ""
            assert judged.count(f"| {entry['name']}{unit} |") == 1, entry["name"]

    def test_summary_counts_all(self, made):
        total = len(made["checks"])
        assert f"**{total} of {total} checks passed.**" in book.pages()["index.md"]


class TestNumbers:
    def test_are_of_a_full_run(self, made):
        assert not made["quick"]
        assert {entry["name"] for entry in made["exhibits"]} >= FIGURES.keys()
        assert not any(entry["error"] for entry in made["exhibits"])

    def test_verdicts_follow_from_the_numbers(self, made):
        for check, passed in checks(made):
            assert check.passed == passed, check.name

    def test_passed_or_open(self, made):
        failed = {check.name for check, passed in checks(made) if not passed}
        assert failed == book.OPEN.keys()  # what passes again is no longer open

    def test_names_are_unique_and_origins_told(self, made):
        names = [check.name for check, _ in checks(made)]
        assert len(set(names)) == len(names)
        assert all(check.origin for check, _ in checks(made))

    def test_standard_has_the_judged_rows(self, made):
        rows = [row for row in book.read("en50318.json")["rows"] if row[0] == "en50318-2002"]
        values = [entry["value"] for entry in made["checks"] if entry["figure"] == "en50318"]
        assert [row[4] for row in rows] == values
        for _, _, quantity, _, value, low, high, verdict, _ in book.read("en50318.json")["rows"]:
            assert (low <= value <= high) == (verdict == "inside"), quantity


class TestMerge:
    """Some exhibits of another reproduction in the place of the stored ones."""

    def made(self, commit, *names, passed=True, seconds=1.0):
        return {
            "commit": commit,
            "jobs": 2,
            "seconds": seconds,
            "passed": passed,
            "checks": [{"name": f"{n} {k}", "figure": n, "passed": passed} for n in names for k in range(2)],
            "exhibits": [{"name": n, "commit": commit, "error": None} for n in names],
        }

    def test_new_ones_replace_and_follow(self):
        found = book.merge(self.made("a", "fig1", "fig2", "fig3"), self.made("b", "fig4", "fig2"))
        assert [(e["name"], e["commit"]) for e in found["exhibits"]] == [
            ("fig1", "a"), ("fig2", "b"), ("fig3", "a"), ("fig4", "b"),
        ]  # fmt: skip
        assert [c["figure"] for c in found["checks"]] == [f"fig{n}" for n in (1, 1, 2, 2, 3, 3, 4, 4)]
        assert found["passed"]
        assert found["commit"] == "b"

    def test_an_old_failure_stays_one(self):
        assert not book.merge(self.made("a", "fig1", passed=False), self.made("b", "fig2"))["passed"]
        assert book.merge(self.made("a", "fig1", passed=False), self.made("b", "fig1"))["passed"]

    @pytest.mark.parametrize(("names", "expected"), [(("fig2",), 9.0), (("fig1", "fig2"), 3.0)])
    def test_time_is_that_of_all(self, names, expected):
        old = self.made("a", "fig1", "fig2", seconds=9.0)
        assert book.merge(old, self.made("b", *names, seconds=3.0))["seconds"] == expected


class TestTests:
    def test_files_exist(self, made):
        for entry in made["exhibits"]:
            for name in (*book.tests_of(entry["name"]), book.EVERY):
                assert (TESTS / name).exists(), name

    def test_what_methods_agree_in_is_asserted(self):
        text = (book.FOLDER / "across.toml").read_text(encoding="utf-8")
        for agreement in tomllib.loads(text)["agreement"]:
            file, *names = agreement["test"].split("::")
            source = (TESTS / file).read_text(encoding="utf-8")
            for name in names:
                assert re.search(rf"(class|def) {name}\b", source), agreement["test"]


class TestTables:
    def entry(self, **more):
        return {
            "name": "x", "value": 1.0004, "reference": 1.0, "tolerance": 1e-3, "passed": True,
            "rule": "within", "unit": "m", "origin": "here", "figure": "fig2", **more,
        }  # fmt: skip

    def test_digits_follow_the_tolerance(self):
        assert tables.check_row(self.entry(), 1)[:6] == [
            "x [m]", "1.0004", "1.0000", "+4.0e−04", "± 0.001", "40 %",
        ]  # fmt: skip

    @pytest.mark.parametrize(
        ("more", "use"),
        [
            ({"rule": "factor", "value": 2.0, "tolerance": 4.0}, 0.5),
            ({"rule": "at least", "value": 0.9995}, 0.5),
            ({"rule": "at least", "value": 5.0}, 0.0),
            ({"rule": "at most", "value": 1.0005}, 0.5),
            ({"tolerance": 0.0, "value": 1.0}, None),
        ],
    )
    def test_use_of_the_tolerance(self, more, use):
        found = tables.use(self.entry(**more))
        assert found == (use if use is None else pytest.approx(use))

    def test_a_failed_check_is_shown_as_open(self):
        assert tables.check_row(self.entry(passed=False), 1)[6] == "**open**"

    def test_a_bar_in_a_cell_does_not_end_it(self):
        assert tables.table(("a",), [("x|y",)]).endswith("| x\\|y |")
