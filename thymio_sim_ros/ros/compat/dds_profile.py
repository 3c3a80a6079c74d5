"""The Fast DDS profile of nodes that run alone in a process.

By default Fast DDS compares every endpoint with all others of its process and allocates memory for a hundred messages
of each: a hundred robots took 19 s of CPU time and 770 MB. With `alone.xml` the endpoints of a process do not match
each other, which is correct for a node that does not subscribe to its own topics, and memory is allocated on demand:
3.4 s and 450 MB (measured, docs/performance-method.md). Other DDS implementations do not read the file, and a profile
of the user has priority.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, MutableMapping
from contextlib import contextmanager
from pathlib import Path

__all__ = ["PROFILE", "VARIABLE", "alone"]

PROFILE = Path(__file__).with_name("alone.xml")

VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
"""Variable with the path of the profile; Fast DDS 2 reads it when the process creates its first participant."""

_OTHERS = ("FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML")
"""Environment variables of users with their own profiles."""

_USERS_FILE = "DEFAULT_FASTRTPS_PROFILES.xml"
"""Fast DDS reads this file in the working folder without being asked to."""


@contextmanager
def alone(environment: MutableMapping[str, str] = os.environ) -> Iterator[None]:
    """Use the profile for participants that are created inside the block, unless the user has one."""
    if any(name in environment for name in (VARIABLE, *_OTHERS)) or Path(_USERS_FILE).exists():
        yield
        return
    environment[VARIABLE] = str(PROFILE)
    try:
        yield
    finally:
        del environment[VARIABLE]
