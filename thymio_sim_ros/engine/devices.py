"""The devices of some robots: which of them run, for how long, and who receives their events.

All devices share one Aseba bus; an event is not sent back to its sender. The budget of a tick is for all devices
together, so that programs without an end, on however many robots, leave time for the world.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.sim.commands import Command

__all__ = ["BUDGET", "MAX_ROUNDS", "TICK_BUDGET", "Devices"]

BUDGET = 5000
"""Instructions of a device per round of a tick; a longer handler continues in the next."""

MAX_ROUNDS = 10
"""Rounds per tick in which robots may react to events of others; the rest continues in the next tick."""

TICK_BUDGET = 4 * BUDGET
"""Instructions of all devices per tick, in equal parts for those that need them."""


class Devices:
    """Runs the devices of robots, in the order in which these were added.

    `emitted` has the events of the last run as (robot, event), in order.
    """

    def __init__(self, on_program: Callable[[], None]) -> None:
        """`on_program` is called when a robot has changed its own program, as the menu does."""
        self._on_program = on_program
        self.hosts: dict[str, BehaviorHost] = {}
        """The host of each robot, also of those that are not in the world."""
        self.emitted: list[tuple[str, EmittedEvent]] = []
        self.present: Mapping[str, AsebaDevice] = {}
        """The devices that run: those of the robots that are in the world."""

    def is_due(self, now_ns: int) -> bool:
        """Whether a device has work at this time."""
        return any(device.due.ns <= now_ns for device in self.present.values())

    def run(self, now_ns: int) -> list[tuple[str, Command]]:
        """Run the devices that are due, and those that receive their events; return their commands, by robot.

        Devices whose budget is used up are still due, and keep their commands.
        """
        self.emitted.clear()
        due: list[tuple[str, AsebaDevice]] = []
        advanced: set[str] = set()
        budget = TICK_BUDGET
        for _ in range(MAX_ROUNDS):
            due = [(name, device) for name, device in self.present.items() if device.due.ns <= now_ns]
            if not due:
                return []
            for at, (name, device) in enumerate(due):
                if name not in advanced:
                    advanced.add(name)
                    device.advance(now_ns)
                budget -= device.run(min(BUDGET, max(1, budget // (len(due) - at))))
            senders = [name for name, device in due if device.has_emitted]
            if sum(self._forward_events(name) for name in senders) == 0:
                break
        return [(name, command) for name, device in due for command in device.pop_commands()]

    def _forward_events(self, name: str) -> int:
        """Forward the emitted events of a device, or change its program; return how many devices have new work."""
        sender = self.hosts[name]
        running = sender.program
        events = sender.pop_events()
        woken = int(sender.program is not running)
        if woken:
            self._on_program()
        for event in events:
            self.emitted.append((name, event))
            for device in self.present.values():
                if device is not sender.device and device.receives_from(sender.device) and device.declares(event.name):
                    device.receive_event(event.name, event.args, source=sender.device.node_id)
                    woken += 1
        return woken
