"""The web page as a ROS node: static files over HTTP from a thread that shares nothing.

The page speaks the Foxglove protocol to the bridge; this server only gives it its files, the shipped playgrounds as
`/playgrounds/NAME.json`, and `/config.json`, which names the bridge's port. Loopback by default; nothing is written,
nothing else is served. Text goes out compressed: a class that opens the page at once shares one radio.
"""

from __future__ import annotations

import gzip
import io
import json
import re
import threading
import urllib.parse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from rclpy.context import Context
from rclpy.executors import Executor

import thymio_sim_ros
from thymio_sim_ros import resources
from thymio_sim_ros.gallery import Gallery
from thymio_sim_ros.greeting import places
from thymio_sim_ros.nodes import params
from thymio_sim_ros.nodes.life import SPIN_SLICE_S, StartError, greeted, run_main
from thymio_sim_ros.nodes.parameter_node import parameter_node
from thymio_sim_ros.nodes.params import param
from thymio_sim_ros.sim.playground import PlaygroundError
from thymio_sim_ros.suite import ADDRESS, FOXGLOVE_PORT, HTTP_PORT

_PLAYGROUND = re.compile(r"/playgrounds/([^/]+)\.json")

# The platform's own table may be wrong (web-ui-features.md section 5.4).
TYPES = {
    "": "application/octet-stream",
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
    ".mp3": "audio/mpeg",
}
_COMPRESSED = frozenset({".html", ".css", ".js", ".mjs", ".json", ".svg"})
_GZIP = re.compile(r"(?:^|,)\s*gzip\s*(?:;\s*q=(?!0(?:\.0*)?\s*(?:,|$))[\d.]+\s*)?(?:,|$)")
"""In `Accept-Encoding`, unless it says `q=0`."""


@dataclass(frozen=True)
class WebParams:
    """Parameters of the web node."""

    port: int = param(HTTP_PORT, "TCP port of the page; 0 takes a free one", low=0, high=65535, fixed=True)
    address: str = param(ADDRESS, "Address to listen on; 0.0.0.0 for the whole network", fixed=True)
    foxglove_port: int = param(
        FOXGLOVE_PORT, "Port of the Foxglove bridge on the same host", low=1, high=65535, fixed=True
    )


class _Handler(SimpleHTTPRequestHandler):
    """Serves the page's folder, never cached, the shipped playgrounds, and the configuration."""

    extensions_map = TYPES

    def __init__(self, *args: Any, config: bytes, gallery: Gallery, page: Path | None, **kwargs: Any) -> None:
        self._config = config
        self._gallery = gallery
        self._page = page
        super().__init__(*args, directory=str(page or Path("/nonexistent")), **kwargs)

    def do_HEAD(self) -> None:
        """As GET, without what comes after the headers."""
        self.do_GET()

    def do_GET(self) -> None:
        """Configuration, a playground, a file of the page, or the sentence that tells how to build it."""
        path = self.path.partition("?")[0]
        playground = _PLAYGROUND.fullmatch(path)
        if path == "/config.json":
            self._answer(200, TYPES[".json"], self._config)
        elif playground is not None:
            self._playground(urllib.parse.unquote(playground[1]))
        elif self._page is None:
            text = f"<!doctype html><meta charset=utf-8><title>Thymio</title><p>{resources.PAGE_BUILD_HINT}</p>"
            self._answer(503, TYPES[".html"], text.encode())
        elif self.command == "HEAD":
            super().do_HEAD()
        else:
            super().do_GET()

    def send_head(self) -> Any:
        """The headers of a file; what is to be sent after them. Who asks whether it is new gets it as it lies there."""
        try:
            return self._send_head()
        except (OSError, ValueError):  # a name that no file can have
            self.send_error(404)
            return None

    def _send_head(self) -> Any:
        path = Path(self.translate_path(self.path))
        if self.path.partition("?")[0].endswith("/") and not path.is_dir():
            self.send_error(404)
            return None
        if path.is_dir() and self.path.partition("?")[0].endswith("/"):
            path /= "index.html"
        wanted = self.headers.get("Accept-Encoding", "")
        if path.suffix not in _COMPRESSED or not _GZIP.search(wanted) or "If-Modified-Since" in self.headers:
            return super().send_head()
        try:
            status = path.stat()
            body = _zipped(path, status.st_mtime_ns)
        except OSError:
            return super().send_head()
        self.send_response(200)
        self.send_header("Content-Type", self.guess_type(path))
        self.send_header("Content-Encoding", "gzip")
        self.send_header("Vary", "Accept-Encoding")
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Last-Modified", self.date_time_string(status.st_mtime))
        self.end_headers()
        return io.BytesIO(body)

    def list_directory(self, path: Any) -> None:
        """Folders are not listed."""
        self.send_error(404)

    def end_headers(self) -> None:
        """Every answer: fresh, and of the type it says."""
        self.send_header("Cache-Control", "no-cache")
        self.send_header("X-Content-Type-Options", "nosniff")
        super().end_headers()

    def log_message(self, *_args: Any) -> None:
        """A page view is no news."""

    def _playground(self, name: str) -> None:
        try:
            text = self._gallery.text(name)
        except PlaygroundError as error:
            self._answer(422, "text/plain; charset=utf-8", str(error).encode())
            return
        if text is None:
            self.send_error(404)
        else:
            self._answer(200, TYPES[".json"], text)

    def _answer(self, status: int, kind: str, body: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)


@lru_cache(maxsize=64)
def _zipped(path: Path, _changed_ns: int) -> bytes:
    """A file compressed; OSError if it cannot be read."""
    return gzip.compress(path.read_bytes(), mtime=0)


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    allow_reuse_address = True


class WebPage:
    """The web node and its HTTP server. `port` is the one really taken."""

    def __init__(self, context: Context, defaults: WebParams | None = None) -> None:
        self.node = parameter_node("web_ui", context=context)
        self.params = params.declare(self.node, defaults or WebParams())
        params.warn_of_unknown(self.node, "ros2-tools.md")
        config = {"foxglove_port": self.params.foxglove_port, "version": thymio_sim_ros.__version__}
        page = resources.page()
        if page is None:
            self.node.get_logger().warning(resources.PAGE_BUILD_HINT)
        handler = partial(_Handler, config=json.dumps(config).encode(), gallery=Gallery(), page=page)
        try:
            self._server = _Server((self.params.address, self.params.port), handler)
        except OSError as error:
            self.node.destroy_node()
            where = f"{self.params.address}:{self.params.port}"
            raise StartError(
                f"the page's port {where} cannot be used: {error.strerror}; "
                "choose another with --port, or port:=NUMBER of ros2"
            ) from error
        self.port = int(self._server.server_address[1])
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), name="http", daemon=True)
        self._thread.start()

    @property
    def greeting(self) -> str:
        """Where to look, for a person."""
        return f"Page: {places('http', self.params.address, self.port, '/')}"

    def turn(self, executor: Executor) -> None:
        """Nothing but parameters to answer."""
        executor.spin_once(timeout_sec=SPIN_SLICE_S)

    def end(self) -> None:
        """Close the port, end the thread."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def close(self) -> None:
        """The same, and destroy the node."""
        self.end()
        self.node.destroy_node()


def main(args: Sequence[str] | None = None) -> int:
    """The executable `web_ui`."""
    return run_main(lambda context: greeted([WebPage(context)]), args)
