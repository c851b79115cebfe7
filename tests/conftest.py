"""The option --slow: without it, tests marked slow are left out. And commands that run in this process."""

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


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="run the tests marked slow too")


def pytest_collection_modifyitems(config, items):
    if config.getoption("--slow"):
        return
    skip = pytest.mark.skip(reason="slow: run with --slow")
    for item in items:
        if "slow" in item.keywords:
            item.add_marker(skip)
