"""The lists of changes, one TOML file per folder of the package."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PACKAGE = ROOT / "src" / "ancf"
#: How a file says that it holds kernels.
_KERNELS = ("@kernel", "@separate_kernel", "@inline_kernel", "@formula")


@dataclass(frozen=True)
class Mutant:
    """A change of one line of a file and tests that must notice it.

    Attributes
    ----------
    file : str
        Below the folder of the package.
    old, new : str
        Text that occurs once in the file, and what it is replaced by.
    tests : tuple of str
        Test ids below ``tests/``; at least one of them must fail.
    short : bool
        It is one of the few that run with every push.
    compiled : bool
        Compile anew: the tests are too long for kernels that Python interprets, or the change is in how
        kernels are compiled.
    interpreted : bool
        Interpret the kernels although the change is not in one: the tests are so small that this is quicker
        than to compile for the first time.
    """

    file: str
    old: str
    new: str
    tests: tuple[str, ...]
    short: bool = False
    compiled: bool = False
    interpreted: bool = False

    @property
    def folder(self) -> str:
        """First part of the file's path, "." for modules of the package itself."""
        return self.file.split("/")[0] if "/" in self.file else "."

    @property
    def in_kernel(self) -> bool:
        """Whether the file holds kernels."""
        text = (PACKAGE / self.file).read_text(encoding="utf-8")
        return any(mark in text for mark in _KERNELS)

    @property
    def interprets(self) -> bool:
        """Whether the tests run with interpreted kernels."""
        return self.interpreted or (self.in_kernel and not self.compiled)

    @property
    def compiles(self) -> bool:
        """Whether what was compiled before the change does not serve."""
        return self.compiled or self.in_kernel

    def changed(self) -> str:
        """Text of the changed file.

        Raises
        ------
        ValueError
            The old text does not occur exactly once, or the file has gone.
        """
        try:
            text = (PACKAGE / self.file).read_text(encoding="utf-8")
        except FileNotFoundError:
            raise ValueError("there is no such file") from None
        if text.count(self.old) != 1:
            raise ValueError(f"the old text occurs {text.count(self.old)} times")
        return text.replace(self.old, self.new)

    def __str__(self) -> str:
        return f"{self.file}: {' '.join(self.old.split())[:50]} -> {' '.join(self.new.split())[:50]}"


def read() -> list[Mutant]:
    """All mutants in the order of the files."""
    found = []
    for path in sorted((HERE / "lists").glob("*.toml")):
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        entries = content.pop("mutant")
        if content:  # it would never run
            raise ValueError(f"{path.name}: unknown {', '.join(content)}: each mutant is a [[mutant]]")
        found += [Mutant(**{**entry, "tests": tuple(entry["tests"])}) for entry in entries]
    return found


def folders() -> list[str]:
    """Folders of the package that hold modules, and "." for the package itself."""
    return [".", *sorted(p.name for p in PACKAGE.iterdir() if p.is_dir() and any(p.glob("*.py")))]


def without_mutants() -> list[str]:
    """Folders that no mutant changes."""
    changed = {mutant.folder for mutant in read()}
    return [folder for folder in folders() if folder not in changed]
