"""InstalledGraph: the nodes of a program, which are matched with all others before a message could be lost."""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from rclpy.client import Client
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.lockstep.installed_ros.barrier import Barrier
from thymio_sim_ros.lockstep.matching import EVERYWHERE, endpoints, is_complete

__all__ = ["InstalledGraph"]

CREATING = ("create_publisher", "create_subscription", "create_client", "create_service")
DESTROYING = ("destroy_publisher", "destroy_subscription", "destroy_client", "destroy_service", "destroy_node")


class InstalledGraph:
    """The nodes and participants of this process."""

    def __init__(self, name: str, settle: Callable[[], None], poll: Callable[[], None]) -> None:
        """`settle()` waits until new endpoints are matched; it is called before the first message."""
        self._name = name
        self._settle = settle
        self._poll = poll
        self._nodes: list[weakref.ref[Node]] = []
        self._barriers: list[Barrier] = []
        self._ended: dict[str, int] = {}
        """Last marks of participants that are shut down."""
        self._is_own = False
        """Whether the call of rclpy is one of this class, not one of the program."""
        self.has_new = False
        """Whether there are endpoints that may not be matched yet."""
        self.has_changed = False
        """Whether endpoints were created or destroyed since `endpoints` was called."""

        self._follow()

    def _follow(self) -> None:
        """Follow all nodes that the program creates."""
        self._follow_contexts()
        self._follow_nodes()
        self._settle_before(Publisher, "publish", "get_subscription_count")
        self._settle_before(Client, "call_async", "service_is_ready")
        self._settle_before(Node, "count_publishers", "count_subscribers", "get_topic_names_and_types")

    # --- the other process ---

    def marks(self) -> dict[str, int]:
        """Publish a mark behind all messages so far; return the last mark of each participant."""
        with self._own_calls():
            for barrier in self._barriers:
                barrier.mark()
        return {**self._ended, **{barrier.source: barrier.sent for barrier in self._barriers}}

    def outgoing(self, event: str) -> dict[str, Any]:
        """What a message to the test has: marks, and the endpoints if they have changed."""
        changed = {"endpoints": self.endpoints()} if self.has_changed or event == "settle" else {}
        return {"marks": self.marks(), **changed}

    def receive(self, message: Mapping[str, Any]) -> None:
        """Begin a turn: wait until all messages before the marks of other processes have arrived."""
        for barrier in self._barriers:
            barrier.wait(message["marks"])

    def leave_test(self) -> None:
        """Need nothing in a process that the program forked."""

    def endpoints(self) -> dict[str, dict[str, int]]:
        """The numbers of endpoints by kind and name."""
        self.has_new = self.has_changed = False
        return endpoints(self._alive())

    def match(self, expected: Mapping[str, Mapping[str, int]]) -> None:
        """Wait until all endpoints are matched with those of all processes."""
        nodes = self._alive()
        with self._own_calls():
            real_time.wait_for(
                lambda: is_complete(nodes, expected), "all publishers and subscriptions to find each other"
            )

    def _alive(self) -> list[Node]:
        """Nodes that are neither destroyed nor still in the constructor of rclpy."""
        nodes = [node for reference in self._nodes if (node := reference()) is not None]
        return [node for node in nodes if getattr(node, "_Node__node", None) and node.context.ok()]

    @contextlib.contextmanager
    def _own_calls(self) -> Iterator[None]:
        before, self._is_own = self._is_own, True
        try:
            yield
        finally:
            self._is_own = before

    # --- what the program creates ---

    def _follow_contexts(self) -> None:
        kind: Any = Context
        init, shutdown, try_shutdown = kind.init, kind.shutdown, kind.try_shutdown

        def init_context(context: Context, *args: Any, **kwargs: Any) -> None:
            init(context, *args, **kwargs)
            count = len(self._barriers) + len(self._ended)
            with self._own_calls():
                self._barriers.append(Barrier(context, f"{self._name}_{count}"))
            self.has_new = True

        def leaving(end: Callable[[Context], None]) -> Callable[[Context], None]:
            def shutdown_context(context: Context) -> None:
                self._leave(context)
                end(context)

            return shutdown_context

        kind.init, kind.shutdown, kind.try_shutdown = init_context, leaving(shutdown), leaving(try_shutdown)

    def _leave(self, context: Context) -> None:
        # The last mark goes out while the participant exists. Others wait for it before they continue, so that they
        # receive what the program published just before its end.
        if self.has_new and context.ok():
            self._settle()
        for barrier in [barrier for barrier in self._barriers if barrier.context is context]:
            if context.ok():
                with self._own_calls():
                    barrier.mark()
            self._ended[barrier.source] = barrier.sent
            self._barriers.remove(barrier)
            self.has_changed = True

    def _follow_nodes(self) -> None:
        kind: Any = Node
        init = kind.__init__

        def init_node(node: Node, *args: Any, **kwargs: Any) -> None:
            self._nodes.append(weakref.ref(node, self._nodes.remove))
            init(node, *args, **kwargs)

        def noted(change: Callable[..., Any], *, is_new: bool) -> Callable[..., Any]:
            def changing(node: Node, *args: Any, **kwargs: Any) -> Any:
                self.has_changed = True
                self.has_new |= is_new
                return change(node, *args, **kwargs)

            return changing

        kind.__init__ = init_node
        for name in CREATING:
            setattr(kind, name, noted(getattr(kind, name), is_new=True))
        for name in DESTROYING:
            setattr(kind, name, noted(getattr(kind, name), is_new=False))

    def _settle_before(self, kind: Any, *names: str) -> None:
        # DDS discards a message for a subscription that is not matched yet, and whether it is depends on real time. So
        # the first use of a new endpoint waits for all matches. Calls of this class itself (`_is_own`) must not: they
        # are made during that wait.
        def settled(function: Callable[..., Any]) -> Callable[..., Any]:
            def settling(own: Any, *args: Any, **kwargs: Any) -> Any:
                if not self._is_own and getattr(own, "topic_name", "") not in EVERYWHERE:
                    if self.has_new:
                        self._settle()
                    self._poll()
                return function(own, *args, **kwargs)

            return settling

        for name in names:
            setattr(kind, name, settled(getattr(kind, name)))
