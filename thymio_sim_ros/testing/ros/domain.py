"""Reserves an unused ROS domain for the time of a test."""

from __future__ import annotations

import contextlib
import itertools
import os
import socket
from collections.abc import Iterator

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.portable_ros.graph.graph import forget_graph
from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.compat.shm_cleanup import remove_abandoned

__all__ = ["NoDomainError", "reserved"]

DOMAINS = range(1, 101)
"""Domain ids whose ports are below the ephemeral ones, but for the default domain.

Source: docs/spec/ros-packaging.md section 4.
"""

DISCOVERY_PORT = 7400
PORTS_PER_DOMAIN = 250
RESERVATION_PORT = 2
"""UDP port of a domain that DDS leaves unused. Who is bound to it on loopback has reserved the domain.

UDP, because sandboxes may refuse TCP.
"""
PARTICIPANT_PORTS = (0, *range(10, 32, 2))
"""UDP ports of a domain: discovery by multicast, then its first participants'.

Source: docs/spec/ros-packaging.md section 4.
"""

_turns = itertools.count(os.getpid())


class NoDomainError(ThymioSimError):
    """All domains of this machine are in use."""


@contextlib.contextmanager
def reserved(*, shared_memory: bool = True) -> Iterator[int]:
    """Reserve a domain, another one each time. Child processes inherit it, and messages stay on this machine.

    On the embedded graph, a domain is one of this process, and empty. With an installed ROS, messages go by UDP only
    without `shared_memory`, and the domain of the user's own environment is not used. Raises NoDomainError if all
    domains are in use.
    """
    if is_served("rclpy"):
        domain = DOMAINS[next(_turns) % len(DOMAINS)]
        forget_graph(domain)
        with _environment(ROS_DOMAIN_ID=str(domain)):
            yield domain
        return
    own = os.environ.get("ROS_DOMAIN_ID", "0")
    free = [domain for domain in DOMAINS if str(domain) != own]
    begin = next(_turns)
    for turn in range(len(free)):
        domain = free[(begin + turn) % len(free)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as held:
            try:
                held.bind(("127.0.0.1", _port(domain, RESERVATION_PORT)))
            except OSError:
                continue
            if _has_participants(domain):
                continue
            remove_abandoned()
            with _environment(ROS_DOMAIN_ID=str(domain), **dds_profile.for_this_machine(shared_memory=shared_memory)):
                yield domain
            return
    raise NoDomainError(f"no free ROS domain on this machine: {len(free)} are in use")


def _has_participants(domain: int) -> bool:
    """Whether a process uses the domain without a reservation."""
    return not all(_is_free(_port(domain, port)) for port in PARTICIPANT_PORTS)


def _port(domain: int, number: int) -> int:
    return DISCOVERY_PORT + PORTS_PER_DOMAIN * domain + number


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True


@contextlib.contextmanager
def _environment(**values: str) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
