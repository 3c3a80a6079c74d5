"""The Fast DDS profiles of this package's processes. A profile of the user has priority, and so has another RMW.

`ANNOUNCING`: every participant announces itself every 250 ms instead of every 3 s. A starting participant of Fast DDS 2
announces itself before it reads its sockets, and so loses the answers of quick peers. A peer answers once; the new
participant then discovers it by its next regular announcement (measured: some starts took 3 s longer, at load most).

`ALONE`: also, the endpoints of one participant do not match each other, and memory for messages is allocated on demand.
By default Fast DDS compares every endpoint with all others of its participant and allocates memory for a hundred
messages of each: the suite with a hundred robots took 153 s of processor time to start, and takes 11 s with this
profile (docs/performance-method.md). Nodes that need each other's topics then need `rclpy_ext/peers.py`.

`LOOPBACK`: as `ANNOUNCING`, but messages go by UDP on 127.0.0.1 only. Where shared memory is closed, Fast DDS prints
errors to standard output, among the lines of the program. With the discovery range LOCALHOST, rmw_fastrtps adds shared
memory whatever FASTDDS_BUILTIN_TRANSPORTS and profiles say, so that this profile has the peers of that range itself.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, MutableMapping
from contextlib import contextmanager
from pathlib import Path

from rclpy.utilities import get_rmw_implementation_identifier

__all__ = ["ALONE", "ANNOUNCING", "LOOPBACK", "VARIABLE", "for_this_machine", "has_own_profile", "used"]

ALONE, ANNOUNCING, LOOPBACK = (Path(__file__).with_name(f"{name}.xml") for name in ("alone", "announcing", "loopback"))

VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
"""Variable with the path of the profile; Fast DDS 2 reads it when the process creates its first participant."""

_OTHERS = ("FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML")
"""Environment variables of users with their own profiles."""

_USERS_FILE = "DEFAULT_FASTRTPS_PROFILES.xml"
"""Fast DDS reads this file in the working folder without being asked to."""

_RMW = "rmw_fastrtps_cpp"


def has_own_profile(environment: MutableMapping[str, str] = os.environ) -> bool:
    """Whether the user has a profile; `ANNOUNCING`, which `thymio-sim env` sets for other processes, is none."""
    if any(name in environment for name in _OTHERS) or Path(_USERS_FILE).exists():
        return True
    return environment.get(VARIABLE, str(ANNOUNCING)) != str(ANNOUNCING)


def for_this_machine(*, shared_memory: bool) -> dict[str, str]:
    """Return the environment of participants whose messages stay on this machine, with or without shared memory."""
    if shared_memory or get_rmw_implementation_identifier() != _RMW:
        return {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    return {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT", VARIABLE: str(LOOPBACK)}


@contextmanager
def used(profile: Path, environment: MutableMapping[str, str] = os.environ) -> Iterator[bool]:
    """Use a profile for the participants of this process, unless the user has one; yield whether it is used.

    The first participant must be created inside the block.
    """
    if has_own_profile(environment) or get_rmw_implementation_identifier() != _RMW:
        yield False
        return
    before = environment.get(VARIABLE)
    environment[VARIABLE] = str(profile)
    try:
        yield True
    finally:
        if before is None:
            del environment[VARIABLE]
        else:
            environment[VARIABLE] = before
