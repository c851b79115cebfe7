"""``ancf docs``: the pages that come with the package, in the terminal or as files."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from ..errors import ModelError
from ..files import exists, writing
from .screen import console

#: Beside the package where it is installed, beside the sources in a clone.
PLACES = (Path(__file__).parent.parent / "docs", Path(__file__).parents[3] / "docs")
#: Pages shown when so many or fewer have a word, in full the first one.
SHOWN = 8
#: Letters of a word that is not looked for at the beginning of longer ones.
SHORT = 4
#: Pages behind what is to be done: equations, checks, and what developers need.
BEHIND = "theory/", "verification/", "architecture", "howto/write_"
#: Words that say nothing of what is looked for.
SMALL = frozenset(
    ("a", "an", "and", "by", "do", "for", "how", "in", "is", "of", "on", "the", "to", "what", "with")
)
#: Words of the index at the head of a page.
INDEX = re.compile(r"^:::\{index\}(?P<words>[^\n]*)\n:::\n+", re.MULTILINE)

#: A picture with its options and its caption, and a link whose words are the title of its page.
FIGURE = re.compile(r"^```\{figure\}[^\n]*\n(?::[^\n]*\n)*(?P<caption>.*?)^```\n", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[\]\((?P<path>[^)#\s]+\.md)?(?:#(?P<place>[^)\s]*))?\)")


def folder() -> Path:
    """Where the pages are.

    Raises
    ------
    ModelError
        They were not installed with the package.
    """
    for place in PLACES:
        if exists(place / "limits.md"):
            return place
    raise ModelError("docs", "were not installed with the package", "install it again from its wheel")


def pages() -> dict[str, Path]:
    """Files of the pages by their names, such as ``howto/winch``."""
    source = folder()
    made = ("_build", "reference")  # of the site
    found = sorted(file for file in source.rglob("*.md") if not set(made) & set(file.parts))
    return {file.relative_to(source).with_suffix("").as_posix(): file for file in found}


def title(file: Path) -> str:
    """First heading of a page."""
    with file.open(encoding="utf-8") as lines:
        return next((line.lstrip("# ").strip() for line in lines if line.startswith("# ")), "")


def ranked(asked: str) -> list[str]:
    """Pages about a word or several: with them as they are, else with all of them, else with the most."""
    found = _about(asked)
    words = [word for word in re.findall(r"[\w-]+", asked.casefold()) if word not in SMALL]
    if found or len(words) < 2:
        return found
    each = [_about(word) for word in words]
    every = dict.fromkeys(name for names in each for name in names)

    def place(name: str) -> tuple[int, int]:
        places = [names.index(name) for names in each if name in names]
        return -len(places), sum(places)

    return sorted(every, key=place)


def _about(asked: str) -> list[str]:
    """Pages with a word: of that name, with it in their names or index, in titles, then by count.

    A word is found at its beginning: "joint" in joints, "cite" in cited and not in excited; a short one as it
    is or with an s.
    """
    wanted, found = asked.casefold().strip(), []
    end = r"s?(?!\w)" if len(wanted) <= SHORT else ""
    pattern = re.compile(rf"(?<!\w){re.escape(wanted)}{end}")
    for name, file in pages().items():
        text = file.read_text(encoding="utf-8").casefold()
        count = len(pattern.findall(text))
        index = [one.strip() for words in INDEX.findall(text) for one in words.split(",")]
        named = bool(pattern.search(name.rpartition("/")[2].replace("_", " "))) or wanted in index
        titled = bool(pattern.search(title(file).casefold()))
        if count or named or titled or wanted == name:
            theory = name.startswith(BEHIND)
            found.append((name != wanted, not named, theory, not titled, -count, name))
    return [name for *_, name in sorted(found)]


def show_docs(word: str | None, copy: Path | None) -> None:
    """List pages, print the one about a word, or copy all files to a folder.

    Raises
    ------
    ModelError
        No page has the word, a file of that name is there with another content, or it cannot be written.
    """
    if copy is not None:
        _copied(copy)
        return
    if word is None:
        _listed(list(pages()))
        console().print("\none of them: ancf docs NAME; about something: ancf docs WORD", markup=False)
        return
    names = ranked(word.strip())
    if not word.strip() or not names:
        raise ModelError(word or '""', "is on no page", "ancf docs lists all pages")
    _printed(pages()[names[0]])
    if len(names) > 1:
        console().print("\nmore about it:", markup=False)
        _listed(names[1 : SHOWN + 1])


def _listed(names: list[str]) -> None:
    found = pages()
    width = max(map(len, names))
    for name in names:
        console().print(f"{name:<{width}}  {title(found[name])}", soft_wrap=True, markup=False)


def _printed(file: Path) -> None:
    """A page as it is in a file or a pipe, with its headings and tables drawn in a terminal."""
    text = plain(file)
    out = console()
    if not out.is_terminal:
        out.print(text, soft_wrap=True, markup=False, highlight=False)
        return
    from rich.markdown import Markdown

    out.print(Markdown(text))


def plain(file: Path) -> str:
    """Text of a page without the marks that only its site understands.

    A link without words has the title and the name of its page; a picture is left out, its caption stays.
    """
    text = re.sub(r"<!--.*?-->\n?", "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
    text = FIGURE.sub(lambda found: found["caption"].strip() + "\n", INDEX.sub("", text))
    text = re.sub(r"^% .*\n", "", text, flags=re.MULTILINE)
    return LINK.sub(lambda found: _named(file, found["path"], found["place"]), text)


def _named(file: Path, path: str | None, place: str | None) -> str:
    """What a link without words leads to: a page, or a section of the same one."""
    if path is None:
        return f'"{(place or "").replace("-", " ").capitalize()}"'
    target = (file.parent / path).resolve()
    if not exists(target):
        return path
    name = target.relative_to(folder().resolve()).with_suffix("").as_posix()
    return f'"{title(target)}" (`ancf docs {name}`)'


def _copied(copy: Path) -> None:
    source = folder()
    files = [*pages().values(), *sorted((source / "howto").glob("*.py"))]
    targets = [copy / file.relative_to(source) for file in files]
    for file, target in zip(files, targets, strict=True):
        if exists(target) and target.read_bytes() != file.read_bytes():
            raise ModelError(str(target), "is there and has changed", "copy to another folder")
    for file, target in zip(files, targets, strict=True):
        with writing(target):
            shutil.copyfile(file, target)
    console().print(f"copied: {len(files)} files to {copy}", soft_wrap=True)
