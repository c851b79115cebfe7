"""Make the pages of the reference: one for each name of docs/reference.toml and each command.

Sphinx calls it before it reads the pages (docs/conf.py); what it writes, docs/reference, is not kept.
"""

from __future__ import annotations

import functools
import inspect
import re
import shutil
import textwrap
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from code_blocks import Block, blocks

DOCS = Path(__file__).resolve().parent
TARGET = DOCS / "reference"
#: Pages that are listed as using a name, at most.
USES = 6


@dataclass(frozen=True)
class Named:
    """A name of the reference, as docs/reference.toml has it."""

    name: str
    short: str = ""
    example: str = ""
    shows: str = ""
    see: tuple[str, ...] = ()
    index: tuple[str, ...] = ()
    members: tuple[str, ...] = ()

    @property
    def object(self) -> Any:
        """What has this name."""
        module, _, last = self.name.rpartition(".")
        return getattr(import_module(module), last)

    @property
    def title(self) -> str:
        """In headings and lists: the name under which it is imported, or that of a class that is returned."""
        return self.short or (self.name if self.called else self.last)

    @property
    def last(self) -> str:
        """The last part of the name."""
        return self.name.rpartition(".")[2]

    @property
    def called(self) -> bool:
        """Whether it is imported from ``ancf``, ``ancf.catenary`` or ``ancf.paper`` by those who use it."""
        return self.name.rpartition(".")[0] in ("ancf", "ancf.catenary", "ancf.paper", "ancf.results")

    @property
    def summary(self) -> str:
        """First sentence of its docstring."""
        return first_line(self.object)


@dataclass(frozen=True)
class Group:
    """Names on one page of contents."""

    title: str
    page: str
    text: str
    names: tuple[Named, ...]


@functools.cache
def contents() -> tuple[list[Group], frozenset[str]]:
    """Groups of the reference, and attributes of classes that are not for users."""
    with (DOCS / "reference.toml").open("rb") as file:
        data = tomllib.load(file)
    groups = []
    for group in data["group"]:
        given = [{"name": n} if isinstance(n, str) else n for n in group["names"]]
        names = tuple(Named(**{key: clean(value) for key, value in one.items()}) for one in given)
        groups.append(Group(group["title"], group["page"], group["text"], names))
    return groups, frozenset(data["hidden"])


@functools.cache
def examples() -> dict[str, str]:
    """Examples that several names share."""
    with (DOCS / "reference.toml").open("rb") as file:
        return dict(tomllib.load(file)["examples"])


def clean(value: Any) -> Any:
    """A value of the file as a field."""
    return tuple(value) if isinstance(value, list) else value.lstrip("\n")


def all_names() -> list[Named]:
    """Names of all groups."""
    return [named for group in contents()[0] for named in group.names]


def first_line(thing: Any) -> str:
    """First paragraph of a docstring, in one line."""
    return " ".join((inspect.getdoc(thing) or "").split("\n\n")[0].split())


def members(named: Named) -> list[str]:
    """Public methods and properties of a class, those that it inherits too, in the order of the alphabet."""
    cls = named.object
    if named.members:
        return list(named.members)
    if not inspect.isclass(cls) or issubclass(cls, BaseException):
        return []
    hidden = contents()[1]
    return [name for name in dir(cls) if name[0] != "_" and name not in hidden and documented(cls, name)]


def documented(cls: type, name: str) -> bool:
    """Whether an attribute is a method or a property with a text of its own."""
    found = inspect.getattr_static(cls, name)
    kinds = (property, functools.cached_property, classmethod, staticmethod)
    known = inspect.isfunction(found) or isinstance(found, kinds)
    ours = any(name in vars(base) and base.__module__.startswith("ancf") for base in cls.__mro__)
    return known and ours and bool(inspect.getdoc(getattr(cls, name)))


# --- what other pages say


@functools.cache
def sources() -> tuple[tuple[str, str, tuple[Block, ...]], ...]:
    """Name, text and blocks of the pages that show how things are used."""
    found = []
    for folder in ("tutorials", "howto"):
        for page in sorted((DOCS / folder).glob("*.md")):
            if not page.name.startswith("write_a"):
                text = page.read_text(encoding="utf-8")
                found.append((f"{folder}/{page.stem}", text, tuple(blocks(page))))
    return tuple(found)


