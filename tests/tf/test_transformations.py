"""Rotations: known answers of the functions of tf_transformations, and that they agree with each other."""

from __future__ import annotations

import inspect
import itertools
import math

import numpy as np
import pytest

from thymio_sim_ros import tf
from thymio_sim_ros.tf import transformations as tr

HALF = math.sqrt(0.5)
ORDERS = ["".join(order) for order in itertools.product("xyz", repeat=3) if order[0] != order[1] != order[2]]
AXES = [kind + order for kind in "sr" for order in ORDERS]
BASIC = {
    "x": lambda a: [[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]],
    "y": lambda a: [[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]],
    "z": lambda a: [[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]],
}


def same(one, other):
    return np.allclose(one, other) or np.allclose(one, -np.asarray(other))


@pytest.mark.parametrize(
    ("angles", "quaternion"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
        ((0.0, 0.0, math.pi / 2), (0.0, 0.0, HALF, HALF)),
        ((math.pi / 2, 0.0, 0.0), (HALF, 0.0, 0.0, HALF)),
        ((0.0, math.pi / 2, 0.0), (0.0, HALF, 0.0, HALF)),
        ((math.pi / 2, math.pi / 2, 0.0), (0.5, 0.5, -0.5, 0.5)),
    ],
)
def test_roll_pitch_yaw_and_x_y_z_w(angles, quaternion):
    assert tr.quaternion_from_euler(*angles) == pytest.approx(quaternion)
    assert same(tr.quaternion_from_euler(*tr.euler_from_quaternion(quaternion)), quaternion)


def test_there_are_24_conventions_of_euler_angles():
    assert len(set(AXES)) == 24


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("angles", [(0.3, 0.7, -1.1), (-2.0, 0.4, 3.0), (0.0, 0.0, 0.0), (1.0, 1.2, 0.0)])
def test_angles_are_consecutive_rotations_about_axes(axes, angles):
    turns = [np.array(BASIC[letter](angle)) for letter, angle in zip(axes[1:], angles, strict=True)]
    if axes[0] == "s":
        turns.reverse()
    wanted = turns[0] @ turns[1] @ turns[2]
    assert np.allclose(tr.euler_matrix(*angles, axes)[:3, :3], wanted)
    assert np.allclose(tr.quaternion_matrix(tr.quaternion_from_euler(*angles, axes))[:3, :3], wanted)
    back = tr.euler_from_matrix(wanted, axes)
    assert np.allclose(tr.euler_matrix(*back, axes)[:3, :3], wanted)


@pytest.mark.parametrize("axes", AXES)
def test_angles_survive_the_conversion_to_a_matrix_and_back(axes):
    angles = (0.3, 0.7, -1.1)
    assert tr.euler_from_quaternion(tr.quaternion_from_euler(*angles, axes), axes) == pytest.approx(angles)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("middle", [0.0, math.pi / 2, -math.pi / 2, math.pi])
def test_in_gimbal_lock_the_rotation_survives_the_conversion(axes, middle):
    matrix = tr.euler_matrix(0.4, middle, 0.9, axes)
    assert np.allclose(tr.euler_matrix(*tr.euler_from_matrix(matrix, axes), axes), matrix, atol=1e-7)


@pytest.mark.parametrize("axes", ["", "xyz", "sxxy", "sxyw", "qxyz", "sxy"])
def test_invalid_axes(axes):
    with pytest.raises(ValueError, match="expected s or r and three of xyz"):
        tr.quaternion_from_euler(0.0, 0.0, 0.0, axes)


def test_a_product_applies_the_second_rotation_first():
    yaw, pitch = tr.quaternion_from_euler(0, 0, 0.5), tr.quaternion_from_euler(0, 0.3, 0)
    both = tr.quaternion_multiply(yaw, pitch)
    assert np.allclose(tr.quaternion_matrix(both), tr.quaternion_matrix(yaw) @ tr.quaternion_matrix(pitch))


def test_i_j_and_k():
    i, j, k = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0)
    assert tr.quaternion_multiply(i, j) == pytest.approx(k)
    assert tr.quaternion_multiply(j, i) == pytest.approx((0, 0, -1, 0))
    assert tr.quaternion_multiply(i, i) == pytest.approx((0, 0, 0, -1))


def test_an_inverse_undoes_a_quaternion_of_any_length():
    quaternion = (0.2, -0.4, 1.0, 2.0)
    assert tr.quaternion_multiply(quaternion, tr.quaternion_inverse(quaternion)) == pytest.approx((0, 0, 0, 1))
    assert tr.quaternion_conjugate(quaternion) == pytest.approx((-0.2, 0.4, -1.0, 2.0))


