"""Rotations as matrices, quaternions and angles: the functions of `tf_transformations` that students use.

Quaternions have shape (4,) and the order x, y, z, w; matrices are homogeneous and have shape (4, 4); angles are in rad.
`axes` is the convention of Euler angles: the axes in the order of the rotations, about a static frame (`s…`) or about
a frame that rotates along (`r…`). The default `sxyz` is roll, pitch, yaw. Functions that take a matrix raise ValueError
for another shape than (4, 4) or (3, 3), those with `axes` for an unknown convention.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = [
    "compose_matrix",
    "concatenate_matrices",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "rotation_from_matrix",
    "rotation_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]

Array: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = Sequence[float] | Array

_AXES = {letter: number for number, letter in enumerate("xyz")}
_EPSILON = 4.0 * np.finfo(float).eps


def identity_matrix() -> Array:
    """The identity matrix, shape (4, 4)."""
    return np.identity(4)


def translation_matrix(direction: Numbers) -> Array:
    """The matrix of a translation x, y, z, shape (4, 4)."""
    matrix = np.identity(4)
    matrix[:3, 3] = direction[:3]
    return matrix


def translation_from_matrix(matrix: npt.ArrayLike) -> Array:
    """The translation x, y, z of a matrix, shape (3,)."""
    return _matrix(matrix)[:3, 3].copy()


def rotation_matrix(angle: float, direction: Numbers, point: Numbers | None = None) -> Array:
    """The matrix of a rotation about an axis through the origin or a point."""
    matrix = quaternion_matrix(quaternion_about_axis(angle, direction))
    if point is not None:
        place = np.array(point[:3], dtype=float)
        matrix[:3, 3] = place - matrix[:3, :3] @ place
    return matrix


def rotation_from_matrix(matrix: npt.ArrayLike) -> tuple[float, Array, Array]:
    """Angle, direction (shape (3,)) and a point (shape (4,), homogeneous) of the axis of a rotation matrix."""
    whole = _matrix(matrix)
    x, y, z, w = quaternion_from_matrix(whole)
    length = math.sqrt(x * x + y * y + z * z)
    angle = 2.0 * math.atan2(length, w)
    direction = np.array([x, y, z]) / length if length > _EPSILON else np.array([0.0, 0.0, 1.0])
    shift = whole[:3, 3]
    # A point p of the axis satisfies (I - R) p = t. I - R is singular along the axis; adding the projection on the
    # axis makes it regular and selects the point nearest to the origin.
    along = np.identity(3) - whole[:3, :3] + np.outer(direction, direction)
    point = (
        np.append(np.linalg.solve(along, shift - direction * (direction @ shift)), 1.0)
        if length > _EPSILON
        else (np.array([0.0, 0.0, 0.0, 1.0]))
    )
    return angle, direction, point


def concatenate_matrices(*matrices: npt.ArrayLike) -> Array:
    """The product of matrices: the last one is applied first."""
    product = np.identity(4)
    for matrix in matrices:
        product = product @ _matrix(matrix)
    return product


def inverse_matrix(matrix: npt.ArrayLike) -> Array:
    """The inverse of a square matrix."""
    return np.linalg.inv(np.asarray(matrix, dtype=float))


def compose_matrix(
    scale: Numbers | None = None,
    shear: Numbers | None = None,
    angles: Numbers | None = None,
    translate: Numbers | None = None,
    perspective: Numbers | None = None,
) -> Array:
    """The matrix that scales, shears (xy, xz, yz), rotates by roll, pitch, yaw and translates, in this order."""
    matrix = np.identity(4)
    if perspective is not None:
        matrix[3, :] = perspective[:4]
    if translate is not None:
        matrix = matrix @ translation_matrix(translate)
    if angles is not None:
        matrix = matrix @ euler_matrix(*angles[:3])
    if shear is not None:
        sheared = np.identity(4)
        sheared[0, 1], sheared[0, 2], sheared[1, 2] = shear[:3]
        matrix = matrix @ sheared
    if scale is not None:
        matrix = matrix @ np.diag([*scale[:3], 1.0])
    scaled: Array = matrix / matrix[3, 3]
    return scaled


def is_same_transform(matrix0: npt.ArrayLike, matrix1: npt.ArrayLike) -> bool:
    """Whether two matrices are the same transform, within rounding."""
    one, other = _matrix(matrix0), _matrix(matrix1)
    return bool(np.allclose(one / one[3, 3], other / other[3, 3]))


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """The matrix of three Euler angles."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: npt.ArrayLike, axes: str = "sxyz") -> tuple[float, float, float]:
    """The Euler angles of a matrix. If the axes are aligned (gimbal lock), the last angle is 0."""
    is_rotating, (i, j, k) = _order(axes)
    m = _matrix(matrix)[:3, :3]
    if i == k:
        rest = 3 - i - j
        sign = _parity(i, j, rest)
        sine = math.hypot(m[i, j], m[i, rest])
        middle = math.atan2(sine, m[i, i])
        if sine > _EPSILON:
            first, last = math.atan2(m[i, j], sign * m[i, rest]), math.atan2(m[j, i], -sign * m[rest, i])
        else:
            first, last = math.atan2(-sign * m[j, rest], m[j, j]), 0.0
    else:
        sign = _parity(i, j, k)
        cosine = math.hypot(m[i, i], m[j, i])
        middle = math.atan2(-sign * m[k, i], cosine)
        if cosine > _EPSILON:
            first, last = math.atan2(sign * m[k, j], m[k, k]), math.atan2(sign * m[j, i], m[i, i])
        else:
            first, last = math.atan2(-sign * m[j, k], m[j, j]), 0.0
    return (last, middle, first) if is_rotating else (first, middle, last)


