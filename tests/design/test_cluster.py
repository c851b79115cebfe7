"""Studies on a Dask cluster of processes: the same table, also when one of them is killed."""

import pytest

import ancf
from commands import python
from design_functions import product
from places import TESTS

CODE = """
import sys
sys.path.insert(0, sys.argv[1])
import functools, os, random, signal, threading, time, warnings
warnings.simplefilter("ignore")
import ancf
from distributed import LocalCluster
from design_functions import deadly, napping

def main():
    folder, way = sys.argv[2], sys.argv[3]
    b = [0.5] if way == "deadly" else [k / 8 for k in range(20)]
    rows = ancf.sample({"a": [1, 2, 3, 4, 5, 6], "b": b}, method="grid")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with LocalCluster(**options) as cluster:
        if way == "killed":
            def kill():
                time.sleep(1.0)
                victim = random.Random(1).choice([*cluster.workers.values()])
                os.kill(victim.pid, signal.SIGKILL)
            threading.Thread(target=kill, daemon=True).start()
        function = functools.partial(deadly, folder + "/marks", 99) if way == "deadly" else napping
        out = {"folder": folder + "/out", "scheduler": cluster.scheduler_address, "report": False}
        table = ancf.study(function, rows, **out)
    print(len(table), len(set(zip(table["a"], table["b"]))), (table["status"] == "ok").sum())
    print(table["message"][table["status"] == "failed"].unique().tolist())
    function = functools.partial(deadly, folder + "/marks", 99) if way == "deadly" else napping
    if way != "deadly":
        ancf.study(function, rows, folder=folder + "/here", workers=0, report=False)
        both = [open(folder + f"/{name}/table.csv", "rb").read() for name in ("out", "here")]
        print(both[0] == both[1])

if __name__ == "__main__":
    main()
"""


def on_cluster(tmp_path, way):
    (tmp_path / "marks").mkdir()
    script = tmp_path / "script.py"
    script.write_text(CODE, encoding="utf-8")
    ran = python(f"import runpy; runpy.run_path({str(script)!r}, run_name='__main__')", TESTS, tmp_path, way)
    assert ran.code == 0, ran.err
    return ran.out.splitlines()


@pytest.mark.parametrize("way", [pytest.param("whole", marks=pytest.mark.slow), "killed"])
def test_all_rows_and_none_twice(tmp_path, way):
    assert on_cluster(tmp_path, way) == ["120 120 120", "[]", "True"]


@pytest.mark.slow
def test_case_that_ends_every_process(tmp_path):
    """It fails, and those that were in its task do not."""
    count, messages = on_cluster(tmp_path, "deadly")
    assert count == "6 6 5"
    assert messages == "['the process that computed it ended: KilledWorker']"


def test_scheduler_that_does_not_answer(monkeypatch):
    monkeypatch.setattr("ancf.design.cluster.PATIENCE", 1.0)  # nobody listens there, however long one waits
    rows = ancf.sample({"a": [1.0], "b": [2.0]}, method="grid")
    with pytest.raises(ancf.ModelError, match=r"scheduler 'tcp://127.0.0.1:9': does not answer") as caught:
        ancf.study(product, rows, scheduler="tcp://127.0.0.1:9", report=False)
    assert "dask scheduler" in caught.value.hint


def test_workers_and_a_scheduler():
    rows = ancf.sample({"a": [1.0], "b": [2.0]}, method="grid")
    with pytest.raises(ancf.ModelError, match=r"study\.workers: has no effect with a scheduler"):
        ancf.study(product, rows, scheduler="tcp://127.0.0.1:9", workers=2)