@pytest.mark.parametrize("seed", range(40))
def test_a_matrix_and_its_quaternion(seed):
    quaternion = tr.random_quaternion(np.random.default_rng(seed).random(3))
    assert np.linalg.norm(quaternion) == pytest.approx(1.0)
    matrix = tr.quaternion_matrix(quaternion)
    assert np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.identity(3))
    assert same(tr.quaternion_from_matrix(matrix), quaternion)
    angle, direction, point = tr.rotation_from_matrix(matrix)
    assert np.allclose(tr.rotation_matrix(angle, direction, point), matrix)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -2, 3)])
@pytest.mark.parametrize("angle", [0.0, 0.1, 1.0, math.pi, -2.0])
def test_a_rotation_about_an_axis(axis, angle):
    assert same(tr.quaternion_from_matrix(tr.rotation_matrix(angle, axis)), tr.quaternion_about_axis(angle, axis))
    assert np.allclose(tr.rotation_matrix(angle, axis)[:3, :3] @ np.array(axis, dtype=float), axis)


def test_a_rotation_about_an_axis_through_a_point():
    matrix = tr.rotation_matrix(math.pi / 2, (0, 0, 1), (1, 0, 0))
    assert matrix @ (1, 0, 0, 1) == pytest.approx((1, 0, 0, 1))
    assert matrix @ (2, 0, 0, 1) == pytest.approx((1, 1, 0, 1))
    angle, direction, point = tr.rotation_from_matrix(matrix)
    assert np.allclose(tr.rotation_matrix(angle, direction, point), matrix)


def test_translations_and_products():
    there, yaw = tr.translation_matrix((1, 2, 3)), tr.quaternion_matrix((0, 0, HALF, HALF))
    assert tr.translation_from_matrix(there) == pytest.approx((1, 2, 3))
    assert tr.concatenate_matrices(there, yaw) @ (1, 0, 0, 1) == pytest.approx((1, 3, 3, 1))
    assert np.allclose(tr.concatenate_matrices(), tr.identity_matrix())
    assert tr.is_same_transform(tr.concatenate_matrices(there, tr.inverse_matrix(there)), tr.identity_matrix())
    assert not tr.is_same_transform(there, yaw)
    composed = tr.compose_matrix(angles=(0, 0, math.pi / 2), translate=(1, 2, 3), scale=(2, 2, 2))
    assert composed @ (1, 0, 0, 1) == pytest.approx((1, 4, 3, 1))


@pytest.mark.parametrize(("fraction", "yaw"), [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (1.0, 2.0)])
def test_interpolation_by_a_fraction(fraction, yaw):
    found = tr.quaternion_slerp(tr.quaternion_from_euler(0, 0, 0), tr.quaternion_from_euler(0, 0, 2.0), fraction)
    assert tr.euler_from_quaternion(found)[2] == pytest.approx(yaw)


def test_the_shorter_arc_is_used_by_default():
    one, other = tr.quaternion_from_euler(0, 0, 0), -tr.quaternion_from_euler(0, 0, 1.0)
    assert tr.euler_from_quaternion(tr.quaternion_slerp(one, other, 0.5))[2] == pytest.approx(0.5)
    longer = tr.euler_from_quaternion(tr.quaternion_slerp(one, other, 0.5, shortestpath=False))[2]
    assert abs(longer) == pytest.approx(math.pi - 0.5)


def test_lengths():
    assert tr.vector_norm((3, 4)) == pytest.approx(5.0)
    assert tr.unit_vector((3, 4)) == pytest.approx((0.6, 0.8))
    assert np.allclose(tr.unit_vector([[3, 4], [0, 2]], axis=1), [[0.6, 0.8], [0, 1]])
    assert tr.vector_norm([[3, 4], [0, 2]], axis=1) == pytest.approx((5, 2))


SIGNATURES = {
    "euler_from_quaternion": ["quaternion", "axes"],
    "euler_from_matrix": ["matrix", "axes"],
    "quaternion_from_euler": ["ai", "aj", "ak", "axes"],
    "quaternion_multiply": ["quaternion1", "quaternion0"],
    "quaternion_inverse": ["quaternion"],
    "quaternion_matrix": ["quaternion"],
    "quaternion_from_matrix": ["matrix"],
    "quaternion_slerp": ["quat0", "quat1", "fraction", "spin", "shortestpath"],
    "quaternion_about_axis": ["angle", "axis"],
    "concatenate_matrices": ["matrices"],
    "translation_matrix": ["direction"],
    "translation_from_matrix": ["matrix"],
    "rotation_matrix": ["angle", "direction", "point"],
}


@pytest.mark.parametrize("name", SIGNATURES)
def test_arguments_have_the_names_of_the_original(name):
    assert list(inspect.signature(getattr(tr, name)).parameters) == SIGNATURES[name]


def test_all_of_them_are_in_the_package():
    assert set(tr.__all__) < set(tf.__all__)
    assert all(hasattr(tf, name) for name in tf.__all__)
