"""Runs a program on the embedded graph: `python -m thymio_sim_ros.portable_ros [-m MODULE | FILE] [ARGUMENT …]`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from thymio_sim_ros import course_packages
from thymio_sim_ros.portable_ros.import_hook import install
from thymio_sim_ros.portable_ros.program import run_program

_USAGE = "usage: python -m thymio_sim_ros.portable_ros [-m MODULE | FILE] [ARGUMENT ...]"
_WRONG_USAGE = 2


def main(words: Sequence[str] | None = None) -> int:
    """Run the program of the words, by default of the process; return the exit code, unless the program ends it."""
    words = sys.argv[1:] if words is None else list(words)
    if not words or words[0] in ("-h", "--help") or words == ["-m"]:
        print(_USAGE, file=sys.stdout if words[:1] in (["-h"], ["--help"]) else sys.stderr)
        return 0 if words[:1] in (["-h"], ["--help"]) else _WRONG_USAGE
    install(is_forced=True)
    course_packages.add_to_path()
    is_module = words[0] == "-m"
    target, arguments = (words[1], words[2:]) if is_module else (words[0], words[1:])
    return run_program(target, arguments, is_module=is_module)


if __name__ == "__main__":
    sys.exit(main())
