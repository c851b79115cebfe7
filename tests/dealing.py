"""How tests are dealt out to the workers of pytest-xdist, from their names alone.

Its groups by a marker put the group into the name of a test, which pytest from 9.2 on does not give away any
more: each test then went to whichever worker was free, and every worker made every fixture.
"""

from xdist.scheduler import LoadScopeScheduling


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
