"""Check that every link inside the built documentation leads somewhere: page, file and place in the page.

Run after the build: python docs/check_links.py docs/_build/html
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

#: Attributes that lead somewhere, by tag.
LEADING = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "src", "iframe": "src"}


class Page(HTMLParser):
    """Links and places of an HTML page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note where a tag leads and what it is called."""
        given = dict(attrs)
        self.places |= {given[key] for key in ("id", "name") if given.get(key)}
        target = given.get(LEADING.get(tag, ""))
        if target:
            self.links.append(target)


def broken(root: Path) -> Iterator[str]:
    """Each link that leads nowhere, as ``page: link: what is missing``."""
    pages = {path.resolve(): Page(path.read_text(encoding="utf-8")) for path in root.rglob("*.html")}
    for path, page in pages.items():
        for link in dict.fromkeys(page.links):
            missing = lost(path, link, pages)
            if missing:
                yield f"{path.relative_to(root.resolve())}: {link}: {missing}"


def lost(path: Path, link: str, pages: dict[Path, Page]) -> str:
    """What is missing at the end of a link, or nothing; links to other sites are not followed."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return ""
    target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
    if not target.exists():
        return "no such file"
    if not parts.fragment or target not in pages:
        return ""
    found = unquote(parts.fragment) in pages[target].places
    return "" if found else f"no place #{parts.fragment} there"


def main(folder: str) -> int:
    """Print what is broken; 1 if anything is, or if there are no pages."""
    root = Path(folder)
    count = sum(1 for _ in root.rglob("*.html"))
    lines = list(broken(root))
    print("\n".join([*lines, f"{count} pages, {len(lines)} broken links"]))
    return 1 if lines or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "docs/_build/html"))
