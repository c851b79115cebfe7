"""Pieces of pages: text and elements in their order, attributes, and everything escaped."""

import base64
import re
from xml.etree import ElementTree

from ancf.viz.html import element, figure, page, pairs, picture, table


def text_of(tree):
    return ElementTree.tostring(tree, encoding="unicode")


def test_texts_follow_each_other():
    """Before, between and behind elements, as often as there are some."""
    tree = element("p", "a", "b", element("b", "c"), "d", "e", element("i"), "f", class_="x", data_y="1")
    assert text_of(tree) == '<p class="x" data-y="1">ab<b>c</b>de<i />f</p>'


def test_text_is_escaped():
    assert text_of(element("p", "<b> & c", title='"<')) == '<p title="&quot;&lt;">&lt;b&gt; &amp; c</p>'
    assert "<script>x" not in page("<script>x", element("p", "<script>x"))


def test_numbers_of_a_table_stand_on_the_right():
    tree = table(["name", "size"], [["a", "1"], ["b", "2"]], numbers=[1])
    cells = [[cell.get("class") for cell in row] for row in tree.iter("tr")]
    assert cells == [[None, "number"]] * 3
    assert [cell.text for cell in tree.iter("td")] == ["a", "1", "b", "2"]
    assert [[cell.text for cell in row] for row in pairs([("k", "v")]).iter("tr")] == [["k", "v"]]


def test_small_numbers_stay_on_one_line():
    """A browser breaks 1e-06 behind its hyphen; in columns of numbers no cell is broken at all."""
    text = "tolerance 2.5e-07 m, then -1E-3, 12-3 and e-mail"
    for tree in (table(["what", "size"], [[text, "1e-06"]], numbers=[1]), pairs([("k", text)])):
        kept = [piece.text for piece in tree.iter("span") if piece.get("class") == "whole"]
        assert kept == ["2.5e-07", "-1E-3"]
        assert "".join(next(iter(tree.iter("td"))).itertext()) == text
    assert re.search(r"td\.number, \.whole \{[^}]*white-space: nowrap", page("t"))


def test_pictures_stand_inside_the_page():
    content = bytes(range(256))
    image = picture(content, "png", "noise")
    kind, coded = image.get("src").split(",")
    assert (kind, base64.b64decode(coded)) == ("data:image/png;base64", content)
    (shown,) = figure("tip", "Tip", "Over time", "<svg/>").iter("img")
    assert shown.get("alt") == "Tip. Over time"
