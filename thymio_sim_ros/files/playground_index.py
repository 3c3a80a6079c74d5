"""The shipped playgrounds as self-contained texts, for pages that draw and edit them."""

from __future__ import annotations

import threading
from pathlib import Path

from thymio_sim_ros.files import resources
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground import writer

__all__ = ["PlaygroundIndex"]


class PlaygroundIndex:
    """Texts of playgrounds by name, cached by version of the file. Thread-safe."""

    def __init__(self) -> None:
        self._texts: dict[Path, tuple[int, bytes]] = {}
        self._lock = threading.Lock()

    def text(self, name: str) -> bytes | None:
        """A playground in this project's format with its images, in UTF-8; None for a name that is not shipped.

        Raises PlaygroundError for an invalid file.
        """
        path = resources.playgrounds().get(name)
        if path is None:
            return None
        with self._lock:
            version = path.stat().st_mtime_ns if path.exists() else 0
            known = self._texts.get(path)
            if known is None or known[0] != version:
                text = writer.dumps(playgrounds.load(path)).encode()
                known = self._texts[path] = (version, text)
            return known[1]
