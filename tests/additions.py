"""A copy of the package in a scratch folder, to which a page of the documentation adds something."""

import json
import os
import shutil
import subprocess
import sys

from ancf import compiled
from commands import PATIENCE, Ran
from compiled_kernels import PACKAGE, take_kernels
from places import HOWTO, ROOT, TESTS


class Addition:
    """The package with the files of a page, and with text behind lines of files that are there.

    Parameters
    ----------
    folder : Path
    files : dict
        Files of ``docs/howto`` and their places in the package.
    lines : dict of dict
        Text by the line that it stands behind, by file.
    """

    def __init__(self, folder, files, lines):
        self.folder, self.root = folder, folder / "src" / "ancf"
        shutil.copytree(PACKAGE, self.root, ignore=shutil.ignore_patterns("__pycache__"))
        for name, place in files.items():
            assert not (self.root / place).exists()
            shutil.copy(HOWTO / name, self.root / place)
        for place, added in lines.items():
            text = (self.root / place).read_text(encoding="utf-8")
            for behind, line in added.items():
                assert text.count(behind) == 1, (place, behind)
                text = text.replace(behind, behind + line)
            (self.root / place).write_text(text, encoding="utf-8")

    def touched(self):
        """What differs from the package, file by file."""
        mine, theirs = ({p.relative_to(r) for p in _files(r)} for r in (self.root, PACKAGE))
        kept = {p for p in mine & theirs if (self.root / p).read_bytes() == (PACKAGE / p).read_bytes()}
        return sorted(path.as_posix() for path in (mine | theirs) - kept)

    def python(self, *arguments, interpreted=False):
        """Run Python with the copy, whose compiled kernels are beside its sources, in its folder."""
        paths = map(str, (self.folder / "src", ROOT, TESTS))
        env = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "MPLBACKEND": "Agg"}
        env.pop("NUMBA_CACHE_DIR", None)
        env["ANCF_MUTANTS"] = "interpreted" if interpreted else compiled._STAMP
        command = [sys.executable, *map(str, arguments)]
        ran = subprocess.run(
            command, env=env, cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE, check=False
        )
        return Ran(ran.returncode, ran.stdout, ran.stderr)

    def found(self, script, interpreted=False):
        """What a script prints as JSON in its last line; it runs in the folder of the copy."""
        if not interpreted:
            take_kernels(self.root)
        ran = self.python("-c", "import tests.mutants.plugin\n" + script, interpreted=interpreted)
        assert ran.code == 0, ran.err
        return json.loads(ran.out.splitlines()[-1])


def _files(root):
    return [path for path in root.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
