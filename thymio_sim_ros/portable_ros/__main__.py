"""Runs a program on the embedded graph: `python -m thymio_sim_ros.portable_ros [-m MODULE | FILE] [ARGUMENT …]`."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Sequence
from pathlib import Path

from thymio_sim_ros.portable_ros.import_hook import install

_USAGE = "usage: python -m thymio_sim_ros.portable_ros [-m MODULE | FILE] [ARGUMENT ...]"
_WRONG_USAGE = 2


def main(words: Sequence[str] | None = None) -> int:
    """Run the program of the words, by default of the process; return the exit code, unless the program ends it."""
    words = sys.argv[1:] if words is None else list(words)
    if not words or words[0] in ("-h", "--help") or words == ["-m"]:
        print(_USAGE, file=sys.stdout if words[:1] in (["-h"], ["--help"]) else sys.stderr)
        return 0 if words[:1] in (["-h"], ["--help"]) else _WRONG_USAGE
    install(is_forced=True)
    is_module = words[0] == "-m"
    target, arguments = (words[1], words[2:]) if is_module else (words[0], words[1:])
    sys.argv = [target, *arguments]
    if is_module:
        sys.path[0] = str(Path.cwd())
        runpy.run_module(target, run_name="__main__", alter_sys=True)
    else:
        sys.path[0] = str(Path(target).resolve().parent)
        runpy.run_path(target, run_name="__main__")
    return 0


if __name__ == "__main__":
    sys.exit(main())
