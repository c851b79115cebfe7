"""Generated damage of results files: a file opens and answers, or is refused with its name and a reason.

The file has every kind of body and connection; bytes, attributes, data sets, groups and links are changed.
"""

import contextlib
import io
import shutil
import warnings
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ancf
import damage
from ancf.cli.check import check_file
from ancf.cli.info import show_info
from ancf.viz.export import write_csv, write_vtk
from ancf.viz.view import view_page
from fuzzing import cases, refused_or_fine


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    path = tmp_path_factory.mktemp("right") / "right.h5"
    damage.write(path)
    return path


def written(path):
    """What the commands make of a file: words, tables, a mesh, a page."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        for command in (check_file, show_info):
            with refused_or_fine():
                command(path)
    assert "\x1b" not in said.getvalue()
    with refused_or_fine():
        write_csv(ancf.load(path), path.with_suffix(""))
    with refused_or_fine():
        write_vtk(ancf.load(path), path.with_suffix(".vtkhdf"))
    with refused_or_fine(), patch("ancf.viz.view.page.plotly_script", return_value=""):
        assert "</html>" in view_page(ancf.load(path))


def test_right_file(right):
    result = ancf.load(right)
    assert result.status == "complete"
    damage.ask(result, states=False)
    assert len(result.sensors.names) == 5
    written(right)


@cases(0.16)
@given(data=st.data())
def test_results_files(right, data):
    path = right.with_name("damaged.h5")
    path.unlink(missing_ok=True)  # a result that is still open keeps the old file
    shutil.copyfile(right, path)
    by_command = data.draw(st.integers(0, 5)) == 0
    states = damage.damage(path, data.draw)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with refused_or_fine():
            damage.ask(ancf.load(path), states)
        if by_command:
            written(path)
