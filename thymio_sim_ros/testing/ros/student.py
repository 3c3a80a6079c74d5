"""A node class that somebody else wrote, started in the test: from a file, a module or as it is.

Such a class calls `super().__init__("name")` and knows nothing of tests. Its node still gets the test's context,
parameters, remappings and namespace: a class of ours stands behind it in the order of its bases and adds them.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

__all__ = ["StudentError", "load_class", "remap_arguments", "start"]

_SPINS = ("spin", "spin_once", "spin_until_future_complete")


class StudentError(Exception):
    """What was handed in is no node that can be started; the text says what is missing."""


def load_class(source: str | Path, class_name: str = "") -> type[Node]:
    """The node class of a file (*.py) or of a module by its dotted name; its only one, unless named.

    Raises StudentError where there is none or more than one, ImportError for a module that is not there, and what the
    file itself raises. A file whose last lines start the node is understood: nothing spins while it is loaded.
    """
    path = Path(source)
    with _nothing_spins():
        module = _run_file(path) if path.suffix == ".py" else importlib.import_module(str(source))
    classes = {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type) and issubclass(value, Node) and value.__module__ == module.__name__
    }
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


def remap_arguments(name: str, namespace: str, remappings: Mapping[str, str]) -> list[str]:
    """What `ros2 run` would say: a node's name, its namespace, and names that it shall use instead of its own."""
    rules = dict(remappings)
    if namespace:
        rules["__ns"] = "/" + namespace.strip("/")
    if name:
        rules["__node"] = name
    arguments = [word for old, new in rules.items() for word in ("-r", f"{old}:={new}")]
    return ["--ros-args", *arguments] if arguments else []


def start(
    kind: type[Node],
    context: Context,
    remap: Sequence[str],
    parameters: Mapping[str, Any],
    arguments: Mapping[str, Any],
) -> Node:
    """A node of this class in a context, with `arguments` for its own constructor.

    StudentError: the class does not call `super().__init__`, so that nothing can be given to it.
    """
    reached: list[bool] = []
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]

    class Placed(Node):
        """Adds what the test wants to what the class itself says."""

        def __init__(self, *args: Any, **kwargs: Any) -> None:
            reached.append(True)
            kwargs["context"] = context
            kwargs["cli_args"] = [*(kwargs.get("cli_args") or []), *remap]
            kwargs["parameter_overrides"] = [*(kwargs.get("parameter_overrides") or []), *overrides]
            super().__init__(*args, **kwargs)

    placed = type(kind.__name__, (kind, Placed), {"__module__": kind.__module__, "__doc__": kind.__doc__})
    node: Node = placed(**arguments)
    if not reached:
        node.destroy_node()
        raise StudentError(f"{kind.__name__} calls Node.__init__ itself: expected super().__init__(…)")
    return node


def _run_file(path: Path) -> Any:
    if not path.is_file():
        raise StudentError(f"{path}: no such file")
    name = f"{path.stem}_under_test"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise StudentError(f"{path}: not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    sys.path.insert(0, str(path.parent))
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(path.parent))
        sys.modules.pop(name, None)
        for value in vars(module).values():
            if isinstance(value, Node):
                value.destroy_node()
    return module


@contextlib.contextmanager
def _nothing_spins() -> Iterator[None]:
    """Lines such as `rclpy.init(); rclpy.spin(Wanderer())` do nothing while a file is loaded."""

    def spin(node: Node, *_args: Any, **_kwargs: Any) -> None:
        node.destroy_node()

    quiet: dict[str, Any] = {"init": _nothing, "shutdown": _nothing, "try_shutdown": _nothing, "ok": lambda **_: False}
    quiet |= dict.fromkeys(_SPINS, spin)
    before = {name: getattr(rclpy, name) for name in quiet}
    for name, value in quiet.items():
        setattr(rclpy, name, value)
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(rclpy, name, value)


def _nothing(*_args: Any, **_kwargs: Any) -> contextlib.AbstractContextManager[None]:
    """In place of a function that is not to do anything now; `with rclpy.init():` is one, too."""
    return contextlib.nullcontext()
