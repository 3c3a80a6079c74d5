"""Landlock: rules of the kernel by which a process without rights confines itself (Linux 5.13 and later)."""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Sequence

from thymio_sim_ros.grading.sandbox.linux import syscalls
from thymio_sim_ros.grading.sandbox.readable import DEVICES

__all__ = ["restrict", "version"]

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_VERSION_FLAG, _PATH_BENEATH = 1, 1
_EXECUTE, _READ_FILE, _READ_DIR = 1, 4, 8
_RIGHTS_BY_VERSION = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 5: (1 << 16) - 1}
_OF_FILES = 1 | 2 | 4 | 1 << 14 | 1 << 15
"""Rights that apply to files: execute, write, read, truncate, device controls."""
_NET_TCP = 3
_SCOPE_SOCKETS_AND_SIGNALS = 3


def version() -> int:
    """The version of Landlock of this kernel, 0 if it has none."""
    try:
        return syscalls.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint32(_VERSION_FLAG))
    except OSError:
        return 0


def restrict(readable: Sequence[str], listable: Sequence[str], writable: Sequence[str]) -> None:
    """Allow this process and its descendants to read these paths and to write some folders, and nothing else.

    The names of the files below `listable` can be read, too, as Python does with the folder of a package.
    TCP is forbidden from version 4 on, signals to other processes from version 6 on. `forbid_new_privileges` comes
    first. Raises OSError without Landlock.
    """
    found = version()
    rights = _RIGHTS_BY_VERSION[max((known for known in _RIGHTS_BY_VERSION if known <= found), default=1)]
    network = _NET_TCP if found >= 4 else 0
    scopes = _SCOPE_SOCKETS_AND_SIGNALS if found >= 6 else 0
    attributes = (ctypes.c_uint64 * 3)(rights, network, scopes)
    size = 24 if found >= 6 else 16 if found >= 4 else 8
    rules = syscalls.syscall(_CREATE_RULESET, attributes, ctypes.c_size_t(size), ctypes.c_uint32(0))
    for path in readable:
        _allow(rules, path, (_EXECUTE | _READ_FILE | _READ_DIR) & rights)
    for path in listable:
        _allow(rules, path, _READ_DIR)
    _allow(rules, "/proc", (_READ_FILE | _READ_DIR) & rights)
    for name in DEVICES:
        _allow(rules, f"/dev/{name}", (_READ_FILE | 2) & rights)
    for path in writable:
        _allow(rules, path, rights)
    syscalls.syscall(_RESTRICT_SELF, ctypes.c_int(rules), ctypes.c_uint32(0))
    os.close(rules)


def _allow(rules: int, path: str, rights: int) -> None:
    try:
        opened = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    if not stat.S_ISDIR(os.fstat(opened).st_mode):
        rights &= _OF_FILES
    rule = rights.to_bytes(8, "little") + opened.to_bytes(4, "little")  # packed: no padding
    syscalls.syscall(_ADD_RULE, ctypes.c_int(rules), ctypes.c_int(_PATH_BENEATH), rule, ctypes.c_uint32(0))
    os.close(opened)
