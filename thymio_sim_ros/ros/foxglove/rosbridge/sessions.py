"""All clients of rosbridge."""

from __future__ import annotations

from thymio_sim_ros.bridge.switchboard.events import RosbridgeJoined, RosbridgeLeft, RosbridgeReceived
from thymio_sim_ros.ros.foxglove.rosbridge.graph_feed import GraphFeed
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host
from thymio_sim_ros.ros.foxglove.rosbridge.session import Session

__all__ = ["Sessions"]


class Sessions:
    """The sessions of all connected clients. Belongs to the executor's thread."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._feed = GraphFeed(host.node)
        self._sessions: dict[int, Session] = {}

    def handle(self, event: RosbridgeJoined | RosbridgeReceived | RosbridgeLeft) -> None:
        """Handle an event of the server."""
        match event:
            case RosbridgeJoined():
                self._sessions[event.client] = Session(self._host, self._feed, event.client, event.role)
            case RosbridgeReceived():
                self._sessions[event.client].receive(event.frame)
            case RosbridgeLeft():
                self._sessions.pop(event.client).close()

    def poll(self) -> bool:
        """Do what is due; return whether more waits."""
        waits = [session.poll() for session in self._sessions.values()]
        return any(waits)

    def refresh(self) -> None:
        """Adapt to the graph, and send it to the clients that follow it."""
        for session in self._sessions.values():
            session.refresh()
        followers = [session for session in self._sessions.values() if session.follows_graph]
        if followers and self._feed.update():
            for session in followers:
                session.send_graph()

    def close(self) -> None:
        """End everything."""
        for session in self._sessions.values():
            session.close()
        self._sessions.clear()
