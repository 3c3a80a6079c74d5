"""A file system, process table and network of its own, by Linux namespaces.

The new root is a small file system in memory. It has the system's files, read-only, and one writable folder. The
network has the loopback device only.
"""

from __future__ import annotations

import fcntl
import os
import socket
import struct
from collections.abc import Callable
from pathlib import Path

from thymio_sim_ros.grading.assignment import MAX_FILES
from thymio_sim_ros.grading.sandbox.linux import syscalls
from thymio_sim_ros.grading.sandbox.readable import DEVICES, readable_paths

__all__ = ["FOLDER", "bind_read_only", "run_inside", "start_loopback"]

FOLDER = "/grade"
"""The writable folder of the sandbox."""

_NEW_ROOT = "/tmp"
"""A folder that exists; the sandbox's root is mounted there, for its own processes only."""
_OLD_ROOT = ".host"
_NAMESPACES = (
    syscalls.CLONE_NEWNS | syscalls.CLONE_NEWPID | syscalls.CLONE_NEWNET | syscalls.CLONE_NEWIPC | syscalls.CLONE_NEWUTS
)
_SIOCGIFFLAGS, _SIOCSIFFLAGS, _IFF_UP = 0x8913, 0x8914, 1
_CANNOT_ENTER = 3


def run_inside(disk_bytes: int, work: Callable[[], None]) -> int:
    """Run a function as the first process of new namespaces; return its exit code. Raises OSError if there are none.

    When that process ends, the kernel ends all others of the sandbox. Without the rights of root, the namespaces
    belong to a user namespace, in which the user has them.
    """
    user, group = os.geteuid(), os.getegid()
    if user == 0:
        syscalls.unshare(_NAMESPACES)
    else:
        syscalls.unshare(_NAMESPACES | syscalls.CLONE_NEWUSER)
        _write("/proc/self/setgroups", "deny")
        _write("/proc/self/uid_map", f"{user} {user} 1")
        _write("/proc/self/gid_map", f"{group} {group} 1")
    readable = readable_paths()  # before the fork: it reads the file system of the host
    first = os.fork()
    if first == 0:
        try:
            syscalls.die_with_parent()
            _build_root(disk_bytes, readable)
            start_loopback()
            work()
            os._exit(0)
        except BaseException:
            import traceback

            traceback.print_exc()
            os._exit(_CANNOT_ENTER)
    return os.waitstatus_to_exitcode(os.waitpid(first, 0)[1])


def start_loopback() -> None:
    """Switch the loopback device on: nodes of one submission talk to each other."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        request = struct.pack("16sh14x", b"lo", 0)
        flags = struct.unpack("16sh14x", fcntl.ioctl(any_socket, _SIOCGIFFLAGS, request))[1]
        fcntl.ioctl(any_socket, _SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", flags | _IFF_UP))


def bind_read_only(source: Path, target: Path) -> None:
    """Show a file or folder of the sandbox at another place of it, or at the same, where no process can change it."""
    syscalls.mount(str(source), str(target), flags=syscalls.MS_BIND)
    _make_read_only(str(source), str(target))


def _build_root(disk_bytes: int, readable: list[str]) -> None:
    syscalls.mount("none", "/", flags=syscalls.MS_REC | syscalls.MS_PRIVATE)
    # Bind mounts are made from the old root, before anything is mounted over its folders.
    options = f"size={disk_bytes},nr_inodes={MAX_FILES},mode=755"
    os.chdir("/")
    syscalls.mount("tmpfs", _NEW_ROOT, "tmpfs", syscalls.MS_NOSUID | syscalls.MS_NODEV, options)
    os.mkdir(f"{_NEW_ROOT}/{_OLD_ROOT}")
    syscalls.pivot_root(_NEW_ROOT, f"{_NEW_ROOT}/{_OLD_ROOT}")
    os.chdir("/")
    host = f"/{_OLD_ROOT}"
    for path in readable:
        _bind(f"{host}{path}", path)
    os.mkdir("/dev")
    for name in DEVICES:
        _bind(f"{host}/dev/{name}", f"/dev/{name}", read_only=False)
    for name, target in {"fd": "/proc/self/fd", "stdin": "fd/0", "stdout": "fd/1", "stderr": "fd/2"}.items():
        os.symlink(target, f"/dev/{name}")
    os.mkdir("/proc")
    syscalls.mount("proc", "/proc", "proc", syscalls.MS_NOSUID | syscalls.MS_NODEV)
    syscalls.umount(host)
    os.rmdir(host)
    for path in ("/tmp", "/dev/shm"):
        os.makedirs(path, exist_ok=True)
        os.chmod(path, 0o1777)
    os.mkdir(FOLDER)


def _bind(source: str, target: str, *, read_only: bool = True) -> None:
    if os.path.islink(source) and not _is_needed_as_folder(source):
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.symlink(os.readlink(source), target)
        return
    source = _without_links(source)
    if os.path.isdir(source):
        os.makedirs(target, exist_ok=True)
    else:
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.close(os.open(target, os.O_CREAT | os.O_WRONLY, 0o644))
    syscalls.mount(source, target, flags=syscalls.MS_BIND | syscalls.MS_REC)
    if read_only:
        _make_read_only(source, target)


def _make_read_only(source: str, target: str) -> None:
    flags = syscalls.MS_BIND | syscalls.MS_REMOUNT | syscalls.MS_RDONLY | syscalls.MS_NOSUID | _locked(target)
    syscalls.mount(source, target, flags=flags)


def _is_needed_as_folder(path: str) -> bool:
    """Whether a link is not one of the system's own, such as /bin → usr/bin, but an environment elsewhere."""
    return not _relative(os.readlink(path))


def _relative(link: str) -> bool:
    return not link.startswith("/") and ".." not in link.split("/")


def _without_links(source: str) -> str:
    """The real path of a file of the host, whose root is `/.host` now."""
    host = f"/{_OLD_ROOT}"
    while os.path.islink(source):
        link = os.readlink(source)
        source = host + link if link.startswith("/") else os.path.join(os.path.dirname(source), link)
    return source


def _locked(path: str) -> int:
    """Flags of a mount that a user namespace may not remove."""
    found = os.statvfs(path).f_flag
    flags = {os.ST_NODEV: syscalls.MS_NODEV, os.ST_NOEXEC: 8, os.ST_NOATIME: 1024, os.ST_RELATIME: 1 << 21}
    return sum(flag for bit, flag in flags.items() if found & bit)


def _write(path: str, text: str) -> None:
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