def pattern(named: Named) -> re.Pattern[str]:
    """How a page names it in its code."""
    if named.name.startswith("ancf.catenary."):
        return re.compile(rf"\bcatenary\.{named.last}\b")
    return re.compile(rf"\b{re.escape(named.name)}\b" if named.called else rf"\b{named.last}\b")


def shortest(found: re.Pattern[str], language: str) -> tuple[str, Block] | None:
    """The shortest block with this pattern, and its page."""
    fit = [
        (len(block.text), page, block)
        for page, _, all_blocks in sources()
        for block in all_blocks
        if block.language == language and found.search(block.text) and shown(page, block)
    ]
    return min(fit, key=lambda one: one[:2])[1:] if fit else None


def shown(page: str, block: Block) -> bool:
    """Whether a reader of the page sees the block."""
    lines = (DOCS / f"{page}.md").read_text(encoding="utf-8").splitlines()
    return lines[block.line - 2].startswith("```")


def uses(found: re.Pattern[str]) -> list[str]:
    """Pages whose text has this pattern, those first that have it most often."""
    counts = [(len(found.findall(text)), page) for page, text, _ in sources()]
    return [page for count, page in sorted(counts, key=lambda one: (-one[0], one[1])) if count][:USES]


# --- pages


def example(named: Named) -> list[str]:
    """Lines of the section with an example."""
    if text := named.example or examples().get(named.shows, ""):
        return [*heading("Example"), *code("python", text.lstrip("\n"))]
    found = shortest(pattern(named), "python")
    if found is None:
        return []
    return [*heading("Example"), *code("python", found[1].text), "", f"From :doc:`/{found[0]}`."]


def see_also(given: tuple[str, ...], beside: list[str], found: re.Pattern[str]) -> list[str]:
    """Lines of the section with links: to other names, then to pages."""
    known = {named.name: named for named in all_names()}
    names = [name for name in (*given, *beside) if name in known]
    pages = list(dict.fromkeys([*(name for name in given if name not in known), *uses(found)]))
    items = [f"* :doc:`{known[n].title} <{n}>`: {known[n].summary}" for n in dict.fromkeys(names)]
    items += [f"* :doc:`/{page}`" for page in pages]
    return [*heading("See also"), *items] if items else []


def beside(named: Named) -> list[str]:
    """Names that share its example, or else its neighbours in the group."""
    group = next(group.names for group in contents()[0] if named in group.names)
    k = group.index(named)
    shared = [one.name for one in all_names() if named.shows and one.shows == named.shows]
    near = shared if len(shared) > 1 else [one.name for one in group[max(k - 2, 0) : k + 3]]
    return [name for name in near if name != named.name][:USES]


def heading(text: str, mark: str = "-") -> list[str]:
    """A heading and its line."""
    return ["", text, mark * len(text), ""]


def code(language: str, text: str) -> list[str]:
    """A block of code."""
    return [f".. code-block:: {language}", "", textwrap.indent(text.rstrip(), "   "), ""]


def index(words: tuple[str, ...]) -> list[str]:
    """Entries of the index, which the search finds too."""
    return [f".. index:: {', '.join(words)}", ""] if words else []


def page_of(named: Named) -> str:
    """The page of a class or a function."""
    found = members(named)
    lines = [*index(named.index), *heading(named.title, "=")]
    if inspect.isclass(named.object):
        lines += table(named, found)
        lines += [f".. autoclass:: {named.name}"]
        lines += ["   :show-inheritance:"] * issubclass(named.object, BaseException)
        if found:
            lines += [f"   :members: {', '.join(found)}"]
    else:
        lines += [f".. autofunction:: {named.name}"]
    lines += [*example(named), *see_also(named.see, beside(named), pattern(named))]
    return "\n".join(lines) + "\n"


def table(named: Named, found: list[str]) -> list[str]:
    """What can be asked of a class, in short."""
    if len(found) < 4:
        return []
    lines = [f"{named.summary}", "", ".. list-table::", "   :widths: 30 70", ""]
    for name in found:
        text = first_line(getattr(named.object, name))
        lines += [f"   * - :py:obj:`{name} <{named.name}.{name}>`", f"     - {text}"]
    return [*lines, ""]


