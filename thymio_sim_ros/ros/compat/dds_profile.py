"""What Fast DDS is told where one of our nodes has a process to itself.

Every endpoint is compared with all others of its process, and room for a hundred messages is set aside for each: a
hundred robots took 19 s of CPU and 770 MB. `alone.xml` says that endpoints of this process never meet each other, which
is true of a node that listens to nothing of its own, and that room grows when it is needed: 3.4 s and 450 MB (measured,
docs/performance.md). Other DDS implementations do not read it, and a profile of the user's goes first.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, MutableMapping
from contextlib import contextmanager
from pathlib import Path

__all__ = ["PROFILE", "VARIABLE", "alone"]

PROFILE = Path(__file__).with_name("alone.xml")

VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
"""Where Fast DDS 2 looks for profiles, once, when the process makes its first participant."""

_OTHERS = ("FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML")
"""Users who set these have their own profiles."""

_USERS_FILE = "DEFAULT_FASTRTPS_PROFILES.xml"
"""In the working folder it is read without being named."""


@contextmanager
def alone(environment: MutableMapping[str, str] = os.environ) -> Iterator[None]:
    """Participants that are made meanwhile have our profile, unless the user has one."""
    if any(name in environment for name in (VARIABLE, *_OTHERS)) or Path(_USERS_FILE).exists():
        yield
        return
    environment[VARIABLE] = str(PROFILE)
    try:
        yield
    finally:
        del environment[VARIABLE]
