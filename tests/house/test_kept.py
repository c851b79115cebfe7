"""Parts of kernels that are kept for other processes and other kernels."""

import importlib.util
import multiprocessing
import os
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core import event

from ancf import kept

compiling = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="kernels are interpreted")

SOURCE = """
from typing import NamedTuple

import numba
from ancf import kept
from ancf.compiled import PART
from ancf.parts import part


class Pair(NamedTuple):
    first: float
    second: float


def kept_part(function):
    return part(function, PART, lambda dispatcher: kept.use(dispatcher, STAMP))


@kept_part
def doubled(x):
    return 2.0 * x


@kept_part
def raised(x, n):
    y = 1.0
    for _ in range(n):
        y *= x
    return doubled(y)


@kept_part
def total(values):
    s = 0.0
    for x in values:
        s += x
    return s, len(values)


@kept_part
def swapped(pair):
    return Pair(pair.second, pair.first)


@kept_part
def applied(function, x):
    return function(x) + 1.0


def scaled_by(factor):
    @kept_part
    def scaled(x):
        return factor * x

    return scaled


thrice, fourfold = (scaled_by(factor) for factor in FACTORS)


@numba.njit
def asked(x, n, values):
    s, m = total(values)
    pair = swapped(Pair(x, s))
    return raised(x, n) + s * m + 10.0 * pair.first + applied(doubled, x) + thrice(x) + 100.0 * fourfold(x)
"""
PARTS = {"doubled", "raised", "total", "swapped", "applied", "scaled"}


class Names(event.Listener):
    def __init__(self):
        self.all = []

    def on_start(self, event):
        self.all.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Import a file of parts as a new process would; what it gives and which functions were compiled."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(kept, "_ROOT", str(tmp_path) + os.sep)
    monkeypatch.setattr(kept, "_shelves", {})
    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # of files that change within a second

    def found(values, factors=(3.0, 4.0), stamp="first", folder=tmp_path):
        kept._shelves.clear()
        path = folder / "some_parts.py"
        path.write_text(f"FACTORS = {factors}\nSTAMP = {stamp!r}\n{SOURCE}")
        spec = importlib.util.spec_from_file_location("some_parts", path)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "some_parts", module)
        spec.loader.exec_module(module)
        with event.install_listener("numba:compile", Names()) as names:
            value = module.asked(2.0, 3, values)
        return value, names.all

    return found


def value_of(values, factors=(3.0, 4.0)):
    s = float(sum(values))
    return 16.0 + s * len(values) + 10.0 * s + 5.0 + 2.0 * factors[0] + 200.0 * factors[1]


@compiling
@pytest.mark.parametrize(
    "values", [np.arange(4.0), np.arange(8.0)[::2], (1.0, 2.0, 4.0)], ids=["row", "strided", "tuple"]
)
def test_what_was_compiled_is_read(run, values):
    value, names = run(values)
    assert value == value_of(values)
    assert set(names) >= PARTS
    value, names = run(values)
    assert value == value_of(values)
    assert set(names) == {"asked"}


@compiling
def test_parts_for_other_types_are_compiled(run):
    run(np.arange(4.0))
    value, names = run((1.0, 2.0))
    assert value == value_of((1.0, 2.0))
    assert names == ["asked", "total"]


@compiling
@pytest.mark.parametrize("factors", [(4.0, 3.0), (3.0, 3.0), (5.0, 4.0)])
def test_functions_of_one_name_are_told_apart_by_what_is_closed_in(run, factors):
    values = np.arange(4.0)
    run(values)
    value, names = run(values, factors)
    assert value == value_of(values, factors)
    assert names.count("scaled") == len(set(factors) - {3.0, 4.0})


def scaled_by(factor):
    return lambda x: factor * x