def group_page(group: Group) -> str:
    """Contents of a group."""
    text = re.sub(r"\[\]\((/[\w/]+)\.md\)", r":doc:`\1`", group.text)
    lines = [*heading(group.title, "="), text.replace("`", "``") if ":doc:" not in text else text, ""]
    lines += [".. list-table::", "   :widths: 35 65", ""]
    for named in group.names:
        lines += [f"   * - :doc:`{named.title} <{named.name}>`", f"     - {named.summary}"]
    return "\n".join([*lines, "", *tree([f"{n.title} <{n.name}>" for n in group.names])])


def tree(entries: list[str]) -> list[str]:
    """Hidden contents, for the list at the side."""
    return [".. toctree::", "   :hidden:", "", *(f"   {entry}" for entry in entries), ""]


# --- commands


def commands() -> Iterator[tuple[str, Any]]:
    """Commands by the words that call them."""
    import typer

    from ancf.cli.app import app

    def walk(words: str, command: Any) -> Iterator[tuple[str, Any]]:
        if hasattr(command, "commands"):
            for name, inner in command.commands.items():
                yield from walk(f"{words} {name}", inner)
        else:
            yield words, command

    yield from walk("ancf", typer.main.get_command(app))


def command_page(words: str, command: Any) -> str:
    """The page of a command: its text, its arguments and options, how it is called."""
    import click

    context = click.Context(command, info_name=words)
    usage = " ".join(command.collect_usage_pieces(context))
    lines = [*heading(words, "="), *code("text", f"{words} {usage}")]
    lines += [f"{escaped(part)}\n" for part in inspect.cleandoc(command.help).split("\n\n")]
    rows = []
    for param in command.params:
        record = param.get_help_record(context)
        what, text = record or (param.make_metavar(context), getattr(param, "help", None) or "")
        rows += [f"   * - ``{what}``", f"     - {escaped(text)}"]
    if rows:
        lines += [".. list-table::", "   :widths: 40 60", "", *rows, ""]
    found = re.compile(rf"^(?:\$ )?{re.escape(words)} (?!--help)", re.MULTILINE)
    if one := shortest(found, "console"):
        lines += [*heading("Example"), *code("console", one[1].text), "", f"From :doc:`/{one[0]}`."]
    links = see_also(("howto/command_line",), [], re.compile(re.escape(words)))
    return "\n".join([*lines, *links]) + "\n"


def escaped(text: str) -> str:
    """A text of the command line in reStructuredText."""
    return " ".join(re.sub(r"([*`_|\\]|--)", r"\\\1", text).split())


def commands_page() -> str:
    """Contents of the commands."""
    lines = [*heading("Commands", "=")]
    lines += ["Exit codes: 0 success, 1 failed solve, 2 wrong input.", ""]
    lines += [".. list-table::", "   :widths: 35 65", ""]
    entries = []
    for words, command in commands():
        page = words.replace(" ", "-")
        entries.append(f"{words} <{page}>")
        text = escaped(" ".join(inspect.cleandoc(command.help).split("\n\n")[0].split()))
        lines += [f"   * - :doc:`{words} <{page}>`", f"     - {text}"]
    return "\n".join([*lines, "", *tree(entries)])


# --- all of it


def pages() -> Iterator[tuple[str, str]]:
    """Every page by its file name."""
    for group in contents()[0]:
        yield group.page, group_page(group)
    yield "commands", commands_page()
    for named in all_names():
        yield named.name, page_of(named)
    for words, command in commands():
        yield words.replace(" ", "-"), command_page(words, command)


def write() -> None:
    """Write the pages that changed; those of names that are gone go too."""
    TARGET.mkdir(exist_ok=True)
    made = {f"{name}.rst": text for name, text in pages()}
    for path in TARGET.iterdir():
        if path.name not in made:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    for name, text in made.items():
        path = TARGET / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def leave_prose(app: Any, document: Any) -> None:
    """Take away the links of words that describe a type in a docstring, such as "size" in "(n, size)"."""
    from sphinx.addnodes import pending_xref

    for link in list(document.findall(pending_xref)):
        target = link.get("reftarget", "")
        if link.get("reftype") == "class" and target.islower() and not target.startswith("ancf."):
            link.replace_self(link.children)


def setup(app: Any) -> dict[str, Any]:
    """Sphinx's entry: make the pages before the pages are looked for."""
    app.connect("builder-inited", lambda _: write())
    app.connect("doctree-read", leave_prose)
    return {"parallel_read_safe": True}