def euler_from_quaternion(quaternion: Numbers, axes: str = "sxyz") -> tuple[float, float, float]:
    """The Euler angles of a quaternion: roll, pitch, yaw by default."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """The quaternion of Euler angles: roll, pitch, yaw by default."""
    is_rotating, order = _order(axes)
    angles = (ak, aj, ai) if is_rotating else (ai, aj, ak)
    found = np.array([0.0, 0.0, 0.0, 1.0])
    for axis, angle in zip(order, angles, strict=True):
        found = quaternion_multiply(quaternion_about_axis(angle, np.identity(3)[axis]), found)
    return found


def quaternion_about_axis(angle: float, axis: Numbers) -> Array:
    """The quaternion of a rotation about an axis of any length."""
    direction = unit_vector(axis[:3])
    return np.append(direction * math.sin(angle / 2.0), math.cos(angle / 2.0))


def quaternion_matrix(quaternion: Numbers) -> Array:
    """The matrix of a quaternion of any norm; the identity for norm 0."""
    x, y, z, w = (float(part) for part in quaternion[:4])
    squared = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if squared < _EPSILON:
        return matrix
    s = 2.0 / squared
    matrix[:3, :3] = [
        [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
    ]
    return matrix


def quaternion_from_matrix(matrix: npt.ArrayLike) -> Array:
    """The unit quaternion of a matrix, with w >= 0.

    Each product of two of its parts follows from the matrix. The row of products with the largest part, divided by that
    part, is the quaternion; the largest one is used because the division by a small number amplifies rounding errors.
    """
    m = _matrix(matrix)[:3, :3]
    squares = np.array([
        1.0 + m[0, 0] - m[1, 1] - m[2, 2],
        1.0 - m[0, 0] + m[1, 1] - m[2, 2],
        1.0 - m[0, 0] - m[1, 1] + m[2, 2],
        1.0 + m[0, 0] + m[1, 1] + m[2, 2],
    ])  # fmt: skip
    largest = int(np.argmax(squares))  # of 4 x², 4 y², 4 z², 4 w²
    products = np.empty((4, 4))
    for one, other in ((0, 1), (0, 2), (1, 2)):
        rest = 3 - one - other
        products[one, other] = products[other, one] = m[one, other] + m[other, one]
        products[rest, 3] = products[3, rest] = (m[other, one] - m[one, other]) * _parity(one, other, rest)
    products[range(4), range(4)] = squares
    found: Array = products[largest]
    found = found / np.linalg.norm(found)
    return -found if found[3] < 0.0 else found


def quaternion_multiply(quaternion1: Numbers, quaternion0: Numbers) -> Array:
    """The product of two quaternions: the rotation `quaternion0` is applied first."""
    x, y, z, w = quaternion1[:4]
    a, b, c, d = quaternion0[:4]
    return np.array([
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    ])  # fmt: skip


def quaternion_conjugate(quaternion: Numbers) -> Array:
    """The conjugate of a quaternion: x, y, z are negated."""
    return np.array(quaternion[:4], dtype=float) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: Numbers) -> Array:
    """The inverse of a quaternion of any norm except 0."""
    conjugate = quaternion_conjugate(quaternion)
    inverse: Array = conjugate / (conjugate @ conjugate)
    return inverse


def quaternion_slerp(
    quat0: Numbers, quat1: Numbers, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Array:
    """Interpolate between two quaternions by a fraction in 0…1 (slerp), with `spin` additional half turns.

    With `shortestpath`, `quat1` is negated if that makes the arc shorter.
    """
    one: Array = unit_vector(quat0[:4])
    other: Array = unit_vector(quat1[:4])
    if fraction == 0.0:
        return one
    if fraction == 1.0:
        return other
    cosine = float(one @ other)
    if abs(abs(cosine) - 1.0) < _EPSILON:
        return one
    if shortestpath and cosine < 0.0:
        cosine, other = -cosine, -other
    angle = math.acos(max(-1.0, min(1.0, cosine))) + spin * math.pi
    if abs(angle) < _EPSILON:
        return one
    start, end = math.sin((1.0 - fraction) * angle), math.sin(fraction * angle)
    found: Array = (one * start + other * end) / math.sin(angle)
    return found


def random_quaternion(rand: Numbers | None = None) -> Array:
    """A random rotation, uniformly distributed, from three uniform random numbers in 0…1."""
    first, second, third = np.random.rand(3) if rand is None else rand[:3]
    inner, outer = math.sqrt(1.0 - first), math.sqrt(first)
    one, other = 2.0 * math.pi * second, 2.0 * math.pi * third
    return np.array([math.sin(one) * inner, math.cos(one) * inner, math.sin(other) * outer, math.cos(other) * outer])


def vector_norm(data: npt.ArrayLike, axis: int | None = None, out: Any = None) -> Any:
    """The norm of a vector, or of the vectors along an axis; with `out` stored there."""
    norm = np.linalg.norm(np.asarray(data, dtype=float), axis=axis)
    if out is None:
        return norm
    out[...] = norm
    return None


def unit_vector(data: npt.ArrayLike, axis: int | None = None, out: Any = None) -> Any:
    """A vector of length 1 in the same direction, or each vector along an axis; with `out` stored there."""
    found = np.array(data, dtype=float)
    norm = np.linalg.norm(found) if axis is None or found.ndim == 1 else np.linalg.norm(found, axis=axis, keepdims=True)
    if out is None:
        return found / norm
    out[...] = found / norm
    return None


def _matrix(matrix: npt.ArrayLike) -> Array:
    """Convert to shape (4, 4); a matrix of shape (3, 3) is a rotation. Raises ValueError for another shape."""
    found = np.asarray(matrix, dtype=float)
    if found.shape == (3, 3):
        whole = np.identity(4)
        whole[:3, :3] = found
        return whole
    if found.shape != (4, 4):
        raise ValueError(f"found a matrix of shape {found.shape}, expected (4, 4) or (3, 3)")
    return found


def _order(axes: str) -> tuple[bool, tuple[int, int, int]]:
    """Whether the frame rotates along, and the numbers of the axes in the order of the equivalent static rotations.

    Raises ValueError for an unknown convention.
    """
    letters = [_AXES.get(letter, -1) for letter in axes[1:]]
    if axes[:1] not in ("s", "r") or len(letters) != 3 or -1 in letters or letters[1] in (letters[0], letters[2]):
        raise ValueError(f"found axes {axes!r}, expected s or r and three of xyz, such as 'sxyz' or 'rzyx'")
    i, j, k = letters
    return (True, (k, j, i)) if axes[0] == "r" else (False, (i, j, k))


def _parity(i: int, j: int, k: int) -> float:
    """1 for axes in cyclic order x, y, z, otherwise -1."""
    return 1.0 if (j - i) % 3 == 1 and (k - j) % 3 == 1 else -1.0
