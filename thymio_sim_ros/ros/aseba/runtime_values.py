"""The current parameter values of the Aseba runtime."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.ros.aseba import parameters as aseba_params
from thymio_sim_ros.ros.aseba.parameters import RuntimeParams
from thymio_sim_ros.ros.rclpy_ext import parameters as params

__all__ = ["DebugOptions", "RuntimeValues"]


@dataclass(frozen=True, slots=True)
class DebugOptions:
    """Debug options of one robot: breakpoint lines, variables and local events with topics, language of help texts."""

    breakpoints: tuple[int, ...] = ()
    watch: tuple[str, ...] = ()
    local_events: tuple[str, ...] = ()
    language: str = "en"


class RuntimeValues:
    """Declares the parameters of the node and holds their accepted values.

    `params` are those of `RuntimeParams`; `by_name` are all by full name, also constants of programs and those of one
    robot.
    """

    def __init__(self, node: Node, defaults: RuntimeParams) -> None:
        """Raises WrongValueError for an invalid value given at the start."""
        self._node = node
        self.by_name = aseba_params.adopt_overrides(node)
        self.params = params.declare(node, defaults)
        self.by_name |= params.by_name(self.params)
        for name, value in self.by_name.items():
            aseba_params.check_value(name, value)
        self.is_declaring = False
        """Whether parameters of a robot are being declared: parameter callbacks then have nothing to do."""

    def set_layout(self, layout: str) -> None:
        """Replace the layout by that of a real robot; the parameter keeps its value."""
        self.params = replace(self.params, layout=layout)

    def declare_robot(self, robot: str) -> None:
        """Declare the parameters of a robot that are not declared yet."""
        self.is_declaring = True
        self.by_name |= aseba_params.declare_robot(self._node, robot)
        self.is_declaring = False

    def last_set_text(self, name: str) -> str:
        """Return the value of a text parameter as set last, accepted or held back; an empty text if it is not set."""
        return str(self._node.get_parameter_or(name, Parameter(name, value="")).value)

    def debug_options(self, robot: str) -> DebugOptions:
        """Return the options of one robot: its breakpoints replace those for all, its watches are added to them."""
        values = self.by_name
        own = f"robots.{robot}."
        return DebugOptions(
            breakpoints=tuple(values.get(f"{own}breakpoints") or values.get("breakpoints") or ()),
            watch=(*(values.get("watch") or ()), *(values.get(f"{own}watch") or ())),
            local_events=tuple(values.get("local_events") or ()),
            language=str(values.get("language", "en")),
        )
