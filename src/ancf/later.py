"""What is taken from scipy, imported when it is called: a short run of a cable needs none of it.

To import it takes as long as numba takes to load the kernels of a run.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

__all__ = [
    "LinearOperator",
    "SuperLU",
    "bmat",
    "cKDTree",
    "connected_components",
    "coo_array",
    "csc_array",
    "csc_matrix",
    "csr_array",
    "csr_matrix",
    "eig",
    "eigh",
    "eigh_tridiagonal",
    "eigsh",
    "eye_array",
    "gmres",
    "null_space",
    "qr",
    "reverse_cuthill_mckee",
    "splu",
    "svd",
]

if TYPE_CHECKING:
    from scipy.linalg import eig, eigh, eigh_tridiagonal, null_space, qr, svd
    from scipy.sparse import bmat, coo_array, csc_array, csc_matrix, csr_array, csr_matrix, eye_array
    from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee
    from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, gmres, splu
    from scipy.spatial import cKDTree
else:

    def _of(module: str, *names: str) -> list[Callable[..., Any]]:
        """Stand-ins that import the module when they are called."""
        return [_stand_in(module, name) for name in names]

    def _stand_in(module: str, name: str) -> Callable[..., Any]:
        def call(*arguments: Any, **keywords: Any) -> Any:
            return getattr(import_module(module), name)(*arguments, **keywords)

        return call

    eig, eigh, eigh_tridiagonal = _of("scipy.linalg", "eig", "eigh", "eigh_tridiagonal")
    null_space, qr, svd = _of("scipy.linalg", "null_space", "qr", "svd")
    bmat, coo_array, csc_array = _of("scipy.sparse", "bmat", "coo_array", "csc_array")
    csr_array, csr_matrix = _of("scipy.sparse", "csr_array", "csr_matrix")
    csc_matrix, eye_array = _of("scipy.sparse", "csc_matrix", "eye_array")
    connected_components, reverse_cuthill_mckee = _of(
        "scipy.sparse.csgraph", "connected_components", "reverse_cuthill_mckee"
    )
    LinearOperator, SuperLU, eigsh = _of("scipy.sparse.linalg", "LinearOperator", "SuperLU", "eigsh")
    gmres, splu = _of("scipy.sparse.linalg", "gmres", "splu")
    (cKDTree,) = _of("scipy.spatial", "cKDTree")
