"""Symmetric matrices in 6x6 blocks with the patterns of chains, wires, trees and nets."""

import numpy as np


def chain(n):
    return np.array([(i, i + 1) for i in range(n - 1)])


def wires(n):
    """Two wires numbered one after the other, tied at every third node."""
    tied = [(i, n + i) for i in range(0, n, 3)]
    return np.concatenate([chain(n), chain(n) + n, tied])


def tree(n):
    return np.array([((i - 1) // 2, i) for i in range(1, n)])


def net(n):
    """Random sparse pattern in which everything is connected."""
    return np.concatenate([chain(n), np.random.default_rng(1).integers(0, n, (n, 2))])


PATTERNS = {"chain": (chain(9), 9), "wires": (wires(8), 16), "tree": (tree(15), 15), "net": (net(14), 14)}


def boolean(pairs, n):
    """Dense pattern with the diagonal."""
    B = np.eye(n, dtype=bool)
    B[pairs[:, 0], pairs[:, 1]] = B[pairs[:, 1], pairs[:, 0]] = True
    return B


def random_symmetric(pairs, n, seed=0):
    """Dense symmetric matrix with 6x6 blocks where the pattern has them."""
    A = np.random.default_rng(seed).standard_normal((6 * n, 6 * n))
    return (A + A.T) * np.kron(boolean(pairs, n), np.ones((6, 6)))


def definite(pairs, n):
    A = random_symmetric(pairs, n)
    return A + (1.0 - np.linalg.eigvalsh(A)[0]) * np.eye(6 * n)


def values(A, places):
    """Block values of a dense matrix."""
    k = np.arange(places.n)
    rows, cols = np.append(k, places.rows), np.append(k, places.column)
    return np.concatenate(
        [A[6 * i : 6 * i + 6, 6 * j : 6 * j + 6].ravel() for i, j in zip(rows, cols, strict=True)]
    )
