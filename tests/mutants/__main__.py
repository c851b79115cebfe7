"""``python -m tests.mutants``: every mutant must be noticed by its tests."""

import argparse
import os
import sys
import time

from .listing import folders, read, without_mutants
from .runner import KILLED, SURVIVED, run_all


def main() -> int:
    """Run the mutants; exit code 1 when one survives or cannot be run, or a folder has none."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--short", action="store_true", help="the short set alone")
    parser.add_argument("--only", metavar="FOLDER", choices=folders(), help="one folder of src/ancf alone")
    parser.add_argument("--file", metavar="PART", help="files alone whose path holds this")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--anew", action="store_true", help="repeat what earlier runs found out")
    given = parser.parse_args()
    mutants = [
        m
        for m in read()
        if (m.short or not given.short)
        and given.only in (None, m.folder)
        and (given.file is None or given.file in m.file)
    ]
    if bare := without_mutants():
        print(f"no mutants of: {', '.join(bare)}")
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    start = time.perf_counter()

    def report(verdict) -> None:
        print(f"{verdict.outcome:9}{verdict.seconds:6.1f} s  {verdict.mutant}", flush=True)
        if verdict.outcome != KILLED:
            print(f"{'':18}{verdict.said or ' '.join(verdict.mutant.tests)}", flush=True)

    verdicts = run_all(mutants, given.workers, report, given.anew)
    if earlier := sum(not v.seconds for v in verdicts if v.outcome == KILLED):
        print(f"{earlier} of them noticed in earlier runs of the same sources and tests")
    bad = [v for v in verdicts if v.outcome != KILLED]
    survived = sum(v.outcome == SURVIVED for v in bad)
    took = time.perf_counter() - start
    print(f"{len(verdicts)} mutants, {survived} survived, {len(bad) - survived} errors, {took:.0f} s")
    for verdict in bad:
        print(f"  {verdict.outcome}: {verdict.mutant}")
    return bool(bad or bare)


if __name__ == "__main__":
    sys.exit(main())
