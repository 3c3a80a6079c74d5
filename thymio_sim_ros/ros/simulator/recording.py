"""The run log of the simulator node: in the file of the parameter `log`, and the present run in memory."""

from __future__ import annotations

from rclpy.node import Node

from thymio_sim_ros.engine.compressed_text import CompressedText
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError

__all__ = ["MAX_KEPT_BYTES", "Recording"]

MAX_KEPT_BYTES = 20_000_000
"""Largest size of the run that is kept in memory, compressed: hours, unless programs or clients are replaced often."""


class Recording:
    """Writes the run log. A write error is logged once and ends the log, but not the node."""

    def __init__(self, node: Node, path: str) -> None:
        """Open the file; an empty path is no file. Raises StartError for a file that cannot be written."""
        self._node, self._path = node, path
        self._log: RunLog | None = None
        self._kept: RunLog | None = None
        self._content: CompressedText | None = None
        """The log of the present run; None if it became too large."""
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
        self.keep(name, engine)

    def keep(self, name: str, engine: Engine) -> None:
        """Keep the run of an engine in memory, from its start or its last reset on."""
        if self._kept is not None:
            self._kept.close()
        self._content = CompressedText(MAX_KEPT_BYTES)
        self._kept = RunLog(self._content, on_error=self._forget)
        self._kept.begin(name, engine)

    def run(self) -> bytes | None:
        """Return the log of the present run up to now, compressed with gzip; None if it became too large."""
        if self._kept is None or self._content is None:
            return None
        return self._content.content(self._kept.ending())

    def close(self) -> None:
        """Complete and close the file. May be called twice."""
        for log in (self._log, self._kept):
            if log is not None:
                log.close()
        self._log = self._kept = None

    def _forget(self, _error: OSError) -> None:
        self._content = None

    def _on_error(self, error: OSError) -> None:
        self._node.get_logger().error(f"the log ends here: {self._path}: {error.strerror}")
