"""The option --slow, how tests are dealt out to workers, and fixtures that several files share."""

import os

import pytest

from commands import Ran


@pytest.fixture
def call(tmp_path, monkeypatch, capsys):
    """Run ``ancf ARGUMENTS`` in this process, in an empty folder."""
    from ancf.cli.app import app

    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ANCF_TRACEBACK", raising=False)

    def run(*arguments):
        with pytest.raises(SystemExit) as stop:
            app([str(argument) for argument in arguments], prog_name="ancf")
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return Ran(int(stop.value.code or 0), said.out, said.err)

    return run


@pytest.fixture
def fakes(monkeypatch):
    """Exhibits that take no time stand for those of the paper."""
    from fake_exhibits import install

    install(monkeypatch)


@pytest.fixture
def made(fakes, tmp_path):
    """What a verification of the fakes leaves."""
    from ancf.paper import verify

    return verify(["all"], tmp_path / "out", short=True)


@pytest.fixture
def undrawn(monkeypatch):
    """Reports of runs with empty figures, for tests of what they say: to draw them takes seconds."""
    from ancf.catenary.report import build
    from ancf.viz import style

    with style.new_figure(1.0, 1.0) as empty:
        pass
    monkeypatch.setattr(build, "picture", lambda name, content, save: save(empty))


@pytest.fixture(scope="module")
def browser():
    """A browser without a screen that the tests of a file share."""
    import browsing

    with browsing.started() as found:
        if found is None:
            pytest.skip("no Chromium or Chrome on this machine")
        yield found


@pytest.fixture(params=("index1", "index2", "ggl", "alpha"))
def method(request):
    """A way to keep joints, with Newton's method to round-off."""
    from helpers import METHODS

    return METHODS[request.param]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """The tests of a file share a worker, and so its fixtures; see dealing.py."""
    from dealing import ByFile

    return ByFile(config, log)


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="run all tests and all cases")
    parser.addoption("--whole", action="store_true", help="run all cases of all families")


def pytest_configure(config):
    os.environ["ANCF_FUZZ"] = "slow" if config.getoption("--slow") else ""  # see fuzzing.py
    if "PYTEST_XDIST_WORKER" in os.environ:  # all cores are busy: a process that helps to compile only costs
        os.environ["ANCF_HELPS"] = "1"


def pytest_collection_modifyitems(config, items):
    from dealing import other_cases

    if config.getoption("--slow"):
        return
    left_out = {item: "slow: run with --slow" for item in items if "slow" in item.keywords}
    if not config.getoption("--whole"):
        tried = [item for item in items if item not in left_out]
        left_out |= dict.fromkeys(other_cases(tried), "one of a family: run with --whole")
    for item, reason in left_out.items():
        item.add_marker(pytest.mark.skip(reason=reason))
