"""The documents of the page's server, by the path of the request.

Each document is read and compressed once for each version of its file. Thread-safe.
"""

from __future__ import annotations

import functools
import gzip
import hashlib
import re
import urllib.parse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from thymio_sim_ros.files.playground_index import PlaygroundIndex
from thymio_sim_ros.sim.playground import declarations
from thymio_sim_ros.sim.shapes import all_shapes

__all__ = ["TYPES", "Content", "Document", "FindMore"]

FindMore = Callable[[Sequence[str]], tuple[bytes, str] | None]
"""Body and ending of a document by the folder and name of its path; None if there is none."""

# Not the table of the platform: it may have other types, and browsers reject a module with a wrong type.
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".gif": "image/gif",
    ".cur": "image/x-icon",
    ".ico": "image/x-icon",
    ".webmanifest": "application/manifest+json",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
    ".mp3": "audio/mpeg",
}
_UNKNOWN_TYPE = "application/octet-stream"
_COMPRESSED = frozenset({".html", ".css", ".js", ".mjs", ".json", ".svg", ".wasm"})
_HASHED = re.compile(r".+-[\w-]{8}\.\w+")
"""Names of files with a hash of their content, which therefore never changes."""
_INDEX = "index.html"
_PLAYGROUNDS, _PLAYGROUND_ENDING = "playgrounds", ".json"


@dataclass(frozen=True, slots=True)
class Document:
    """The body of an answer; `compressed` is the body in gzip, None if not smaller; `tag` is a hash of the body."""

    body: bytes
    media_type: str
    compressed: bytes | None
    tag: str
    is_immutable: bool = False


class Content:
    """The built page in a folder, the shipped playgrounds as `/playgrounds/NAME.json`, and two documents of its own.

    `/config.json` is given, `/shapes.json` declares the installed shapes; further documents come from `find_more`.
    """

    def __init__(self, folder: Path | None, config: bytes, find_more: FindMore = lambda names: None) -> None:
        """`folder` has the built page, None if it has not been built; `config` is the JSON text of `/config.json`."""
        self._find_more = find_more
        self._more: dict[tuple[str, ...], Document] = {}
        self._folder = None if folder is None else folder.resolve()
        self._config = _document(config, ".json")
        self._index = PlaygroundIndex()
        self._files: dict[Path, tuple[tuple[int, int], Document]] = {}
        self._playgrounds: dict[str, tuple[bytes, Document]] = {}

    @property
    def is_built(self) -> bool:
        """Whether the page has been built."""
        return self._folder is not None

    def find(self, path: str) -> Document | None:
        """The document of a request path, which still has its escapes; None if there is none.

        Raises PlaygroundError for a shipped playground that cannot be read.
        """
        names = _names(path)
        if names is None:
            return None
        if names == ("config.json",):
            return self._config
        if names == ("shapes.json",):
            return self._shapes
        if len(names) == 2 and names[0] == _PLAYGROUNDS and names[1].endswith(_PLAYGROUND_ENDING):
            return self._playground(names[1].removesuffix(_PLAYGROUND_ENDING))
        return self._file(names or (_INDEX,)) or self._further(names)

    def _further(self, names: tuple[str, ...]) -> Document | None:
        found = self._find_more(names)
        if found is None:
            return None
        body, ending = found
        known = self._more.get(names)
        if known is None or known.body != body:
            known = self._more[names] = _document(body, ending)
        return known

    @functools.cached_property
    def _shapes(self) -> Document:
        """The declarations of the installed shapes, with those of plug-ins."""
        return _document(declarations.as_json(all_shapes()).encode(), ".json")

    def _playground(self, name: str) -> Document | None:
        text = self._index.text(name)
        if text is None:
            return None
        known = self._playgrounds.get(name)
        if known is None or known[0] is not text:
            known = self._playgrounds[name] = (text, _document(text, _PLAYGROUND_ENDING))
        return known[1]

    def _file(self, names: tuple[str, ...]) -> Document | None:
        if self._folder is None:
            return None
        path = self._folder.joinpath(*names)
        try:
            real = path.resolve(strict=True)
            # Links out of the folder are followed only to a file of the same relative path: colcon's --symlink-install
            # creates such links.
            if not real.is_relative_to(self._folder) and real.parts[-len(names) :] != names:
                return None
            status = real.stat()
            if not real.is_file():
                return None
            version = (status.st_mtime_ns, status.st_size)
            known = self._files.get(path)
            if known is None or known[0] != version:
                is_hashed = len(names) > 1 and _HASHED.fullmatch(names[-1]) is not None
                document = _document(real.read_bytes(), path.suffix, is_immutable=is_hashed)
                known = self._files[path] = (version, document)
        except (OSError, ValueError):  # not a possible name of a file, or not readable
            return None
        return known[1]


def _names(path: str) -> tuple[str, ...] | None:
    """Folders and file of a path, without escapes; None if the path is not inside the folder of the page."""
    if not path.startswith("/"):
        return None
    if path == "/":
        return ()
    names = tuple(urllib.parse.unquote(name) for name in path[1:].split("/"))
    if any(name in ("", ".", "..") or not {"/", "\\", "\0"}.isdisjoint(name) for name in names):
        return None
    return names


def _document(body: bytes, ending: str, *, is_immutable: bool = False) -> Document:
    compressed = gzip.compress(body, mtime=0) if ending in _COMPRESSED else None
    if compressed is not None and len(compressed) >= len(body):
        compressed = None
    tag = hashlib.sha256(body).hexdigest()[:24]
    return Document(body, TYPES.get(ending, _UNKNOWN_TYPE), compressed, tag, is_immutable)
