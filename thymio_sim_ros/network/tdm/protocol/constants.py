"""Numbers of the protocol of the Thymio Device Manager (docs/spec/aseba-protocol.md section 2.2, "Enums")."""

from __future__ import annotations

from enum import IntEnum, IntFlag

__all__ = [
    "Capability",
    "Command",
    "CompileOption",
    "ErrorCode",
    "Language",
    "NodeType",
    "Status",
    "VMError",
    "VMState",
    "Watch",
]


class NodeType(IntEnum):
    """Kinds of nodes."""

    THYMIO = 0
    WIRELESS_THYMIO = 1
    SIMULATED_THYMIO = 2
    DUMMY = 3
    UNKNOWN = 4


class Status(IntEnum):
    """Whether a client may use a node."""

    UNKNOWN = 0
    CONNECTED = 1
    AVAILABLE = 2
    BUSY = 3
    READY = 4
    DISCONNECTED = 5


class Capability(IntFlag):
    """Actions that a client may perform on a node."""

    RENAME = 1
    FORCE_RESET_AND_STOP = 2
    FIRMWARE_UPGRADE = 4


class ErrorCode(IntEnum):
    """Why a request is rejected."""

    NONE = 0
    UNKNOWN = 1
    UNKNOWN_NODE = 2
    NODE_BUSY = 3
    UNSUPPORTED_VARIABLE_TYPE = 4


class Watch(IntFlag):
    """Kinds of data about a node and its group that a client receives."""

    NONE = 0
    VARIABLES = 1
    EVENTS = 2
    VM_STATE = 4
    SHARED_EVENTS = 8
    SHARED_VARIABLES = 16
    SCRATCHPADS = 32
    OF_NODE = VARIABLES | EVENTS | VM_STATE
    OF_GROUP = SHARED_EVENTS | SHARED_VARIABLES | SCRATCHPADS


class Language(IntEnum):
    """Forms of a program: the text for one node, or a whole file."""

    ASEBA = 1
    AESL = 2


class CompileOption(IntFlag):
    """Uses of a compiled program."""

    NONE = 1
    LOAD_ON_TARGET = 2
    FETCH_BYTECODE = 4


class Command(IntEnum):
    """Commands to the machine of a node."""

    STOP = 0
    RUN = 1
    STEP = 2
    STEP_TO_NEXT_LINE = 3
    PAUSE = 4
    RESET = 5
    REBOOT = 6
    SUSPEND = 7
    WRITE_PROGRAM_TO_DEVICE = 8


class VMState(IntEnum):
    """States of the machine of a node."""

    STOPPED = 0
    RUNNING = 1
    PAUSED = 2


class VMError(IntEnum):
    """Why the machine of a node stopped."""

    NONE = 0
    KILLED = 1
    OUT_OF_BOUNDS = 2
    DIVISION_BY_ZERO = 3
    GENERIC = 4
