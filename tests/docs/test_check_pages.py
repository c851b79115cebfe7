"""The check of the documentation's pages in a browser finds what is wrong and lets the rest pass."""

import sys

import pytest

from places import DOCS

sys.path.insert(0, str(DOCS))

import check_pages

SOUND = """<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>A</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">
</head><body><main><h1>A</h1><p>words</p>{}</main></body></html>"""


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("", ""),
        ('<img src="data:image/gif;base64,R0lGODlhAQABAAAAACw=">', "image-alt"),
        ("<script>throw new Error('no such thing')</script>", "no such thing"),
        ('<div style="width: 900px">wide</div>', "wider than the screen"),
    ],
)
def test_what_is_wrong_is_told(browser, tmp_path, more, said):
    page = tmp_path / "a.html"
    page.write_text(SOUND.replace("{}", more), encoding="utf-8")
    found = list(check_pages.wrong(browser, page))
    assert all(said in line for line in found)
    assert bool(found) is bool(said)


def test_one_page_of_each_folder_and_the_odd_ones(tmp_path):
    names = ("index", "gallery", "limits", "howto/damping", "howto/view", "_static/x")
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.html").write_text("")
    opened = [check_pages.name_of(tmp_path, page) for page in check_pages.chosen(tmp_path, whole=False)]
    assert opened == ["gallery", "howto/damping", "index"]
    assert len(check_pages.chosen(tmp_path, whole=True)) == 5
    assert check_pages.main([str(tmp_path / "_static" / "none")]) == 1
