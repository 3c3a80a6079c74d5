"""rclpy: initialization, nodes, and functions that run their callbacks."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context as Context
    from thymio_sim_ros.portable_ros.rclpy.executors import Executor
    from thymio_sim_ros.portable_ros.rclpy.node import Node
    from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter as Parameter
    from thymio_sim_ros.portable_ros.rclpy.signals import SignalHandlerOptions
    from thymio_sim_ros.portable_ros.rclpy.task import Future as Future
    from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context as get_default_context
    from thymio_sim_ros.portable_ros.rclpy.utilities import (
        get_rmw_implementation_identifier as get_rmw_implementation_identifier,
    )
    from thymio_sim_ros.portable_ros.rclpy.utilities import ok as ok
    from thymio_sim_ros.portable_ros.rclpy.utilities import try_shutdown as try_shutdown

_PLACES = {
    "Context": "context",
    "Future": "task",
    "Parameter": "parameter",
    "SignalHandlerOptions": "signals",
    "get_default_context": "utilities",
    "get_rmw_implementation_identifier": "utilities",
    "ok": "utilities",
    "try_shutdown": "utilities",
}
"""The modules of the names that are here, too."""


def __getattr__(name: str) -> Any:
    """Import what is first used: the modules of this package and their names."""
    try:
        if name in _PLACES:
            return getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)
        return importlib.import_module(f"{__name__}.{name}")
    except ModuleNotFoundError as error:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}") from error


_global_executor: Executor | None = None


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> None:
    """Initialize a context, by default the default one, with the arguments of the process or others.

    Signals shut the default context down, others only if `signal_handler_options` says so.
    """
    from thymio_sim_ros.portable_ros.rclpy.signals import (
        SignalHandlerOptions,
        install_signal_handlers,
        shut_down_at_signals,
    )
    from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context

    is_default = context is None
    context = context or get_default_context()
    context.init(None if args is None else list(args), domain_id=domain_id)
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if is_default else SignalHandlerOptions.NO
    if signal_handler_options != SignalHandlerOptions.NO:
        install_signal_handlers(signal_handler_options)
        shut_down_at_signals(context, _release_global_executor)  # `spin` raises ExternalShutdownException


def get_global_executor() -> Executor:
    """The executor of the functions below, if none is given."""
    global _global_executor
    if _global_executor is None:
        from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor
        from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context

        # Before the executor registers, which wakes what waits in it: a shutdown by the program ends `spin` quietly.
        get_default_context().on_shutdown(_end_global_executor)
        _global_executor = SingleThreadedExecutor()
    return _global_executor


def _end_global_executor() -> None:
    executor = _release_global_executor()
    if executor is not None:
        executor.shutdown(timeout_sec=0)


def _release_global_executor() -> Executor | None:
    """Let the functions below have a new executor; return the present one, which a shutdown does not end any more."""
    global _global_executor
    executor, _global_executor = _global_executor, None
    return executor


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down, by default the default one. Raises RuntimeError if that has been done."""
    from thymio_sim_ros.portable_ros.rclpy import utilities
    from thymio_sim_ros.portable_ros.rclpy.signals import uninstall_signal_handlers

    is_default = context is None
    utilities.shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and is_default):
        uninstall_signal_handlers()


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: Sequence[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    start_parameter_services: bool = True,
    parameter_overrides: Sequence[Parameter] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Create a node. Raises as its class."""
    from thymio_sim_ros.portable_ros.rclpy.node import Node

    return Node(
        node_name,
        context=context,
        cli_args=cli_args,
        namespace=namespace,
        use_global_arguments=use_global_arguments,
        enable_rosout=enable_rosout,
        start_parameter_services=start_parameter_services,
        parameter_overrides=parameter_overrides,
        allow_undeclared_parameters=allow_undeclared_parameters,
        automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        enable_logger_service=enable_logger_service,
    )


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Execute one callback of a node, or none if none is ready in time."""
    executor = executor or get_global_executor()
    is_new = executor.add_node(node)
    try:
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        if is_new:
            executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Execute the callbacks of a node until the context is shut down."""
    executor = executor or get_global_executor()
    try:
        executor.add_node(node)
        while executor.context.ok():
            executor.spin_once()
    finally:
        executor.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Execute the callbacks of a node until a future is done or the time is over."""
    executor = executor or get_global_executor()
    is_new = executor.add_node(node)
    try:
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if is_new:
            executor.remove_node(node)
