"""Whether a value of a parameter fits its descriptor."""

from __future__ import annotations

import math

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter

__all__ = ["REL_TOL", "range_problem", "type_problem"]

REL_TOL = 1e-6
"""Relative tolerance of limits and steps of numbers with a decimal point."""


def type_problem(parameter: Parameter, descriptor: ros_types.ParameterDescriptor, *, is_declared: bool) -> str:
    """Why the type of a value does not fit, empty if it does."""
    if is_declared and parameter.type_ is Parameter.Type.NOT_SET:
        return "Static parameter cannot be undeclared"
    if parameter.type_ is not Parameter.Type.NOT_SET and parameter.type_.value != descriptor.type:
        return f"Wrong parameter type, expected '{Parameter.Type(descriptor.type)}' got '{parameter.type_}'"
    return ""


def range_problem(parameter: Parameter, descriptor: ros_types.ParameterDescriptor) -> str:
    """Why a number is not in its range, empty if it is."""
    if parameter.type_ is Parameter.Type.INTEGER and descriptor.integer_range:
        return _integer_problem(parameter, descriptor.integer_range[0])
    if parameter.type_ is Parameter.Type.DOUBLE and descriptor.floating_point_range:
        return _float_problem(parameter, descriptor.floating_point_range[0])
    return ""


def _integer_problem(parameter: Parameter, limits: ros_types.IntegerRange) -> str:
    low, high = sorted((limits.from_value, limits.to_value))
    name, value = parameter.name, parameter.value
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range. Min: {low}, Max: {high}, value: {value}"
    if limits.step and (value - low) % limits.step:
        return (
            f"The parameter value for {name} is not a valid step. Min: {low}, max: {high}, value: {value},"
            f" step: {limits.step}"
        )
    return ""


def _float_problem(parameter: Parameter, limits: ros_types.FloatingPointRange) -> str:
    low, high = sorted((limits.from_value, limits.to_value))
    name, value = parameter.name, parameter.value
    if math.isclose(value, low, rel_tol=REL_TOL) or math.isclose(value, high, rel_tol=REL_TOL):
        return ""
    if not low < value < high:
        return f"Parameter {name} out of range Min: {low}, Max: {high}, value: {value}"
    if limits.step:
        nearest = low + round((value - low) / limits.step) * limits.step
        if not math.isclose(nearest, value, rel_tol=REL_TOL):
            return (
                f"The parameter value for {name} is not close enough to a valid step. Min: {low}, max: {high},"
                f" value: {value}, step: {limits.step}"
            )
    return ""
