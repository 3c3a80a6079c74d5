"""The process that draws one SVG; `svg_process` starts this file as a script, without the rest of the package.

Arguments: the folder that holds `resvg_py`, bytes of memory, and seconds of processor time. Input: the SVG in UTF-8.
Output: the PNG, or, with the exit code `REFUSED`, the reason why there is none. The last word on the error stream is
the processor time it took. It limits itself before it reads anything.
"""

from __future__ import annotations

import sys
import time

__all__ = ["CSS_DPI", "REFUSED"]

REFUSED = 3
CSS_DPI = 96.0
"""Resolution that defines a millimeter in an SVG; only proportions matter here."""


def _limit(memory: int, seconds: int) -> None:
    """Limit time and memory of this process where the system can: not on Windows, and memory hardly on macOS."""
    try:
        import resource
    except ImportError:
        return
    wanted = (("RLIMIT_CPU", seconds), ("RLIMIT_AS", memory), ("RLIMIT_CORE", 0), ("RLIMIT_FSIZE", 0))
    for name, most in wanted:
        try:
            number = getattr(resource, name)
            hard = resource.getrlimit(number)[1]
            most = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(number, (most, most))
        except (AttributeError, ValueError, OSError):
            continue


def _main(folder: str, memory: str, seconds: str) -> int:
    _limit(int(memory), int(seconds))
    sys.path.append(folder)
    import resvg_py

    try:
        drawn = resvg_py.svg_to_bytes(
            svg_string=sys.stdin.buffer.read().decode("utf-8"), dpi=CSS_DPI, skip_system_fonts=True
        )
    except ValueError as error:
        sys.stdout.buffer.write(" ".join(str(error).split())[:200].encode("utf-8", "replace"))
        return REFUSED
    sys.stdout.buffer.write(drawn)
    print(time.process_time(), file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))
