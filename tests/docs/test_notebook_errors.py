"""What a cell of a notebook shows of an error: the caller's own lines and the message alone."""

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

BEGIN = """
import ancf
from ancf import catenary
def bad(t):
    return 1 / 0
model = ancf.Model(gravity=(0, 0, -9.81))
beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e4, EI=1, rhoA=1))
model.clamp(beam.start)
result = ancf.simulate(model, t_end=0.01, step=1e-3)
"""  # noqa: E501
#: Lines of cells, and what is said of them.
WRONG = {
    "model.add_beam('b', path=[(0, 0, 0), (1, 0, 0)], elements=-2, section=beam.section)": "needs at least 3",
    "ancf.simulate(model, t_end=0.4, step=-1)": "simulate.step: must be > 0",
    "ancf.simulate(model, t_end=0.4, step=1e-3, progress=True)": "simulate.progress: must be a function",
    "ancf.study(lambda E: {'x': E}, ancf.sample({'E': [1]}, method='grid'), progress=1)": "study.progress",
    "catenary.run('en50318-2002', speed=60, progress='bar')": "run.progress: must be a function",
    "ancf.resume('nothing.h5', progress=True)": "resume.progress: must be a function",
    "result.position('bem.end')": 'did you mean "beam"?',
    "result.plot(beam.end, 'speed')": 'quantity="speed"',
    "model.add_force(beam.end, bad)": "ZeroDivisionError",
    "ancf.Model().clamp(3)": "must be a point",
    "model.add_rod('x')": "add_rod",
}


@pytest.fixture(scope="module")
def cells(tmp_path_factory):
    wrong = [f"def mine():\n    return {line}\nmine()" for line in WRONG]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in (BEGIN, *wrong)])
    place = {"metadata": {"path": str(tmp_path_factory.mktemp("book"))}}
    nbclient.NotebookClient(book, timeout=600, allow_errors=True, resources=place).execute()
    assert not book.cells[0].outputs
    return dict(zip(WRONG, (cell.outputs for cell in book.cells[1:]), strict=True))


@pytest.mark.parametrize("line", WRONG)
def test_errors_are_short_and_name_the_cell(cells, line):
    [error] = [output for output in cells[line] if output.output_type == "error"]
    assert WRONG[line] in error.evalue
    if error.ename == "AttributeError":  # Python's own
        return
    *places, last = error.traceback
    assert last == f"{error.ename}: {error.evalue}"
    assert places == ["cell, line 3: mine()", f"cell, line 2: return {line}"]
