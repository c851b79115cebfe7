"""Writing files: one error for whatever prevents it, nothing half-written, JSON that every reader takes."""

import errno
import json

import h5py
import numpy as np
import pytest

import ancf
from ancf.files import drafted, plain, problem, to_json, writable, write_text, writing


class TestWriting:
    def test_makes_the_folder(self, tmp_path):
        path = tmp_path / "a" / "b" / "c.txt"
        assert write_text(path, "µ\n") == path
        assert path.read_bytes() == "µ\n".encode()

    def test_a_file_in_the_way(self, tmp_path):
        (tmp_path / "taken").write_text("x")
        with pytest.raises(ancf.ModelError, match=r"a file stands in the way \(choose another place\)"):
            write_text(tmp_path / "taken" / "a.txt", "")
        with pytest.raises(ancf.ModelError, match="a file stands in the way"):
            writable(tmp_path / "taken")

    def test_a_folder_of_that_name(self, tmp_path):
        with pytest.raises(ancf.ModelError) as caught:
            write_text(tmp_path, "")
        assert (caught.value.where, caught.value.what) == (
            str(tmp_path),
            "cannot be written: Is a directory",
        )

    def test_a_name_that_no_system_takes(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="cannot be written: its name holds a null byte"):
            write_text(tmp_path / "a\0b" / "c.txt", "")

    def test_the_systems_word_for_it_through_hdf5(self, tmp_path):
        with pytest.raises(ancf.ModelError) as caught, writing(tmp_path / "a"):
            h5py.File(tmp_path, "w")
        assert caught.value.what == "cannot be written: Is a directory"

    def test_other_errors_pass(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="beam: is wrong"), writing(tmp_path / "a"):
            raise ancf.ModelError("beam", "is wrong")
        with pytest.raises(ZeroDivisionError), writing(tmp_path / "a"):
            raise ZeroDivisionError

    def test_name_in_the_message(self, tmp_path):
        (tmp_path / "taken").write_text("x")
        with pytest.raises(ancf.ModelError, match=r"^output folder: cannot be written"):
            writable(tmp_path / "taken", "output folder")

    def test_trying_a_folder_leaves_nothing(self, tmp_path):
        assert writable(tmp_path / "out") == tmp_path / "out"
        assert list((tmp_path / "out").iterdir()) == []

    def test_a_folder_that_takes_no_file(self, tmp_path, monkeypatch):
        """It is there, but the system refuses files in it: told before anything is computed."""

        def refuse(*arguments, **options):
            raise OSError(errno.EROFS, "Read-only file system")

        monkeypatch.setattr("tempfile.TemporaryFile", refuse)
        with pytest.raises(ancf.ModelError, match="cannot be written: Read-only file system"):
            writable(tmp_path)

    def test_text_that_is_no_text(self, tmp_path):
        assert write_text(tmp_path / "a", "\udcff").read_text() == "\\udcff"


class TestDrafted:
    def test_complete(self, tmp_path):
        with drafted(tmp_path / "a.csv") as draft:
            draft.write_text("new")
            assert not (tmp_path / "a.csv").exists()
        assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]

    def test_or_as_it_was(self, tmp_path):
        (tmp_path / "a.csv").write_text("old")

        def interrupted():
            with drafted(tmp_path / "a.csv") as draft:
                draft.write_text("half")
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            interrupted()
        assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("a.csv", "old")]


class TestJson:
    def test_reads_back(self, tmp_path):
        data = {
            "nan": np.nan,
            "infinite": -np.inf,
            "numpy": np.float64(0.1),
            "count": np.int64(3),
            "flag": np.bool_(True),
            "array": np.array([[1.0, np.nan]]),
            "pair": (1, "µ"),
            "path": tmp_path,
            2: None,
        }
        assert json.loads(to_json(data)) == {
            "nan": None,
            "infinite": None,
            "numpy": 0.1,
            "count": 3,
            "flag": True,
            "array": [[1.0, None]],
            "pair": [1, "µ"],
            "path": str(tmp_path),
            "2": None,
        }

    def test_keeps_kinds(self):
        assert plain(True) is True
        assert isinstance(plain(np.int64(3)), int)
        assert to_json({"a": "µ"}) == '{\n "a": "µ"\n}\n'


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(28, "No space left on device"), "No space left on device"),
        (OSError("unable to write: errno = 27, error message = 'File too large', buf"), "File too large"),
        (RuntimeError("errno = 28, error message = 'No space left on device'"), "No space left on device"),
        (ValueError("something else"), ""),
        (OSError("something else"), ""),
    ],
)
def test_problem(error, said):
    assert problem(error) == said
