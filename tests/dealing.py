"""Which cases of long families are tried, and how tests are dealt out to the workers, from their names alone.

Groups of pytest-xdist by a marker put the group into the name of a test, which pytest from 9.2 on does not
give away any more: each test then went to whichever worker was free, and every worker made every fixture.
"""

import zlib
from collections import defaultdict
from functools import cache

from xdist.scheduler import LoadScopeScheduling

from places import TESTS


def unit_of(nodeid):
    """What a test shares a worker with: its file; tests of a page of the documentation with that page.

    All pages in one file would take as long as the rest of the suite.
    """
    file, _, test = nodeid.partition("::")
    parameter = test.rpartition("[")[2].removesuffix("]")
    return parameter if parameter.endswith(".md") else file


class ByFile(LoadScopeScheduling):
    """Units as :func:`unit_of` has them."""

    def _split_scope(self, nodeid):
        return unit_of(nodeid)


@cache
def families():
    """How many cases of a function are tried, by its node id, of those that would take long altogether."""
    text = (TESTS / "families.txt").read_text(encoding="utf-8")
    lines = [line.split(maxsplit=1) for line in text.splitlines() if line and not line.startswith("#")]
    return {name: int(count) for count, name in lines}


def other_cases(items):
    """Tests of such functions beside those that are tried.

    These are those whose names have the smallest checksums: neither the first of each parameter nor all with
    one value of it, and a case that is added moves no more than one of them.
    """
    found = defaultdict(list)
    for item in items:
        found[item.nodeid.partition("[")[0]].append(item)
    for function, cases in found.items():
        by_checksum = sorted(cases, key=lambda item: zlib.crc32(item.name.encode()))
        yield from by_checksum[families().get(function, len(cases)) :]
