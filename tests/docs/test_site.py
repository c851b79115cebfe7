"""The check of the documentation's links finds what is broken and lets the rest pass."""

import sys

import pytest

from places import DOCS

sys.path.insert(0, str(DOCS))

import check_links


@pytest.fixture
def site(tmp_path):
    """Writes pages of a site and returns what is broken in it."""

    def build(**pages):
        for name, text in pages.items():
            path = tmp_path / f"{name.replace('__', '/')}.html"
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return sorted(check_links.broken(tmp_path))

    return build


def test_sound_links_pass(site):
    assert (
        site(
            index='<a href="sub/page.html#there">x</a><a href="#here">y</a><p id="here">',
            sub__page='<h1 id="there"><a href="../index.html">up</a><a href="https://a.example/b#c">out</a>',
        )
        == []
    )


@pytest.mark.parametrize(
    ("tag", "wrong"),
    [
        ('<a href="nowhere.html">', "index.html: nowhere.html: no such file"),
        ('<a href="page.html#gone">', "index.html: page.html#gone: no place #gone there"),
        ('<a href="#gone">', "index.html: #gone: no place #gone there"),
        ('<img src="picture.png">', "index.html: picture.png: no such file"),
        ('<script src="code.js">', "index.html: code.js: no such file"),
    ],
)
def test_broken_ones_are_named(site, tag, wrong):
    assert site(index=tag, page="<p>") == [wrong]


def test_exit_code(site, tmp_path, capsys):
    assert check_links.main(str(tmp_path)) == 1  # no pages at all
    site(index='<a href="index.html">')
    assert check_links.main(str(tmp_path)) == 0
    site(page='<a href="gone.html">')
    assert check_links.main(str(tmp_path)) == 1
    assert "2 pages, 1 broken links" in capsys.readouterr().out
