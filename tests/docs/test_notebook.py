"""The example notebook runs from the top, in a kernel of its own, and shows what it says."""

import re

import pytest

from places import ROOT

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

BOOK = ROOT / "examples" / "cantilever.ipynb"


@pytest.fixture(scope="module")
def cells(tmp_path_factory):
    """What each cell showed: its kinds of output with their contents, and what it printed."""
    book = nbformat.read(BOOK, as_version=4)
    place = str(tmp_path_factory.mktemp("book"))
    nbclient.NotebookClient(book, timeout=600, resources={"metadata": {"path": place}}).execute()
    return [cell.outputs for cell in book.cells if cell.cell_type == "code"]


def shown(outputs, kind):
    found = [o.data[kind] for o in outputs if o.output_type == "execute_result" and kind in o.data]
    assert len(found) == 1
    return found[0]


def test_it_is_kept_without_outputs():
    book = nbformat.read(BOOK, as_version=4)
    nbformat.validate(book)
    assert all(not c.outputs and c.execution_count is None for c in book.cells if c.cell_type == "code")


def test_models_and_results_are_tables(cells):
    assert "beam" in shown(cells[0], "text/html")
    assert "<table" in shown(cells[1], "text/html")


def test_progress_ends(cells):
    """Whatever the run says, it says no error."""
    said = "".join(o.text for o in cells[1] if o.output_type == "stream")
    assert "rror" not in said


def test_the_tip_is_where_the_paper_has_it(cells):
    """Example 7.1: 0.731 m below its clamp."""
    printed = "".join(o.text for o in cells[2] if o.output_type == "stream" and o.name == "stdout")
    assert float(re.search(r"falls ([\d.]+) m", printed)[1]) == pytest.approx(0.731, abs=0.005)


def test_picture_and_page(cells):
    assert len(shown(cells[3], "image/png")) > 5000
    page = shown(cells[4], "text/html")
    assert "<iframe" in page
    assert len(page) > 1_000_000
