"""Signed distance from closed triangulated meshes, by a tree of boxes that is built once.

The nearest place of a mesh lies in a face, on an edge or at a vertex. The sign is that of the
pseudonormal there, the mean of the faces' normals by their angles (Baerentzen and Aanaes, IEEE Trans.
Vis. Comput. Graph. 11 (2005) 243), the direction that away from the nearest place: outside, edges and
vertices are round, so that normals turn continuously under a beam that has a radius.

The tree is in depth-first order: a box that is farther than what was found is skipped with all in it.
One looks first at the triangle that was nearest the last time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import inline_kernel, kernel
from ..model.surfaces.mesh import Mesh
from ..model.surfaces.shape import Shape
from ..vectors import cross, dot
from .profiles import NUMBER
from .profiles import distances as distances_of_profile

#: Number of meshes among the shapes.
MESH = NUMBER["mesh"]
#: Columns of ``tree``: low and high corner, the row behind all inside, and the triangle of a leaf, else -1.
LOW, HIGH, SKIP, LEAF = 0, 3, 6, 7
#: Columns of ``faces``: three corners, the normals of the face, the three edges and the three vertices.
CORNERS, FACE, EDGES, VERTICES = 0, 9, 12, 21
#: Of the size of a triangle: what is as near is on the surface.
ON = 1e-9
#: A triangle's features: inside, edges from corner k to the next, corners.
INSIDE, EDGE, VERTEX = 0, 1, 4


@inline_kernel
def corner(face, k):
    """Three numbers of a row from column k on."""
    return face[k], face[k + 1], face[k + 2]


@inline_kernel
def less(a, b):
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inline_kernel
def on_triangle(face, p):
    """Nearest place of a triangle and the feature that it lies on.

    By the regions of its corners, its edges and its inside: Ericson, Real-Time Collision Detection, 5.1.5.
    """
    a, b, c = corner(face, 0), corner(face, 3), corner(face, 6)
    ab, ac, ap = less(b, a), less(c, a), less(p, a)
    d1, d2 = dot(ab, ap), dot(ac, ap)
    if d1 <= 0.0 and d2 <= 0.0:
        return a, VERTEX
    bp = less(p, b)
    d3, d4 = dot(ab, bp), dot(ac, bp)
    if d3 >= 0.0 and d4 <= d3:
        return b, VERTEX + 1
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        t = d1 / (d1 - d3)
        return (a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]), EDGE
    cp = less(p, c)
    d5, d6 = dot(ab, cp), dot(ac, cp)
    if d6 >= 0.0 and d5 <= d6:
        return c, VERTEX + 2
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        t = d2 / (d2 - d6)
        return (a[0] + t * ac[0], a[1] + t * ac[1], a[2] + t * ac[2]), EDGE + 2
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        t = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return (b[0] + t * (c[0] - b[0]), b[1] + t * (c[1] - b[1]), b[2] + t * (c[2] - b[2])), EDGE + 1
    s = 1.0 / (va + vb + vc)
    u, w = vb * s, vc * s
    return (
        a[0] + u * ab[0] + w * ac[0],
        a[1] + u * ab[1] + w * ac[1],
        a[2] + u * ab[2] + w * ac[2],
    ), INSIDE


@inline_kernel
def to_box(box, p):
    """Square of the distance of a place from a box."""
    x = max(box[LOW] - p[0], 0.0, p[0] - box[HIGH])
    y = max(box[LOW + 1] - p[1], 0.0, p[1] - box[HIGH + 1])
    z = max(box[LOW + 2] - p[2], 0.0, p[2] - box[HIGH + 2])
    return x * x + y * y + z * z


@inline_kernel
def nearest_face(tree, faces, root, hint, p):
    """Signed distance, normal, a direction along the surface, curvatures across and along it, the triangle.

    ``root`` is the first row of the mesh in the tree, ``hint`` a triangle of it.
    """
    place, feature = on_triangle(faces[hint], p)
    gap = less(p, place)
    best, nearest = dot(gap, gap), hint
    row = int(root)
    end = int(tree[row, SKIP])
    while row < end:
        box = tree[row]
        if to_box(box, p) >= best:
            row = int(box[SKIP])
            continue
        leaf = int(box[LEAF])
        if leaf >= 0:
            found, kind = on_triangle(faces[leaf], p)
            gap = less(p, found)
            square = dot(gap, gap)
            if square < best:
                best, nearest, place, feature = square, leaf, found, kind
        row += 1
    return *beside(faces[nearest], place, feature, p, math.sqrt(best)), nearest


@inline_kernel
def beside(face, place, feature, p, size):
    """Of a place and the nearest one of a triangle: signed distance, normal, direction, curvatures."""
    if feature == INSIDE:
        normal = corner(face, FACE)
    elif feature < VERTEX:
        normal = corner(face, EDGES + 3 * (feature - EDGE))
    else:
        normal = corner(face, VERTICES + 3 * (feature - VERTEX))
    gap = less(p, place)
    sign = 1.0 if dot(gap, normal) >= 0.0 else -1.0
    first = corner(face, CORNERS)
    ab = less(corner(face, CORNERS + 3), first)
    if feature == INSIDE or size * size <= ON * ON * dot(ab, ab):
        return sign * size, normal, ZERO, 0.0, 0.0
    s = sign / size
    n = gap[0] * s, gap[1] * s, gap[2] * s
    if feature < VERTEX:
        k = feature - EDGE
        one = corner(face, CORNERS + 3 * k)
        two = corner(face, CORNERS + 3 * (0 if k == 2 else k + 1))
        along = less(two, one)
        length = 1.0 / math.sqrt(dot(along, along))
        return sign * size, n, (along[0] * length, along[1] * length, along[2] * length), s, 0.0
    across = cross(n, (1.0, 0.0, 0.0)) if abs(n[0]) < 0.7 else cross(n, (0.0, 1.0, 0.0))
    length = 1.0 / math.sqrt(dot(across, across))
    return sign * size, n, (across[0] * length, across[1] * length, across[2] * length), s, s


ZERO = (0.0, 0.0, 0.0)


@kernel
def distances_from(tree, faces, places, out):
    """Signed distances of places (n, 3) from the mesh of a tree, m."""
    hint = 0
    for k in range(places.shape[0]):
        p = places[k, 0], places[k, 1], places[k, 2]
        out[k], _, _, _, _, hint = nearest_face(tree, faces, 0.0, hint, p)


def distances(shape: Shape, places: FloatArray) -> FloatArray:
    """Signed distances of places (n, 3), in the axes in which a shape is given, from its surface, m."""
    if not isinstance(shape, Mesh):
        return distances_of_profile(shape, places)
    tree, faces, _ = trees([shape])
    out = np.empty(len(places))
    distances_from(tree, faces, np.ascontiguousarray(places - shape.place), out)
    return out


def trees(shapes: Sequence[Shape]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Trees and triangles of all meshes, one after the other, and each shape's first row, -1 of others."""
    tree, faces, first = [np.zeros((0, 8))], [np.zeros((0, 30))], np.full(len(shapes), -1.0)
    rows = count = 0
    for k, shape in enumerate(shapes):
        if isinstance(shape, Mesh):
            own = _tree(shape.corners)
            own[:, SKIP] += rows
            own[own[:, LEAF] >= 0, LEAF] += count
            first[k], rows, count = rows, rows + len(own), count + len(shape.corners)
            tree.append(own)
            faces.append(_faces(shape))
    return np.concatenate(tree), np.concatenate(faces), first


