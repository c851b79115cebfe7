"""What has been compiled of the package, for copies whose kernels are the same; kernels of the tests."""

import importlib
import shutil
from pathlib import Path

from numba.core.dispatcher import Dispatcher

import ancf
from ancf import compiled
from ancf.batches import strain_energies
from ancf.parts import Part

PACKAGE = Path(ancf.__file__).parent


def take_kernels(copy):
    """Put the compiled kernels of the package beside the sources of a copy, at the path ``copy``."""
    for path in compiled.stamped():
        place = path.relative_to(PACKAGE)
        module = importlib.import_module(".".join(("ancf", *place.with_suffix("").parts)))
        kernels = [x for x in vars(module).values() if isinstance(x, Dispatcher | Part)]
        for cache in {k.stats.cache_path for k in kernels if k.__module__ == module.__name__} - {None}:
            kept = (copy / place).parent / "__pycache__"
            kept.mkdir(exist_ok=True)
            for file in Path(cache).glob("*.nb?"):
                shutil.copy(file, kept)


@compiled.kernel
def total_strain_energy(batches, ws, q):
    """Strain energy of all batches, J."""
    return strain_energies(batches, q, ws)
