"""Faults of files and of the environment: names, damaged files, full disks, streams, signals, caches."""

import csv
import errno
import os
import re
import signal
import sys
import threading
import time
import unicodedata
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest
import typer

import ancf
import hostile_files
from ancf import compiled, kernel_cache
from ancf.cli import screen
from ancf.cli.guard import reported
from ancf.files import cell, exists, visible
from ancf.interrupts import heed, kept
from ancf.results import hdf5
from ancf.viz.export import write_csv
from commands import LONG, MODEL, SIMULATION, apart, write

#: Classes of Unicode that turn the direction in which a text is written.
TURNS = ("LRE", "RLE", "PDF", "LRO", "RLO", "LRI", "RLI", "FSI", "PDI")


def hanging(names=(), elements=3):
    """A cable from a clamp with masses in joints of these names."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.05)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    model.clamp(beam.start)
    for k, name in enumerate(names):
        x = 0.1 + 0.05 * k  # inside elements, so that there are multipliers
        mass = model.add_point_mass(f"w{k}", mass=0.1, at=(x, 0, 0))
        model.connect(beam.at(x), mass.point, name=name)
    return model


def stored(path, **more):
    """A short run in a file."""
    return ancf.simulate(hanging(**more), t_end=5e-3, step=1e-3, file=path)


class TestNames:
    NAMES = ("a/b", "//a", ".", "..", "/", "a", "bodies", "=1+1", "ü" * 300)

    def test_any_name_of_a_joint(self, tmp_path):
        """The file gives for each joint what the run in memory gives, in any order of the names."""
        memory = ancf.simulate(hanging(self.NAMES), t_end=5e-3, step=1e-3)
        for names in (self.NAMES, self.NAMES[::-1]):
            stored(tmp_path / "r.h5", names=names)
            loaded = ancf.load(tmp_path / "r.h5")
            assert [name for name in loaded.joints if name in names] == list(names)
            for k, name in enumerate(names):
                other = self.NAMES[k]  # the same place in the model
                assert np.array_equal(loaded.multiplier(name), memory.multiplier(other))

    def test_formulas_are_text_in_csv(self, tmp_path):
        names = ("=1+1", "+a", "-a", "@sum", "=cmd|' /C calc'!A0")
        write_csv(stored(tmp_path / "r.h5", names=names), tmp_path)
        for path in tmp_path.glob("*.csv"):
            with path.open(newline="", encoding="utf-8") as file:
                head, *rows = csv.reader(file)
            assert not any(text.startswith(("=", "+", "-", "@")) for text in head)
            assert all(float(number) == float(number) for row in rows for number in row)

    @pytest.mark.parametrize("value", ["-1.5", "+3", "-1e-7", -2.0, 3, "plain", "", "a=b", None])
    def test_numbers_and_plain_text_stay(self, value):
        assert cell(value) == value


@pytest.fixture
def short_pauses(monkeypatch):
    """As many looks at a file that may be growing, with next to nothing between them."""
    monkeypatch.setattr(hdf5, "PAUSES", tuple(pause / 50 for pause in hdf5.PAUSES))


@pytest.mark.usefixtures("short_pauses")
class TestDamagedFiles:
    @pytest.mark.parametrize("killed", [False, True])
    @pytest.mark.parametrize("sensors", [None, ["beam.end"]])
    def test_cut_anywhere(self, tmp_path, killed, sensors):
        """Refused at once wherever it ends; HDF5 alone would wait for ever in a file marked as growing."""
        path = tmp_path / "r.h5"
        ancf.simulate(hanging(), t_end=5e-3, step=1e-3, file=path, sensors=sensors)
        if killed:
            hostile_files.mark(path)
            assert len(ancf.load(path).t) == 6
        whole = path.read_bytes()
        path.unlink()
        for size in (0, 7, 40, 48, 60, 200, 1000, 3000, 5000, 8000, 12_000, len(whole) // 2, len(whole) - 1):
            path.write_bytes(whole[:size])
            begin = time.perf_counter()
            with pytest.raises(ancf.ModelError, match=re_of(path)):
                ancf.load(path)
            assert time.perf_counter() - begin < 300

    def test_data_beyond_the_end_of_a_killed_run(self, tmp_path):
        """All metadata are there, so HDF5 opens the file; only the last data are not."""
        path = tmp_path / "r.h5"
        stored(path)
        with h5py.File(path, "r+", libver="latest") as file:
            file.create_dataset("more", data=np.ones(20_000), chunks=(5000,))
        hostile_files.mark(path)
        assert ancf.load(path).status == "complete"
        whole = path.read_bytes()
        last = whole.rfind(np.ones(1000).tobytes())
        path.write_bytes(whole[: last + 4000])
        with pytest.raises(ancf.ModelError, match="damaged: it is cut off"):
            ancf.load(path)

    def test_flipped_metadata_of_a_killed_run(self, tmp_path):
        path = tmp_path / "r.h5"
        stored(path)
        hostile_files.mark(path)
        whole = path.read_bytes()
        for word in (b"OHDR", b"FRHP", b"BTHD", b"FADB", b"EAHD"):
            at = whole.find(word)
            if at < 0:
                continue
            path.unlink()
            path.write_bytes(whole[: at + 5] + bytes([whole[at + 5] ^ 0xFF]) + whole[at + 6 :])
            with pytest.raises(ancf.ModelError, match="damaged"):
                ancf.load(path)

    def test_checksum(self, tmp_path):
        """Of superblocks that HDF5 wrote, whatever their length."""
        for k in range(4):
            with h5py.File(tmp_path / "x.h5", "w", libver="latest") as file:
                file["x"] = np.zeros(7**k)
            head = (tmp_path / "x.h5").read_bytes()[: hdf5.HEAD]
            assert hdf5.checksum(head[:-4]) == int.from_bytes(head[-4:], "little")

    def test_error_while_reading_states(self, tmp_path):
        """A damage that shows when states are read is a message as well."""
        result = ancf.load(stored(tmp_path / "r.h5")._store.path)

        class Broken:
            shape, file = (6, 18), type("File", (), {"filename": "r.h5"})

            def __getitem__(self, key):
                raise OSError("cannot read data")

        result._store._file = {name: Broken() for name in ("time", "q", "v", "work", "energy")}
        with pytest.raises(ancf.ModelError, match=r"r\.h5: .*cannot read data"):
            _ = result.q[0]


def re_of(path):
    """Regular expression of a message about a file."""
    return f"^{path}: (is|cannot)"


@pytest.mark.parametrize("length", [300, 1000, 5000])
def test_long_and_impossible_paths(call, length, tmp_path):
    from ancf import catenary

    for name in ("x" * length, "x" * length + ".toml", "a\0b"):
        assert not exists(Path(name))
        for function in (ancf.load, catenary.read_line):
            with pytest.raises(ancf.ModelError):
                function(name)
        with pytest.raises(ancf.ModelError):
            stored(name)
    name = "x" * length
    commands = [
        ("run", name),
        ("check", name),
        ("info", name),
        ("view", name),
        ("export", name, "--to", "csv"),
    ]
    commands += [("catenary", "form", name), ("run", write(MODEL + SIMULATION), "-o", name)]
    for command in commands:
        assert call(*command).code == 2, command


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of file sizes")
class TestFullDisk:
    @pytest.fixture
    def limited(self):
        """No file gets larger than 700 kB, as on a full disk."""
        import resource

        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (700_000, before[1]))
        yield
        resource.setrlimit(resource.RLIMIT_FSIZE, before)

    @pytest.mark.parametrize("sensors", [None, ["beam.end"]])
    @apart
    def test_the_error_carries_the_result(self, tmp_path, limited, sensors):
        path = tmp_path / "r.h5"
        with pytest.raises(ancf.SolveError, match=re_of(path) + ".*File too large") as caught:
            ancf.simulate(hanging(), t_end=20.0, step=1e-3, file=path, sensors=sensors)
        result = caught.value.result
        assert result.status == "failed"
        assert 100 < len(result.t) < 20_000
        memory = ancf.simulate(hanging(), t_end=float(result.t[50]), step=1e-3)
        assert np.array_equal(result.q[50], memory.q[-1])
        assert result.state(-1).q.shape == memory.q[-1].shape
        assert len(ancf.load(path).t) == len(result.t)

    @apart
    def test_saving(self, tmp_path, limited):
        long = ancf.simulate(hanging(), t_end=5.0, step=1e-3)
        with pytest.raises(ancf.ModelError, match="File too large"):
            long.save(tmp_path / "r.h5")

    @pytest.mark.parametrize("room", [0, 3000, 60_000])
    @apart
    def test_nothing_fits(self, tmp_path, limited, room):
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))
        with pytest.raises(ancf.ModelError, match="File too large"):
            stored(tmp_path / "r.h5")


class TestStreams:
    def test_nobody_reads_the_progress(self, tmp_path, monkeypatch):
        """`ancf run ... 2>&1 | head -1`: the run goes on, and what is left in the buffer fails nowhere."""
        reading, writing = os.pipe()
        os.close(reading)
        with open(writing, "w", encoding="utf-8") as stream:
            monkeypatch.setattr(sys, "stderr", stream)
            shown = screen.Screen()
            with shown.progress(20) as report:
                result = ancf.simulate(hanging(), t_end=0.02, step=1e-3, progress=report)
            shown.say("a remark " * 10_000)
        assert result.status == "complete"

    @pytest.mark.parametrize("error", [BrokenPipeError(), OSError(errno.EIO, "gone"), ValueError("closed")])
    def test_any_way_in_which_a_stream_goes(self, error):
        class Gone:
            encoding = "utf-8"

            def isatty(self):
                return True

            def fileno(self):
                raise OSError

            def write(self, text):
                raise error

            flush = write

        steady = screen.Steady(Gone())
        steady.write("x")
        with pytest.raises(TypeError):
            Gone().flush()

    def test_no_stream_at_all(self, call, monkeypatch):
        monkeypatch.setattr(sys, "stderr", None)
        screen.console(stderr=True).print("x")
        screen.Screen().say("x")

    def test_control_characters_are_spelt_out(self, call):
        title = "\\u001b[31mred\\u001b]0;own\\u0007 \\u009b2J"
        path = write(f'title = "{title}"\n' + MODEL.partition("\n")[2].partition("\n")[2] + SIMULATION)
        for command in (("run", path), ("info", path), ("info", "out/results.h5"), ("check", path)):
            ran = call(*command)
            assert ran.code == 0, ran.err
            assert "\x1b" not in ran.out + ran.err
            assert "\x9b" not in ran.out + ran.err
        assert "\\x1b[31mred" in call("info", "out/results.h5").out

    def test_lines_and_letters_stay(self):
        assert visible("Größe\n\tΔ 5 µm") == "Größe\n\tΔ 5 µm"
        assert visible("a\x1b\x7f\u202eb") == "a\\x1b\\x7f\\u202eb"

    def test_every_control_character_is_spelt_out(self):
        """All that Unicode counts as controls, and the turns of the direction of writing."""
        controls = [c for c in map(chr, range(0x3000)) if unicodedata.category(c) == "Cc"]
        turns = [c for c in map(chr, range(0x3000)) if unicodedata.bidirectional(c) in TURNS]
        for c in {*controls, *turns, "\u2028", "\u2029"} - {"\n", "\t"}:
            assert visible(f"a{c}b") == "a" + ascii(c)[1:-1] + "b"
        assert len(controls) == 65
        assert len(turns) >= 9


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning"
)  # a signal may come at a deletion
class TestSignals:
    @pytest.fixture(autouse=True)
    def heard(self):
        """A shell starts what it puts into the background with Ctrl-C ignored, and so it stays."""
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        yield
        signal.signal(signal.SIGINT, before)

    def test_what_is_ignored_stays_ignored(self):
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        with kept(signal.SIGINT, signal.SIGTERM):
            signal.raise_signal(signal.SIGINT)
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGTERM)
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL

    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
    def test_at_a_deletion_it_is_kept_without_a_word(self, number, monkeypatch):
        """What else goes wrong at a deletion is shown as ever."""
        shown = []
        monkeypatch.setattr(sys, "unraisablehook", lambda what: shown.append(what.exc_type))

        class Gone:
            def __init__(self, act):
                self.act = act

            def __del__(self):
                self.act()

        with kept(signal.SIGINT, signal.SIGTERM):
            Gone(lambda: signal.raise_signal(number))
            assert shown == []
            with pytest.raises(KeyboardInterrupt):
                heed()
            Gone(lambda: 1 / 0)
        Gone(lambda: 1 / 0)
        assert shown == [ZeroDivisionError, ZeroDivisionError]

    def send(self, number):
        """Send a signal to this process once a run has stored states."""

        def wait():
            end = time.monotonic() + 900
            while time.monotonic() < end:
                time.sleep(0.05)
                try:
                    if len(ancf.load("out/results.h5").t) > 10:
                        return os.kill(os.getpid(), number)
                except ancf.ModelError:
                    pass

        thread = threading.Thread(target=wait)
        thread.start()
        return thread

    @pytest.mark.parametrize(
        ("number", "code", "said"), [(signal.SIGTERM, 143, "SIGTERM"), (signal.SIGINT, 130, "Ctrl-C")]
    )
    def test_a_signal_leaves_results_and_summary(self, call, number, code, said):
        before = signal.getsignal(number)
        thread = self.send(number)
        ran = call("run", write(MODEL + LONG), "-q")
        thread.join()
        assert ran.code == code
        assert ran.err.startswith(f"stopped by {said}\n  results up to t = ")
        assert '"status": "interrupted"' in Path("out/summary.json").read_text(encoding="utf-8")
        assert ancf.load("out/results.h5").status == "interrupted"
        assert signal.getsignal(number) is before

    @pytest.mark.parametrize(
        ("number", "command"), [(signal.SIGINT, False), (signal.SIGINT, True), (signal.SIGTERM, True)]
    )
    def test_a_signal_that_python_drops_stops_the_run(self, number, command):
        """What a handler raises while an object is deleted goes nowhere."""

        class Deleted:
            def __del__(self):
                signal.raise_signal(number)

        seen, before = [], signal.getsignal(number)

        def progress(now):
            seen.append(now)
            assert len(seen) < 5, "it goes on"
            if len(seen) == 1:
                Deleted()

        def run():
            ancf.simulate(hanging(), t_end=1e4, step=0.01, progress=progress)

        if command:
            with pytest.raises(typer.Exit) as end, reported():
                run()
            assert end.value.exit_code == 128 + number
        else:
            with pytest.raises(ancf.errors.Interrupted) as stop:
                run()
            assert stop.value.result.status == "interrupted"
            assert len(stop.value.result.t) > 1
        assert len(seen) == 1
        assert signal.getsignal(number) is before
        heed()  # nothing is kept

    def test_ctrl_c_in_an_import(self, call, monkeypatch):
        """An import that is cut off ends as another error; what stopped it is said."""
        from ancf.cli import info

        def cut_off(path):
            try:
                raise KeyboardInterrupt
            except KeyboardInterrupt:
                raise ImportError("a part could not be imported")  # noqa: B904

        monkeypatch.setattr(info, "is_hdf5", cut_off)
        ran = call("info", write(MODEL))
        assert (ran.code, ran.err) == (130, "stopped by Ctrl-C\n")

    def test_ctrl_c_before_the_commands_are_there(self, monkeypatch, capsys):
        from ancf import cli

        class Cut:
            def find_spec(self, name, *rest):
                if name == "ancf.cli.app":
                    raise KeyboardInterrupt

        monkeypatch.delitem(sys.modules, "ancf.cli.app", raising=False)
        monkeypatch.delattr(cli, "app", raising=False)
        monkeypatch.setattr(sys, "meta_path", [Cut(), *sys.meta_path])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        assert stop.value.code == 130
        assert capsys.readouterr().err == "stopped by Ctrl-C\n"


class TestCache:
    def test_no_folder_for_it(self, monkeypatch):
        """The kernel works, compiled anew at each start, and it is said once."""
        from numba.core.caching import CacheImpl

        monkeypatch.setattr(CacheImpl, "_locator_classes", [])
        monkeypatch.setattr(kernel_cache, "_said", set())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            kernels = [compiled.kernel(function) for function in (_twice, _thrice)]
        assert len(caught) == 1
        assert "NUMBA_CACHE_DIR" in str(caught[0].message)
        assert [kernel(3) for kernel in kernels] == [6, 9]

    def test_a_folder_that_cannot_be_written_later(self, monkeypatch):
        def full(*arguments):
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(kernel_cache, "_said", set())
        monkeypatch.setattr("numba.core.caching.IndexDataCacheFile.save", full)
        monkeypatch.setattr("numba.core.caching.FunctionCache.load_overload", lambda *arguments: None)
        kernel = compiled.kernel(_twice)
        with pytest.warns(RuntimeWarning, match="cannot be kept"):
            assert kernel(3) == 6

    @pytest.mark.skipif(sys.platform == "win32", reason="no such lock")
    @pytest.mark.parametrize("kind", ["link", "dangling", "pipe", "folder"])
    def test_the_lock_follows_nothing(self, tmp_path, kind):
        """In a shared folder somebody may have put something else in the place of the lock."""
        folder, treasure = tmp_path / "cache", tmp_path / "treasure"
        folder.mkdir()
        treasure.write_text("kept", encoding="utf-8")
        lock = folder / "ancf.lock"
        if kind == "pipe":
            os.mkfifo(lock)
        elif kind == "folder":
            lock.mkdir()
        else:
            lock.symlink_to(treasure if kind == "link" else tmp_path / "nowhere")
        with pytest.raises(OSError, match=r"."), kernel_cache.alone(str(folder)):
            pass
        assert treasure.read_text(encoding="utf-8") == "kept"
        assert not (tmp_path / "nowhere").exists()

    @pytest.mark.skipif(sys.platform == "win32", reason="no such lock")
    def test_the_lock_keeps_what_a_file_holds_and_is_not_waited_for_for_ever(self, tmp_path, monkeypatch):
        (tmp_path / "ancf.lock").write_text("kept", encoding="utf-8")
        monkeypatch.setattr(kernel_cache, "PATIENCE", 0.05)
        taken = kernel_cache.alone(str(tmp_path))
        with taken, pytest.raises(TimeoutError), kernel_cache.alone(str(tmp_path)):
            pass
        with kernel_cache.alone(str(tmp_path)):
            assert (tmp_path / "ancf.lock").read_text(encoding="utf-8") == "kept"

    def test_the_stamp_covers_all_kernels(self):
        """Every file that makes kernels, and what their code takes from other files, is in the stamp."""
        root, stamped = Path(compiled.__file__).parent, set(compiled.stamped())
        for path in root.rglob("*.py"):
            text = path.read_text(encoding="utf-8")
            makes = re.search(
                r"compiled import [^\n]*(kernel|formula|implements)|choices import|njit\(", text
            )
            assert not makes or path in stamped, path
        assert root / "bodies" / "inertia.py" in stamped

    def test_the_stamp_is_of_what_the_files_hold(self, tmp_path, monkeypatch):
        path = tmp_path / "part.py"
        monkeypatch.setattr(compiled, "stamped", lambda: [path])
        found = []
        for text in ("x = 1", "x = 2", "x = 1"):
            path.write_text(text, encoding="utf-8")
            found.append(compiled._package_stamp())
        assert found[0] == found[2] != found[1]


def _twice(x):
    return 2 * x


def _thrice(x):
    return 3 * x


class TestTimes:
    @pytest.mark.parametrize("output_step", [1e9, 1e19, 1e30, 1e308, 0.02])
    def test_output_step_beyond_the_run(self, output_step):
        result = ancf.simulate(hanging(), t_end=0.01, step=1e-3, output_step=output_step)
        assert result.t.tolist() == [0.0, 0.01]

    @pytest.mark.parametrize("step", [1e-3, 1 / 3, 2.5e-7, 7e-5])
    @pytest.mark.parametrize("count", [1, 3, 1000, 999_983])
    @pytest.mark.parametrize("off", [0.0, 3e-7, -3e-7, 1e-5, -1e-5, 0.3])
    def test_one_rule_for_steps_that_fit(self, step, count, off):
        """The model file and the function agree for small and large numbers of steps."""
        from ancf.model.settings import SimulationSettings, steps_between

        given = {"t_end": 2e6 * step, "step": step, "output_step": (count + off) * step}
        if abs(off) < 1e-6:
            assert steps_between("simulate", **given) == count
            SimulationSettings(**given)
            return
        with pytest.raises(ancf.ModelError, match="multiple of step"):
            steps_between("simulate", **given)
        with pytest.raises(ancf.ModelError, match="multiple of step"):
            SimulationSettings(**given)


class TestNumbers:
    @pytest.mark.parametrize("value", [np.array(["ggl", "index1"]), ["ggl"], {"ggl"}, 3, None])
    def test_formulation(self, value):
        for method in (ancf.Trapezoidal, ancf.GeneralizedAlpha):
            with pytest.raises(ancf.ModelError, match=r"formulation: is .*must be one of"):
                method(formulation=value)

    @pytest.mark.parametrize("EI", [1e80, 1e150, 1e200, 1e300])
    def test_stable_step_of_very_stiff_cables(self, EI):
        """It falls with the root of the bending stiffness, however large that is."""

        def model(EI):
            model = ancf.Model()
            section = ancf.Section(EA=1e3, EI=EI, rhoA=0.05)
            model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
            return model

        limit = ancf.stable_step(model(EI))
        assert limit == pytest.approx(ancf.stable_step(model(1e10)) * np.sqrt(1e10 / EI), rel=1e-2)
        with pytest.raises(ancf.ModelError, match="largest stable step"):
            ancf.simulate(model(EI), t_end=0.01, step=1e-3, integrator=ancf.Explicit())


class TestPaths:
    section = ancf.Section(EA=1e3, EI=1.0, rhoA=0.05)

    def length(self, points):
        beam = ancf.Model().add_beam("b", path=points, elements=4, section=self.section)
        return beam.length, float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    def test_back_to_the_start(self):
        length, chords = self.length([[0, 0, 0], [1, 1, 0], [1.05, 0, 0], [0, 0, 0]])
        assert chords < length < 1.5 * chords

    @pytest.mark.parametrize("count", [3, 4, 5, 8, 20])
    def test_any_points(self, count):
        """Through points without any order the curve stays about as long as their distances."""
        random = np.random.default_rng(count)
        for _ in range(5):
            length, chords = self.length(random.uniform(-1, 1, (count, 3)))
            assert chords < length < 3 * chords

    def test_points_of_a_circle(self):
        """Where there is a spline with its own arc length as parameter, it is found: order 4."""
        errors = []
        for count in (9, 17):
            u = np.linspace(0, 1.5 * np.pi, count)
            points = np.stack([np.cos(u), np.sin(u), 0 * u], axis=1)
            errors.append(abs(self.length(points)[0] - 1.5 * np.pi))
        assert errors[1] < errors[0] / 12 < 1e-3


class TestLines:
    def test_size_is_refused_before_it_takes_memory(self):
        from ancf import catenary

        section = {"EA": 15e6, "EI": 195.0, "mass": 1.35, "tension": 20e3}
        wire = catenary.Wire(**section)
        span = catenary.Span(length=60.0, droppers=(5.0, 30.0, 55.0))
        given = {
            "contact_wire": wire,
            "messenger_wire": wire,
            "droppers": catenary.Droppers(stiffness=1e5),
            "steady_arm": catenary.SteadyArm(vertical=300.0),
            "system_height": 1.2,
        }
        with pytest.raises(ancf.ModelError, match="10001 spans"):
            catenary.Line(spans=[span] * 10_001, **given)
        line = catenary.Line(spans=[span] * 2, **given)
        for mesh in (
            catenary.Mesh(contact=1e-9),
            catenary.Mesh(contact=1e-320),
            catenary.Mesh(messenger=1e-5),
        ):
            with pytest.raises(ancf.ModelError, match="elements of a wire"):
                catenary.form(line, mesh)
        for length in (1e3 + 1, 1e20, 1e308):
            with pytest.raises(ancf.ModelError, match="at most 1000 m"):
                catenary.Span(length=length, droppers=(5.0,))
