"""The cache of compiled kernels: filled by processes at once, left by another version, cut off."""

import importlib
import os
import sys
import traceback
import warnings

import numba
import pytest

from ancf import compiled

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
import numba
from ancf.kernel_cache import use
from parts import part
from stamp import STAMP

def given(kind):
    return {"int": 3, "float": 1.5}[kind]

@numba.njit
def twice(x):
    return part(x)

use(twice, STAMP)
"""
PART = "import numba\n@numba.njit\ndef part(x):\n    return {factor} * x\n"
OF_EITHER = """
import importlib
import numba

def given(kind):
    return importlib.import_module(kind).Part(1.5)

@numba.njit(cache=True)
def twice(part):
    return 2 * part.x
"""
#: Waits until three processes are here.
MEET = """
import os, pathlib, time
pathlib.Path({folder!r}, f"here{{os.getpid()}}").touch()
while len([*pathlib.Path({folder!r}).glob("here*")]) < 3:
    time.sleep(0.01)

"""
CLASS = "from typing import NamedTuple\nclass Part(NamedTuple):\n    x: float\n"


def start(folder, kind):
    """A forked process, which need not import numba anew, and the end of a pipe to read what it finds."""
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of a process with threads
        child = os.fork()
    if child == 0:
        compiled.kernel_cache._said.clear()  # of this process, which may have waited too long for another one
        try:
            said = found(folder, kind)
        except BaseException:
            said = traceback.format_exc()
        os.write(writing, said.encode())
        os._exit(0)
    os.close(writing)
    return child, reading


def found(folder, kind):
    """Value and number of kernels that were in the cache."""
    assert compiled.kernel_cache  # which :mod:`ancf.compiled` has put in numba's place
    numba.config.CACHE_DIR = str(folder / "cache")
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(folder))
    kernels = importlib.import_module("kernels")
    value = kernels.twice(kernels.given(kind))
    return f"{value} {sum(kernels.twice.stats.cache_hits.values())}"


def ended(process):
    child, reading = process
    with open(reading, encoding="utf-8") as pipe:
        said = pipe.read()
    os.waitpid(child, 0)
    return said


@pytest.fixture(scope="module", autouse=True)
def numba_has_begun():
    """What the first compilation of a process looks up serves the forked ones too."""
    numba.njit(lambda x: 2 * x)(1.0)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "kernels.py").write_text(PLAIN, encoding="utf-8")
    return tmp_path


def test_processes_at_once_keep_all_kernels(folder):
    for hits in (0, 1):
        running = [start(folder, kind) for kind in ("int", "float")]
        assert [ended(process) for process in running] == [f"6 {hits}", f"3.0 {hits}"]


def test_processes_at_once_compile_a_kernel_once(tmp_path):
    """Both have looked into the empty cache's folder before the first compiles."""
    meet = MEET.format(folder=str(tmp_path))
    (tmp_path / "kernels.py").write_text(WITH_PART.replace("def given", meet + "def given"), encoding="utf-8")
    (tmp_path / "parts.py").write_text(PART.format(factor=2), encoding="utf-8")
    (tmp_path / "stamp.py").write_text("STAMP = 'a'", encoding="utf-8")
    running = [start(tmp_path, "int") for _ in range(3)]
    assert sorted(ended(process) for process in running) == ["6 0", "6 1", "6 1"]
    assert not [path.name for path in (tmp_path / "cache").rglob("*.lock") if path.name != "ancf.lock"]


def test_a_process_that_fails_lets_the_others_go_on(tmp_path):
    """What cannot be compiled cannot be compiled by any of them."""
    (tmp_path / "kernels.py").write_text(WITH_PART, encoding="utf-8")
    (tmp_path / "parts.py").write_text(PART.format(factor="'a' / 2"), encoding="utf-8")
    (tmp_path / "stamp.py").write_text("STAMP = 'a'", encoding="utf-8")
    running = [start(tmp_path, "int") for _ in range(2)]
    assert all("TypingError" in ended(process) for process in running)


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


def test_a_class_of_another_program_leaves_its_kernels(tmp_path):
    """Two programs have each an element of their own, which the other cannot import."""
    (tmp_path / "kernels.py").write_text(OF_EITHER, encoding="utf-8")
    for hits in (0, 1, 1):
        for own, other in (("mine", "yours"), ("yours", "mine")):
            (tmp_path / f"{other}.py").unlink(missing_ok=True)
            (tmp_path / f"{own}.py").write_text(CLASS, encoding="utf-8")
            assert ended(start(tmp_path, own)) == f"3.0 {hits}"
