"""The cache of compiled kernels: filled by processes at once, left by another version, cut off."""

import os
import subprocess
import sys

import pytest

from ancf import kernel_cache
from commands import PATIENCE

RUN = """
import runpy, sys
runpy.run_path(sys.argv[3])["share"]()  # by its path: the package takes long to import
sys.path.insert(0, sys.argv[1])
from kernels import given, twice
print(twice(given(sys.argv[2])), sum(twice.stats.cache_hits.values()))
"""
PLAIN = """
import numba

def given(kind):
    return {"int": 3, "float": 1.5}[kind]

@numba.njit(cache=True)
def twice(x):
    return 2 * x
"""
WITH_CLASS = """
import numba
from PARTS import Part

def given(kind):
    return Part({"int": 3, "float": 1.5}[kind])

@numba.njit(cache=True)
def twice(part):
    return 2 * part.x
"""
WITH_PART = """
import runpy, sys
import numba
from parts import part
from stamp import STAMP

def given(kind):
    return {"int": 3, "float": 1.5}[kind]

@numba.njit
def twice(x):
    return part(x)

runpy.run_path(sys.argv[3])["use"](twice, STAMP)
"""
PART = "import numba\n@numba.njit\ndef part(x):\n    return {factor} * x\n"
CLASS = "from typing import NamedTuple\nclass Part(NamedTuple):\n    x: float\n"


def start(folder, kind):
    return subprocess.Popen(
        [sys.executable, "-c", RUN, str(folder), kind, kernel_cache.__file__],
        env=os.environ | {"NUMBA_CACHE_DIR": str(folder / "cache")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process):
    """Value and number of kernels that were in the cache, as printed."""
    said, error = process.communicate(timeout=PATIENCE)
    assert not error
    return said.strip()


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "kernels.py").write_text(PLAIN, encoding="utf-8")
    return tmp_path


def test_processes_at_once_keep_all_kernels(folder):
    for hits in (0, 1):
        running = [start(folder, kind) for kind in ("int", "float")]
        assert [ended(process) for process in running] == [f"6 {hits}", f"3.0 {hits}"]


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
def test_file_that_was_cut_off(folder, suffix):
    assert ended(start(folder, "int")) == "6 0"
    (path,) = (folder / "cache").rglob(f"*{suffix}")
    path.write_bytes(path.read_bytes()[:-20])
    assert ended(start(folder, "int")) == "6 0"
    assert ended(start(folder, "int")) == "6 1"


def test_a_kernel_is_compiled_anew_with_what_it_calls(tmp_path):
    """Its own file is the same; the stamp of all sources tells that a part of it is another."""
    (tmp_path / "kernels.py").write_text(WITH_PART, encoding="utf-8")
    for stamp, factor in (("a", 2), ("b", 5)):
        (tmp_path / "parts.py").write_text(PART.format(factor=factor), encoding="utf-8")
        (tmp_path / "stamp.py").write_text(f"STAMP = {stamp!r}", encoding="utf-8")
        assert [ended(start(tmp_path, "int")) for _ in range(2)] == [f"{3 * factor} 0", f"{3 * factor} 1"]


def test_class_that_has_gone(tmp_path):
    """A version that keeps a class of the kernels in another file finds an index that it cannot read."""
    for name in ("old", "new"):
        (tmp_path / "old.py").unlink(missing_ok=True)
        (tmp_path / f"{name}.py").write_text(CLASS, encoding="utf-8")
        (tmp_path / "kernels.py").write_text(WITH_CLASS.replace("PARTS", name), encoding="utf-8")
        assert [ended(start(tmp_path, "float")) for _ in range(2)] == ["3.0 0", "3.0 1"]
