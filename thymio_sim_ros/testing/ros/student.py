"""Starts a node class under test, given as a file, as a module or directly.

Such a class calls `super().__init__("name")` and contains nothing for tests. Its node still gets the test's context,
parameters, remappings and namespace: a class inserted between it and `Node` in the method resolution order adds them.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.context import Context
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.names.type_names import type_name
from thymio_sim_ros.ros.rclpy_ext.connections import CLIENT, PUBLISHER, SERVER, SUBSCRIBER, Side, wrong_type
from thymio_sim_ros.testing.ros.student_errors import StudentError, never_ends

__all__ = [
    "StudentError",
    "load_class",
    "place",
    "remap_arguments",
    "start",
    "types_explained",
]

_SPINS = ("spin", "spin_once", "spin_until_future_complete")
_TURNS = (*_SPINS, "spin_once_until_future_complete")


def load_class(source: str | Path, class_name: str = "") -> type[Node]:
    """The node class of a file (*.py), or of a module given by its dotted name.

    The only node class is taken, unless `class_name` names one. A file may start its node in its last lines: functions
    that spin do nothing while it is loaded.

    Raises:
        StudentError: There is no such class, or more than one.
        ImportError: The module does not exist.
        Exception: Whatever the file raises.
    """
    path = Path(source)
    with _spinning_disabled():
        module = _run_file(path) if path.suffix == ".py" else importlib.import_module(str(source))
    classes = _classes(module)
    if class_name:
        chosen = [value for name, value in classes.items() if name == class_name]
    else:
        bases = {base for value in classes.values() for base in value.__mro__[1:]}
        chosen = [value for value in classes.values() if value not in bases]
    if len(chosen) != 1:
        wanted = f"a class {class_name}" if class_name else "one class"
        found = ", ".join(classes) or "none"
        raise StudentError(f"{source}: expected {wanted} derived from rclpy.node.Node, found {found}")
    return chosen[0]


def remap_arguments(
    name: str, namespace: str, remappings: Mapping[str, str], parameters: Mapping[str, Any] | None = None
) -> list[str]:
    """The command line arguments of `ros2 run` that set name, namespace, remappings and parameters."""
    rules = dict(remappings)
    if namespace:
        rules["__ns"] = "/" + namespace.strip("/")
    if name:
        rules["__node"] = name
    arguments = [word for old, new in rules.items() for word in ("-r", f"{old}:={new}")]
    for parameter, value in (parameters or {}).items():
        arguments += ["-p", f"{parameter}:={json.dumps(value)}"]
    return ["--ros-args", *arguments] if arguments else []


def start(
    kind: type[Node],
    context: Context,
    remap: Sequence[str],
    parameters: Mapping[str, Any],
    arguments: Mapping[str, Any],
) -> Node:
    """Create a node of this class in a context; `arguments` are those of its own constructor.

    Raises StudentError if the class does not call `super().__init__`: its context cannot be set then.
    """
    reached: list[bool] = []
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]

    class WithTestContext(Node):
        """Adds context, remappings and parameters of the test to the arguments of `Node`."""

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            reached.append(True)
            kwargs["context"] = context
            kwargs["cli_args"] = [*(kwargs.get("cli_args") or []), *remap]
            kwargs["parameter_overrides"] = [*(kwargs.get("parameter_overrides") or []), *overrides]
            super().__init__(*args, **kwargs)

        def create_publisher(self, msg_type: Any, topic: str, *args: Any, **kwargs: Any) -> Any:
            with types_explained(self, PUBLISHER, msg_type, topic):
                return super().create_publisher(msg_type, topic, *args, **kwargs)

        def create_subscription(self, msg_type: Any, topic: str, *args: Any, **kwargs: Any) -> Any:
            with types_explained(self, SUBSCRIBER, msg_type, topic):
                return super().create_subscription(msg_type, topic, *args, **kwargs)

        def create_client(self, srv_type: Any, srv_name: str, *args: Any, **kwargs: Any) -> Any:
            with types_explained(self, CLIENT, srv_type, srv_name):
                return super().create_client(srv_type, srv_name, *args, **kwargs)

        def create_service(self, srv_type: Any, srv_name: str, *args: Any, **kwargs: Any) -> Any:
            with types_explained(self, SERVER, srv_type, srv_name):
                return super().create_service(srv_type, srv_name, *args, **kwargs)

    derived = type(kind.__name__, (kind, WithTestContext), {"__module__": kind.__module__, "__doc__": kind.__doc__})
    node: Node = derived(**arguments)
    if not reached:
        node.destroy_node()
        raise StudentError(f"{kind.__name__} calls Node.__init__ itself: expected super().__init__(…)")
    return node


@contextlib.contextmanager
def types_explained(node: Node, side: Side, kind: Any, name: str) -> Iterator[None]:
    """Raise StudentError for an endpoint of another type than the topic or service has.

    One participant refuses it; in processes of their own both would exist without a connection.
    """
    try:
        yield
    except RCLError as error:
        is_topic = side in (PUBLISHER, SUBSCRIBER)
        full = node.resolve_topic_name(name) if is_topic else node.resolve_service_name(name)
        listed = node.get_topic_names_and_types() if is_topic else node.get_service_names_and_types()
        found = type_name(kind)
        others = [other for topic, kinds in listed if topic == full for other in kinds if other != found]
        if not others:
            raise
        types = {topic: kinds[0] for topic, kinds in listed} | {full: others[0]}
        raise StudentError(str(wrong_type(side, full, node.get_fully_qualified_name(), found, types))) from error


def place(kind: type[Node]) -> str:
    """File and line of the constructor of a class."""
    code = getattr(kind.__init__, "__code__", None)
    return f"{code.co_filename}, line {code.co_firstlineno}" if code else kind.__module__


def _run_file(path: Path) -> ModuleType:
    if not path.is_file():
        raise StudentError(f"{path}: no such file")
    name = f"{path.stem}_under_test"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise StudentError(f"{path}: not a Python file")
    module = importlib.util.module_from_spec(spec)
    with _folder_modules(path.parent.absolute()):
        sys.modules[name] = module
        try:
            spec.loader.exec_module(module)
        except SystemExit:  # `sys.exit(main())`
            if not _classes(module):
                raise
        finally:
            sys.modules.pop(name, None)
            for value in vars(module).values():
                if isinstance(value, Node):
                    value.destroy_node()
    return module


def _classes(module: ModuleType) -> dict[str, type[Node]]:
    """The node classes that a module itself defines, by name."""
    return {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type) and issubclass(value, Node) and value.__module__ == module.__name__
    }


@contextlib.contextmanager
def _folder_modules(folder: Path) -> Iterator[None]:
    """Make the modules of a folder importable, even if modules of the same names are loaded; unload them afterwards.

    Each submission may have a `helpers.py` of its own.
    """
    names = {path.stem for path in folder.glob("*.py")} | {path.parent.name for path in folder.glob("*/__init__.py")}
    aside = {
        name: module
        for name, module in list(sys.modules.items())
        if name.partition(".")[0] in names and not _lies_in(module, folder)
    }
    before = sys.modules.keys() - aside.keys()
    for name in aside:
        del sys.modules[name]
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in sys.modules.keys() - before:
            if _lies_in(sys.modules[name], folder):
                del sys.modules[name]
        sys.modules.update(aside)


def _lies_in(module: ModuleType, folder: Path) -> bool:
    places = [getattr(module, "__file__", None), *getattr(module, "__path__", ())]
    return any(place and Path(place).is_relative_to(folder) for place in places)


@contextlib.contextmanager
def _spinning_disabled() -> Iterator[None]:
    """Make lines such as `rclpy.init(); rclpy.spin(Wanderer())` do nothing while a file is loaded."""

    loading = True

    def spin(node: Node, *_args: Any, **_kwargs: Any) -> None:
        if not loading:  # `from rclpy import spin` keeps this function after loading
            raise never_ends("rclpy.spin()")
        node.destroy_node()

    def turn(executor: Executor, *_args: Any, **_kwargs: Any) -> None:
        for node in executor.get_nodes():
            executor.remove_node(node)
            node.destroy_node()

    quiet: dict[str, Any] = {"init": _nothing, "shutdown": _nothing, "try_shutdown": _nothing, "ok": lambda **_: False}
    kinds = (Executor, SingleThreadedExecutor, MultiThreadedExecutor)
    owners: list[tuple[Any, dict[str, Any]]] = [
        (rclpy, quiet | dict.fromkeys(_SPINS, spin)),
        *((kind, {name: turn for name in _TURNS if name in vars(kind)}) for kind in kinds),
    ]
    before = [(owner, name, getattr(owner, name)) for owner, names in owners for name in names]
    for owner, names in owners:
        for name, value in names.items():
            setattr(owner, name, value)
    try:
        yield
    finally:
        loading = False
        for owner, name, value in before:
            setattr(owner, name, value)


def _nothing(*_args: Any, **_kwargs: Any) -> contextlib.AbstractContextManager[None]:
    """Replaces a function that must do nothing now; also works as `with rclpy.init():`."""
    return contextlib.nullcontext()
