"""The run log of the simulator node (parameter `log`)."""

from __future__ import annotations

from rclpy.node import Node

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

__all__ = ["Recording"]


class Recording:
    """Writes the run log, if there is one. A write error is logged once and ends the log, but not the node."""

    def __init__(self, node: Node, path: str) -> None:
        """Open the file; an empty path is no log. Raises StartError for a file that cannot be written."""
        self._node, self._path = node, path
        self._log: RunLog | None = None
        if not path:
            return
        try:
            file = open(path, "w", encoding="utf-8", newline="\n")  # noqa: SIM115  # the log closes it
            self._log = RunLog(file, on_error=self._on_error)
        except OSError as error:
            raise StartError(f"log '{path}': {error.strerror}, expected a writable file") from error

    def begin(self, name: str, engine: Engine) -> None:
        """Record an engine from its start; `name` is that of the playground."""
        if self._log is not None:
            self._log.begin(name, engine)

    def close(self) -> None:
        """Complete and close the file. May be called twice."""
        if self._log is not None:
            self._log.close()
            self._log = None

    def _on_error(self, error: OSError) -> None:
        self._node.get_logger().error(f"the log ends here: {self._path}: {error.strerror}")
