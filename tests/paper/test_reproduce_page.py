"""The page of a reproduction: verdicts, texts, links, and the digits of its numbers."""

import math
import re
from html.parser import HTMLParser

import pytest

from ancf.paper.check import Check
from ancf.paper.report import numbers
from ancf.paper.report.errata import errata
from fake_exhibits import BAD, FAKES, LOST

pytest.importorskip("matplotlib")


class Page(HTMLParser):
    """Text, tags and places to which links lead."""

    VOID = ("meta", "link", "img", "br")

    def __init__(self, text):
        super().__init__()
        self.open, self.texts, self.ids, self.links, self.sources, self.tags = [], [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append(tag)
        self.ids += [attrs["id"]] if "id" in attrs else []
        self.links += [attrs["href"]] if "href" in attrs else []
        self.sources += [attrs["src"]] if "src" in attrs else []
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.texts.append(data)

    @property
    def text(self):
        return " ".join("".join(self.texts).split())


class TestPage:
    def test_every_exhibit_with_its_verdict(self, made):
        page = Page(made.page.read_text(encoding="utf-8"))
        for fake, word in zip(FAKES, ("✓", "✗", "–", "✗", "✗", "✓"), strict=True):
            assert page.ids.count(fake.name) == 1
            assert page.links.count(f"#{fake.name}") == 2
            assert fake.TITLE in page.text
            assert fake.CLAIM in page.text
            assert f"{word} {fake.name}" in page.text
        assert "✗ 3 of 5 checks passed, 2 of 6 exhibits could not be computed." in page.text
        assert page.text.count("✓ passed") == 2 + 3
        assert page.text.count("✗ failed") == 1 + 2
        assert page.text.count("The paper, example 7.1.") == len(FAKES)

    def test_links_lead_somewhere(self, made):
        page = Page(made.page.read_text(encoding="utf-8"))
        for link in page.links:
            if link.startswith("#"):
                assert page.ids.count(link[1:]) == 1
            elif not link.startswith("data:"):
                assert (made.folder / link).is_file()
        assert len(page.sources) == 4
        assert all(source.startswith("data:image/png;base64,") for source in page.sources)

    def test_needs_no_network_and_runs_nothing(self, made):
        text = made.page.read_text(encoding="utf-8")
        assert not re.findall(r"(?:https?:)?//[\w.]+", re.sub(r"base64,[\w+/=]+", "", text))
        assert "script" not in Page(text).tags

    def test_texts_are_escaped(self, made):
        text = made.page.read_text(encoding="utf-8")
        assert "<script>" not in text
        assert "tip: &lt;x&gt; &amp; y" in text
        page = Page(text)
        assert BAD.origin in page.text
        assert "no convergence <here> (smaller steps)" in page.text
        assert "b" not in page.tags

    def test_errors_without_traceback(self, made):
        page = Page(made.page.read_text(encoding="utf-8"))
        assert "internal error: RuntimeError: wheel off" in page.text
        assert "Traceback" not in page.text

    def test_notes(self, made):
        page = Page(made.page.read_text(encoding="utf-8"))
        assert page.text.count("Assumed: a & b.") == 4
        assert page.text.count("Measured numbers (1)") == 4
        assert page.text.count("the end.") == 4
        assert page.tags.count("details") == 8

    def test_misprints_and_settings(self, made):
        page = Page(made.page.read_text(encoding="utf-8"))
        assert all(erratum.taken in page.text for erratum in errata())
        for word in ("numba", "processes", "quick: fewer and shorter runs"):
            assert word in page.text


class TestNumbers:
    def test_as_many_digits_as_the_tolerance_is_worth(self):
        check = Check("a", -0.727639712345, -0.7276397, 5e-8, "m", "b")
        assert numbers.value(check) == "−0.727639712"
        assert numbers.reference(check) == "−0.727639700"
        assert numbers.deviation(check) == "−1.2e−08"
        assert numbers.tolerance(check) == "± 5e−08"
        assert numbers.value(Check("a", 123.456, 120.0, 4.0, "N", "b")) == "123.5"
        assert numbers.value(Check("a", 3.0e7, 3.0e7, 2e5, "N", "b")) == "30000000"

    def test_other_rules(self):
        factor = Check("a", 20.0, 10.0, 3.0, "", "b", "factor")
        assert (numbers.deviation(factor), numbers.tolerance(factor)) == ("factor 2", "factor 3")
        least = Check("a", 20.0, 10.0, 0.0, "", "b", "at least")
        assert (numbers.reference(least), numbers.tolerance(least)) == ("at least 10", "none")
        assert numbers.value(LOST) == "no number"

    @pytest.mark.parametrize(
        ("use", "text"),
        [(0.0, "0 %"), (1e-5, "< 0.1 %"), (0.125, "12 %"), (2.0, "200 %"), (math.inf, "beyond")],
    )
    def test_share(self, use, text):
        assert numbers.share(use) == text


class TestErrata:
    def test_complete(self):
        found = errata()
        assert len(found) >= 15
        assert {erratum.kind for erratum in found} == {"misprint", "gap"}
        assert all(erratum.where and erratum.printed and erratum.taken for erratum in found)

    def test_spin_up_angle_has_the_square(self):
        (angle,) = (erratum for erratum in errata() if erratum.where == "(33)")
        assert "(T_s/2π)²" in angle.taken