def _tree(corners: FloatArray) -> FloatArray:
    """Boxes about halves of halves of the triangles (t, 3, 3), (2 t - 1, 8), in depth-first order."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    middle = corners.mean(axis=1)
    tree = np.zeros((2 * len(corners) - 1, 8))
    waiting: list[tuple[int, IntArray]] = [(0, np.arange(len(corners)))]
    while waiting:
        row, mine = waiting.pop()
        tree[row, LOW : LOW + 3], tree[row, HIGH : HIGH + 3] = low[mine].min(axis=0), high[mine].max(axis=0)
        tree[row, SKIP], tree[row, LEAF] = row + 2 * len(mine) - 1, mine[0] if len(mine) == 1 else -1
        if len(mine) > 1:
            longest = int(np.argmax(np.ptp(middle[mine], axis=0)))
            half = len(mine) // 2
            parted = mine[np.argpartition(middle[mine, longest], half)]
            waiting += [(row + 1, parted[:half]), (row + 2 * half, parted[half:])]
    return tree


def _faces(shape: Mesh) -> FloatArray:
    """Rows of ``faces``: corners and pseudonormals."""
    corners, triangles = shape.corners, shape.triangles
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    ways = np.roll(corners, -1, axis=1) - corners
    ways /= np.linalg.norm(ways, axis=2, keepdims=True)
    angle = np.arccos(np.clip(-np.sum(ways * np.roll(ways, 1, axis=1), axis=2), -1.0, 1.0))
    at_vertex = np.zeros((len(shape.points), 3))
    np.add.at(at_vertex, triangles.ravel(), (angle[:, :, None] * normal[:, None]).reshape(-1, 3))
    of_edge: dict[tuple[int, int], Any] = {}
    for t, row in enumerate(triangles.tolist()):
        for k in range(3):
            of_edge[row[k], row[(k + 1) % 3]] = normal[t]
    at_edge = np.array(
        [
            [of_edge[row[k], row[(k + 1) % 3]] + of_edge[row[(k + 1) % 3], row[k]] for k in range(3)]
            for row in triangles.tolist()
        ]
    )
    parts = corners, normal, at_edge, at_vertex[triangles]
    return np.concatenate([part.reshape(len(corners), -1) for part in parts], axis=1)