@pytest.mark.parametrize(
    "given", [(3.0, 4.0), (3, 3.0), (True, 1), ("a", "b"), (scaled_by(1.0), scaled_by(2.0))]
)
def test_what_is_closed_in_tells_functions_apart(monkeypatch, given):
    monkeypatch.setattr(kept, "_ROOT", str(Path(__file__).parent) + os.sep)
    first, second = map(scaled_by, given)
    assert kept._of_function(first) != kept._of_function(second)
    assert kept._of_function(first) == kept._of_function(scaled_by(given[0]))


@pytest.mark.parametrize("given", [[1.0], np.ones(2), object(), len])
def test_what_nothing_tells_is_not_kept(monkeypatch, given):
    monkeypatch.setattr(kept, "_ROOT", str(Path(__file__).parent) + os.sep)
    with pytest.raises(kept.UntoldError):
        kept._of_function(scaled_by(given))


COUNT = "from ancf import kept; print(next(kept.bytecode.FunctionIdentity._unique_ids))"


def test_no_two_processes_count_alike():
    """Compiled names end in a number: with equal ones code of another process would stand for this one's."""
    here = next(kept.bytecode.FunctionIdentity._unique_ids)
    there = subprocess.run(
        [sys.executable, "-c", COUNT], capture_output=True, text=True, check=True, timeout=600
    )
    assert abs(here - int(there.stdout)) > 10**6


@compiling
def test_other_sources_compile_anew(run, tmp_path):
    values = np.arange(4.0)
    run(values, stamp="first")
    value, names = run(values, stamp="second")
    assert value == value_of(values)
    assert set(names) >= PARTS
    assert [path.name for path in (tmp_path / "cache").rglob("*.parts")] == ["ancf.second.parts"]


@compiling
def test_functions_of_users_are_not_kept(run, tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "_ROOT", str(tmp_path / "package") + os.sep)
    for _ in range(2):
        value, names = run(np.arange(4.0))
        assert value == value_of(np.arange(4.0))
        assert set(names) >= PARTS
    assert not list(tmp_path.rglob("*.parts"))


@compiling
@pytest.mark.parametrize("hostile", ["link", "pipe", "folder", "noise"])
def test_what_is_in_the_way_is_left(run, tmp_path, hostile):
    values = np.arange(4.0)
    run(values)
    (path,) = tmp_path.rglob("*.parts")
    path.unlink()
    other = tmp_path / "other"
    other.write_bytes(b"untouched")
    if hostile == "link":
        path.symlink_to(other)
    elif hostile == "pipe":
        os.mkfifo(path)
    elif hostile == "folder":
        path.mkdir()
    else:
        path.write_bytes(bytes(range(256)) * 40)
    value, names = run(values)
    assert value == value_of(values)
    assert set(names) >= PARTS
    assert other.read_bytes() == b"untouched"


@compiling
def test_code_that_cannot_be_read_is_compiled(run, tmp_path, monkeypatch):
    values = np.arange(4.0)
    run(values)
    monkeypatch.setattr(
        kept.PartLibrary, "read", lambda *given: (_ for _ in ()).throw(RuntimeError("no bitcode"))
    )
    value, names = run(values)
    assert value == value_of(values)
    assert set(names) >= PARTS


@compiling
def test_without_a_place_nothing_is_kept(run, tmp_path, monkeypatch):
    def full(*given):
        raise OSError(28, "No space left on device")

    tries = []
    monkeypatch.setattr(kept.os, "pwrite", lambda *given: tries.append(1) or full())
    value, _ = run(np.arange(4.0))
    assert value == value_of(np.arange(4.0))
    assert len(tries) == 1  # and not once more for each part


