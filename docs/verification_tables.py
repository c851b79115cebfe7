"""Tables of the verification book in Markdown, and its numbers as text."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

Check = dict[str, Any]


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def toctree(chapters: Iterable[str]) -> str:
    """Hidden list of the chapters."""
    return "\n".join(["```{toctree}", ":hidden:", "", *chapters, "```"])


def check_table(found: list[Check], figure: bool = False) -> str:
    """Checks, with their origins numbered below."""
    origins = list(dict.fromkeys(c["origin"] for c in found))
    head = ["check", "value", "reference", "deviation", "accepted", "use", "verdict", "origin"]
    rows = [check_row(c, origins.index(c["origin"]) + 1) for c in found]
    if figure:
        head.insert(0, "exhibit")
        rows = [[f"`{c['figure']}`", *row] for c, row in zip(found, rows, strict=True)]
    notes = "\n".join(f"{k}. {text}" for k, text in enumerate(origins, 1))
    return f":::{{container}} checks\n{table(head, rows)}\n:::\n\nOrigins:\n\n{notes}"


def check_row(c: Check, origin: int) -> list[str]:
    """Cells of a check."""
    name = f"{c['name']} [{c['unit']}]" if c["unit"] else c["name"]
    shown, reference = digits(c["value"], c), digits(c["reference"], c)
    if c["rule"].startswith("at "):
        reference = f"{c['rule']} {reference}"
    verdict = "passed" if c["passed"] else "**open**"
    return [
        name,
        shown,
        reference,
        deviation(c),
        accepted(c),
        percent(use(c)),
        verdict,
        str(origin),
    ]


def deviation(c: Check) -> str:
    """Value less reference, or their ratio."""
    if c["rule"] == "factor":
        return f"factor {c['value'] / c['reference']:.3g}"
    return "0" if c["value"] == c["reference"] else minus(f"{c['value'] - c['reference']:+.1e}")


def accepted(c: Check) -> str:
    """The tolerance by its rule."""
    words: dict[str, Callable[[float], str]] = {
        "factor": lambda x: f"factor {x:g}",
        "within": lambda x: minus(f"± {x:.2g}") if x else "exact",
    }
    return words.get(c["rule"], lambda x: minus(f"{x:.2g}") if x else "")(c["tolerance"])


def use(c: Check) -> float | None:
    """Deviation as a share of the tolerance; None where there is no tolerance to use."""
    if c["rule"] == "factor":
        return abs(math.log(c["value"] / c["reference"])) / math.log(c["tolerance"])
    gap = c["value"] - c["reference"]
    short = {"within": abs(gap), "at least": -gap, "at most": gap}[c["rule"]]
    return max(short, 0.0) / c["tolerance"] if c["tolerance"] else None


def percent(share: float | None) -> str:
    """A share per cent."""
    return "" if share is None else f"{100 * share:.2g} %" if share >= 1e-3 else "< 0.1 %"


def most_used(found: Iterable[Check]) -> float | None:
    """Largest use of a tolerance."""
    return max((share for share in map(use, found) if share is not None), default=None)


def digits(number: float, c: Check) -> str:
    """As many digits as the tolerance is worth."""
    if c["rule"] == "factor" or not c["tolerance"]:
        return minus(f"{number:.5g}")
    decimals = max(0, 1 - math.floor(math.log10(c["tolerance"])))
    if decimals <= 9 and abs(number) < 1e6:
        return minus(f"{number:.{decimals}f}")
    size = math.floor(math.log10(abs(number))) if number else 0
    return minus(f"{number:.{max(2, size + decimals + 1)}g}")


def minus(text: str) -> str:
    """A minus sign instead of a hyphen."""
    return text.replace("-", "\N{MINUS SIGN}")


def range_table(rows: list[list[Any]]) -> str:
    """Rows of one case and speed."""
    head = ("quantity", "value", "range", "verdict", "tag")
    cells = [
        (
            f"{q} [{u}]",
            f"{v:.4g}",
            f"{low:g} to {high:g}",
            verdict if verdict == "inside" else f"**{verdict}**",
            tag,
        )
        for _, _, q, u, v, low, high, verdict, tag in rows
    ]
    return table(head, cells)
