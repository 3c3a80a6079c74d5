"""The hidden node of a command, what it knows of the graph, and errors that say what is there."""

from __future__ import annotations

import difflib
import time
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rclpy.action import get_action_names_and_types
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden

from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type
from thymio_sim_ros.ros.profiles import missing_name
from thymio_sim_ros.ros_commands.errors import CommandError

if TYPE_CHECKING:
    import argparse

    from rclpy.task import Future

__all__ = ["ANSWER_S", "Member", "find_by_type", "listed", "load", "print_types"]

_STEP_S = 0.05
_QUIET_S = 0.5
"""A graph that has not changed for this time counts as discovered."""
_NEW_S = 1.0
"""Longest wait for something that need not be there."""
ANSWER_S = 5.0
"""Longest wait for the response of a service that answers at once."""
_SIMULATOR = "/simulator"
_MOST_NAMES = 8
"""Names that an error lists."""

NamesAndTypes = Mapping[str, Sequence[str]]


class Member:
    """A node with its executor. `discovery_s` is the longest wait for what is not there yet; 0 if all is known."""

    def __init__(self, node: Node, executor: SingleThreadedExecutor, discovery_s: float) -> None:
        self.node, self._executor, self._discovery_s = node, executor, discovery_s

    # --- time ---

    def spin_until(self, is_done: Callable[[], object], seconds: float | None = None) -> bool:
        """Execute callbacks until something is true; return whether it is after the time."""
        end_s = None if seconds is None else time.monotonic() + seconds
        while not is_done():
            if end_s is not None and time.monotonic() >= end_s:
                return False
            self._executor.spin_once(timeout_sec=_STEP_S)
        return True

    def result(self, future: Future[Any], what: str, seconds: float | None = None) -> Any:
        """The result of a future. Raises CommandError if there is none in time."""
        if not self.spin_until(future.done, seconds):
            raise CommandError(f"found no answer of {what} within {seconds:g} s")
        return future.result()

    def answer(self, future: Future[Any], what: str) -> Any:
        """The response of a service that answers at once. Raises CommandError."""
        return self.result(future, what, ANSWER_S)

    def wait(self, is_there: Callable[[], object]) -> bool:
        """Wait for the discovery of something; return whether it is there."""
        return self.spin_until(is_there, self._discovery_s)

    def discover(self) -> None:
        """Wait until the graph does not change."""
        known: object = None
        since_s = time.monotonic()

        def is_quiet() -> bool:
            nonlocal known, since_s
            now = (self.nodes(), self.topics(), self.services())
            if now != known:
                known, since_s = now, time.monotonic()
            return time.monotonic() - since_s >= _QUIET_S

        self.spin_until(is_quiet, self._discovery_s)

    # --- graph ---

    def topics(self) -> NamesAndTypes:
        """The topics with their types."""
        return _sorted(self.node.get_topic_names_and_types())

    def services(self) -> NamesAndTypes:
        """The services with their types."""
        return _sorted(self.node.get_service_names_and_types())

    def actions(self) -> NamesAndTypes:
        """The actions with their types."""
        return _sorted(get_action_names_and_types(self.node))

    def nodes(self) -> list[str]:
        """The full names of the nodes, but not of this one."""
        names = [f"{place.rstrip('/')}/{name}" for name, place in self.node.get_node_names_and_namespaces()]
        return sorted(name for name in names if name != self.node.get_fully_qualified_name())

    def find(self, what: str, name: str, known: Callable[[], Collection[str]]) -> str:
        """The full name of something that is there now or soon. Raises CommandError with what is there."""
        full = name if name.startswith("/") else f"/{name}"
        if not self.wait(lambda: full in known()):
            raise CommandError(f"found no {what} {full}{self._why_missing(what, full) or _instead(full, known())}")
        return full

    def _why_missing(self, what: str, full: str) -> str:
        """The end of an error about a name that the simulator does not have on purpose, with `--like`."""
        nodes = self.nodes()
        reason = missing_name(f"{full}/" if what == "node" else full, nodes) if _SIMULATOR in nodes else ""
        return f": {reason}" if reason else ""

    def find_type(self, what: str, name: str, known: Callable[[], NamesAndTypes]) -> tuple[str, str]:
        """The full name of a topic, service or action and its type. Raises CommandError."""
        full = self.find(what, name, known)
        return full, known()[full][0]

    def check_type(self, what: str, name: str, kind: str, known: Callable[[], NamesAndTypes]) -> str:
        """The full name of something that may be new. Raises CommandError if it is there with other types only."""
        full = name if name.startswith("/") else f"/{name}"
        self.spin_until(lambda: full in known(), min(self._discovery_s, _NEW_S))
        there = known()
        if there.get(full) and kind not in there[full]:
            raise CommandError(f"{what} {full}: found type {kind}, expected {' or '.join(there[full])}")
        return full


def listed(names: NamesAndTypes, *, types: bool, count: bool, hidden: bool) -> None:
    """Print names, with their types or as their number only."""
    shown = [name for name in names if hidden or not topic_or_service_is_hidden(name)]
    if count:
        print(len(shown))
        return
    for name in shown:
        print(f"{name} [{', '.join(names[name])}]" if types else name)


def print_types(member: Member, what: str, name: str, known: Callable[[], NamesAndTypes]) -> None:
    """Print the types of a topic, service or action. Raises CommandError."""
    for kind in known()[member.find(what, name, known)]:
        print(kind)


def find_by_type(member: Member, options: argparse.Namespace, form: str, known: Callable[[], NamesAndTypes]) -> None:
    """Print the names that have the type `options.type`. Raises CommandError for an unknown type."""
    kind, _ = load(options.type, form)
    member.discover()
    found = {name: types for name, types in known().items() if kind in types}
    listed(found, types=False, count=options.count, hidden=options.include_hidden)


def load(name: str, form: str) -> tuple[str, Any]:
    """The full name and the class of a type; `form` is `msg`, `srv` or `action`. Raises CommandError."""
    full = full_name(name, form)
    package, _, rest = full.partition("/")
    kind, _, short = rest.partition("/")
    if kind and kind != form:
        raise CommandError(f"found type {name}, expected one such as {package}/{form}/Name")
    try:
        return full, load_type(full)
    except MissingTypeError as error:
        raise CommandError(f"{error}{_instead(short, _shorts(package, form))}") from error


def _shorts(package: str, form: str) -> list[str]:
    """The names of types of a package, if there is one."""
    try:
        module: ModuleType = __import__(f"{package}.{form}", fromlist=[form])
    except (ImportError, ValueError):
        return []
    return [name for name in dir(module) if name[:1].isupper() and "_" not in name]


def _instead(name: str, known: Iterable[str]) -> str:
    """The end of an error: a name that is like another one, or those that there are."""
    names = sorted(one for one in known if not topic_or_service_is_hidden(one))
    if close := difflib.get_close_matches(name, names, 1):
        return f"; did you mean {close[0]}?"
    if not names:
        return "; there is none"
    more = ", …" if len(names) > _MOST_NAMES else ""
    return f"; there are {', '.join(names[:_MOST_NAMES])}{more}"


def _sorted(found: Iterable[tuple[str, Sequence[str]]]) -> NamesAndTypes:
    return {name: list(types) for name, types in sorted(found)}
