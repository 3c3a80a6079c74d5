"""Run commands of the project as if on a system without POSIX and ROS: macOS and Windows are not at hand.

    python -X warn_default_encoding -m tests.other_system COMMANDS.json

The file has a list of commands, each a list of words that begins with `thymio-sim` or `aseba`. What only POSIX or ROS
has is missing for the modules of the project; other packages are those of this system and keep it. A file that the
project opens as text without naming its encoding is an error. Prints a line of JSON with exit codes and the modules
that were imported.
"""

from __future__ import annotations

import asyncio  # noqa: F401  # its modules for this system need what is removed below
import builtins
import json
import multiprocessing  # noqa: F401
import os
import signal
import socket
import subprocess  # noqa: F401
import sys
import warnings
from typing import Any

OURS = ("aseba_vm", "thymio_sim_ros")
MODULES = {
    *("fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty"),
    *("ament_index_python", "launch", "launch_ros", "rclpy", "rcl_interfaces", "std_msgs", "rosgraph_msgs"),
}
"""Modules that are missing on Windows, or without ROS."""
MISSING = {
    os: (
        "fork",
        "forkpty",
        "geteuid",
        "getegid",
        "getuid",
        "killpg",
        "mkfifo",
        "sched_getaffinity",
        "setsid",
        "statvfs",
    ),
    signal: (
        "SIGALRM",
        "SIGCHLD",
        "SIGHUP",
        "SIGKILL",
        "SIGPIPE",
        "SIGPROF",
        "SIGQUIT",
        "SIGSTOP",
        "SIGUSR1",
        "SIGXCPU",
    ),
    socket: ("AF_UNIX",),
}
"""Names that Python does not have on Windows."""


def remove() -> None:
    """Remove what other systems lack."""
    for module, names in MISSING.items():
        for name in names:
            delattr(module, name)
    genuine = builtins.__import__

    def without_posix(name: str, *args: Any, **kwargs: Any) -> Any:
        """Import as `__import__` does, whose arguments these are: globals, locals, fromlist, level."""
        called = dict(zip(("globals", "locals", "fromlist", "level"), args, strict=False)) | kwargs
        importer = str((called.get("globals") or {}).get("__name__", ""))
        is_ours = importer.partition(".")[0] in OURS and called.get("level", 0) == 0
        if is_ours and name.partition(".")[0] in MODULES:
            raise ModuleNotFoundError(f"No module named {name!r}, as on another system", name=name)
        return genuine(name, *args, **kwargs)

    builtins.__import__ = without_posix  # type: ignore[assignment]
    warnings.filterwarnings("error", category=EncodingWarning, module=rf"({'|'.join(OURS)})\b")


def main() -> None:
    """Run the commands."""
    with open(sys.argv[1], encoding="utf-8") as file:
        commands = json.load(file)
    remove()
    from aseba_vm.cli.main import main as aseba
    from thymio_sim_ros.cli.main import main as thymio_sim

    mains = {"aseba": aseba, "thymio-sim": thymio_sim}
    codes = []
    for name, *words in commands:
        try:
            codes.append(mains[name]([os.fsdecode(word.encode()) for word in words]))
        except SystemExit as end:
            codes.append(end.code)
    ours = sorted(name for name in sys.modules if name.partition(".")[0] in OURS)
    print("\n" + json.dumps({"codes": codes, "modules": ours}))


if __name__ == "__main__":
    main()
