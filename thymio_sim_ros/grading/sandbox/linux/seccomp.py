"""A filter of system calls: refuses those that no test needs and that widen what the kernel exposes.

It also refuses memory that belongs to no file and to no process alone (memfd, System V, shared anonymous mappings):
such memory stays when a process unmaps it, and no measurement of processes finds it.
"""

from __future__ import annotations

import ctypes
import errno
import platform
import struct

from thymio_sim_ros.grading.sandbox.linux import syscalls

__all__ = ["restrict"]

_ARCHITECTURES = {"x86_64": 0xC000_003E, "aarch64": 0xC000_00B7}
_REFUSED = {
    # ptrace, mount, umount2, pivot_root, setns, unshare, bpf, perf_event_open, userfaultfd, process_vm_*, keys, kexec,
    # kcmp, io_uring_*, new mount calls, pidfd_getfd
    "x86_64": (101, 165, 166, 155, 308, 272, 321, 298, 323, 310, 311, 248, 249, 250, 246, 320, 312, 425, 426, 427,
               428, 429, 430, 431, 432, 433, 438, 442),
    "aarch64": (117, 40, 39, 41, 268, 97, 280, 241, 282, 270, 271, 217, 218, 219, 104, 294, 272, 425, 426, 427,
                428, 429, 430, 431, 432, 433, 438, 442),
}  # fmt: skip
_SHARED_MEMORY = {"x86_64": (319, 447, 29), "aarch64": (279, 447, 194)}
"""memfd_create, memfd_secret, shmget."""
_MMAP = {"x86_64": 9, "aarch64": 222}
_SHARED, _ANONYMOUS = 0x01, 0x20
_CLONE = {"x86_64": 56, "aarch64": 220}
_CLONE3 = 435
_LOAD, _EQUAL, _GREATER_OR_EQUAL, _HAS_BITS, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_ALLOW, _REFUSE = 0x7FFF_0000, 0x0005_0000
_NUMBER, _ARCHITECTURE, _ARGUMENT, _MMAP_FLAGS = 0, 4, 16, 40
_NEW_NAMESPACES = 0x7E02_0000
_X32 = 0x4000_0000


def restrict() -> None:
    """Install the filter in this process and its descendants, where its system calls are known."""
    machine = platform.machine()
    if machine not in _REFUSED:
        return
    refused = _RETURN, 0, 0, _REFUSE | errno.EPERM
    no_memory = _RETURN, 0, 0, _REFUSE | errno.ENOMEM
    allowed = _RETURN, 0, 0, _ALLOW
    program = [(_LOAD, 0, 0, _ARCHITECTURE), (_EQUAL, 1, 0, _ARCHITECTURES[machine]), refused, (_LOAD, 0, 0, _NUMBER)]
    program += [(_GREATER_OR_EQUAL, 0, 1, _X32), refused]
    for number in _REFUSED[machine]:
        program += [(_EQUAL, 0, 1, number), refused]
    for number in _SHARED_MEMORY[machine]:
        program += [(_EQUAL, 0, 1, number), no_memory]
    program += [(_EQUAL, 0, 5, _MMAP[machine]), (_LOAD, 0, 0, _MMAP_FLAGS)]
    program += [(_HAS_BITS, 0, 2, _ANONYMOUS), (_HAS_BITS, 0, 1, _SHARED), no_memory, allowed]
    # glibc falls back to clone, whose flags a filter can read
    program += [(_EQUAL, 0, 1, _CLONE3), (_RETURN, 0, 0, _REFUSE | errno.ENOSYS)]
    program += [(_EQUAL, 0, 3, _CLONE[machine]), (_LOAD, 0, 0, _ARGUMENT), (_HAS_BITS, 0, 1, _NEW_NAMESPACES), refused]
    program.append(allowed)
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *line) for line in program))
    filter_program = struct.pack("HxxxxxxQ", len(program), ctypes.addressof(code))
    syscalls.set_filter(filter_program)
