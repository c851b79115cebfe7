"""The reference has a page for all that the package offers, with an example that runs."""

import sys
from importlib import import_module

import pytest

from places import DOCS

sys.path.insert(0, str(DOCS))

import code_blocks
import reference_pages

NAMES = reference_pages.all_names()
#: Examples that are not on another page, which has its own test.
OWN = {named.name: named.example for named in NAMES if named.example} | reference_pages.examples()


@pytest.mark.parametrize("module", ["ancf", "ancf.catenary", "ancf.paper", "ancf.results"])
def test_every_public_name_is_there(module):
    names = set(import_module(module).__all__) - {"__version__", "FIGURES"}
    told = {named.last for named in NAMES}
    assert sorted(names - told) == []


def test_every_name_there_exists_and_stands_once():
    names = [named.name for named in NAMES]
    assert len(set(names)) == len(names)
    assert all(named.object is not None for named in NAMES)


@pytest.mark.parametrize("key", OWN)
@pytest.mark.filterwarnings("default::UserWarning")
def test_examples_run(key, tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    code_blocks.link_examples(tmp_path)
    exec(compile(OWN[key], f"example {key} of reference.toml", "exec"), {"__name__": "__main__"})


def test_every_page_has_an_example_and_is_found_from_there():
    assert [named.name for named in NAMES if not reference_pages.example(named)] == []
    pages = dict(reference_pages.pages())
    assert all("See also" in pages[named.name] for named in NAMES)
    shared = {named.shows for named in NAMES}
    assert set(reference_pages.examples()) <= shared


def test_results_list_every_question():
    """What a result is asked stands on its page, also what it inherits, but nothing internal."""
    page = dict(reference_pages.pages())["ancf.Result"]
    for name in ("tension", "position", "spring_force", "contact_force", "reaction", "to_pandas", "momentum"):
        assert f":py:obj:`{name} <ancf.Result.{name}>`" in page
    assert "<ancf.Result.slots>" not in page


def test_every_command_has_its_options():
    pages = dict(reference_pages.pages())
    commands = dict(reference_pages.commands())
    assert len(commands) >= 17
    assert "--resume" in pages["ancf-run"]
    assert "--speed" in pages["ancf-catenary-run"]
    for words, command in commands.items():
        assert command.help.split()[0] in pages[words.replace(" ", "-")]


def test_pages_of_docs_that_are_named_exist():
    known = {named.name for named in NAMES}
    for named in NAMES:
        assert all(name in known or (DOCS / f"{name}.md").exists() for name in named.see), named.name


def test_contents_lead_to_every_group():
    text = (DOCS / "reference.md").read_text(encoding="utf-8")
    made = dict(reference_pages.pages())
    tree = text[text.index("{toctree}") :].split()
    for page in [*(group.page for group in reference_pages.contents()[0]), "commands"]:
        assert f"reference/{page}" in tree
    assert all(entry.removeprefix("reference/") in made for entry in tree if entry.startswith("reference/"))