@pytest.mark.parametrize("cut", [1, 7, 40, 130, 200])
def test_what_a_killed_process_left_half_written_goes(tmp_path, cut):
    whole = [(bytes([k]) * 32, bytes([k]) * (10 + 30 * k)) for k in range(6)]
    shelf = kept.Shelf(str(tmp_path), "stamp")
    for key, part in whole:
        shelf.add(key, part)
    (path,) = tmp_path.glob("*.parts")
    size = path.stat().st_size
    os.truncate(path, size - cut)
    other = kept.Shelf(str(tmp_path), "stamp")
    there = [other.find(key) for key, _ in whole]
    assert there[:3] == [part for _, part in whole[:3]]
    assert there[-1] is None
    other.add(*whole[-1])
    third = kept.Shelf(str(tmp_path), "stamp")
    again = [third.find(key) for key, _ in whole]
    assert again == [*there[:-1], whole[-1][1]]
    assert shelf.find(b"none") is None  # what it has read is not there any more


def test_a_folder_that_was_cleared_begins_anew(tmp_path):
    shelf, other = (kept.Shelf(str(tmp_path), "stamp") for _ in range(2))
    shelf.add(b"first", b"1" * 100)
    (path,) = tmp_path.glob("*.parts")
    path.unlink()
    other.add(b"second", b"2" * 300)
    assert shelf.find(b"second") == b"2" * 300
    shelf.add(b"third", b"3")
    assert kept.Shelf(str(tmp_path), "stamp").find(b"second") == b"2" * 300
    assert kept.Shelf(str(tmp_path), "stamp").find(b"third") == b"3"


def filled(folder, k):
    shelf = kept.Shelf(folder, "stamp")
    for n in range(40):
        shelf.add(f"{k} {n}".encode(), os.urandom(1 + 97 * n))


@pytest.mark.skipif(sys.platform == "win32", reason="there are no locks")
def test_processes_write_at_once(tmp_path):
    processes = [
        multiprocessing.get_context("fork").Process(target=filled, args=(str(tmp_path), k)) for k in range(4)
    ]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
        assert process.exitcode == 0
    shelf = kept.Shelf(str(tmp_path), "stamp")
    sizes = [[len(shelf.find(f"{k} {n}".encode())) for n in range(40)] for k in range(4)]
    assert sizes == [[1 + 97 * n for n in range(40)]] * 4


def filled_when(told, folder):
    told.wait()
    filled(folder, 0)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no locks")
def test_a_process_waits_for_who_writes(tmp_path):
    fork = multiprocessing.get_context("fork")
    told = fork.Event()
    process = fork.Process(target=filled_when, args=(told, str(tmp_path)))
    process.start()
    with kept.alone(str(tmp_path)):
        told.set()
        process.join(1.0)
        waits = process.is_alive()
    process.join()
    assert waits
    assert process.exitcode == 0
    assert len(kept.Shelf(str(tmp_path), "stamp").find(b"0 39")) == 1 + 97 * 39


OF_THE_PACKAGE = """
import ancf, sys
from numba.core import event
from ancf.compilation import needed
names = []
class Names(event.Listener):
    def on_start(self, event): names.append(event.data["dispatcher"].py_func.__module__)
    def on_end(self, event): pass
event.register("numba:compile", Names())
model = ancf.Model(gravity=[0, 0, -9.81])
section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
model.add_beam("cable", start=[0, 0, 0], end=[1, 0, 0], elements=2, section=section)
needed(model, ancf.Trapezoidal()).operations[0][0].compile(needed(model, ancf.Trapezoidal()).operations[0][1])
print(len(names), sorted({name for name in names if name.startswith("ancf")}))
"""


@compiling
@pytest.mark.skipif(sys.platform == "win32", reason="there are no locks")
def test_an_element_is_compiled_once_by_all_processes(tmp_path):
    env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}

    def compiled():
        done = subprocess.run(
            [sys.executable, "-c", OF_THE_PACKAGE], env=env, capture_output=True, text=True, timeout=600
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.split(maxsplit=1)

    first = int(compiled()[0])
    for kernel in [*tmp_path.rglob("*.nbi"), *tmp_path.rglob("*.nbc")]:
        kernel.unlink()  # machine code, not parts
    again, modules = compiled()
    assert first > 10
    assert int(again) <= 6, modules  # the kernel, and choices that numba makes for its types
