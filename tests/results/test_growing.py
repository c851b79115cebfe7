"""Results files to which a run goes on to write while they are opened and looked over."""

import subprocess
import sys

import pytest

from ancf.results import hdf5

WRITER = """
import sys
import h5py
with h5py.File(sys.argv[1], "w", libver="latest") as file:
    form = {"shape": (0, 4), "maxshape": (None, 4), "chunks": (16, 4), "dtype": float}
    data = [file.create_dataset(name, **form) for name in ("s0", "s1")]
    file.swmr_mode = True
    for line in sys.stdin:
        for each in data:
            each.resize(len(each) + int(line), 0)
            each[-int(line):] = 1.0
            each.flush()
        print(len(data[0]), flush=True)
"""


@pytest.fixture
def writer(tmp_path):
    """A process that appends rows to a file, as many as it is told."""
    with subprocess.Popen(
        [sys.executable, "-c", WRITER, str(tmp_path / "grows.h5")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as child:

        def write(rows):
            print(rows, file=child.stdin, flush=True)
            return int(child.stdout.readline())

        yield write
        child.kill()


@pytest.mark.parametrize("more", [16, 160, 16000])
def test_what_is_appended_while_a_file_is_looked_over_is_not_beyond_its_end(
    tmp_path, writer, monkeypatch, more
):
    """However often a run writes between the opening and the look at the data: one look is enough."""
    path, looks, look_over = tmp_path / "grows.h5", [], hdf5._look_over
    before = writer(1600)

    def slow(path, file, whole=False):
        looks.append(writer(more))
        look_over(path, file, whole)

    monkeypatch.setattr(hdf5, "_look_over", slow)
    with hdf5.opened(path) as file:
        assert len(file["s0"]) == looks[-1] > before
    assert len(looks) == 1


def test_a_file_that_grows_is_looked_at_again(tmp_path, writer, monkeypatch):
    """A piece that was half written is no damage as long as the run goes on; afterwards it is."""
    path, looks, look_over = tmp_path / "grows.h5", [], hdf5._look_over
    writer(1600)
    monkeypatch.setattr(hdf5, "PAUSES", ())

    def torn(path, file, whole=False):
        if len(looks) < 12:
            looks.append(writer(160))
            raise OSError("checksum")
        look_over(path, file, whole)

    monkeypatch.setattr(hdf5, "_look_over", torn)
    with hdf5.opened(path) as file:
        assert len(file["s1"]) == looks[-1] == 1600 + 12 * 160
    monkeypatch.setattr(hdf5, "LIVELY", 0.0)
    looks.clear()
    with pytest.raises(hdf5.ModelError, match="or damaged: checksum"):
        hdf5.opened(path)
