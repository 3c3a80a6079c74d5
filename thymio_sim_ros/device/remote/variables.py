"""Variables of a remote robot by name: those that were polled last."""

from __future__ import annotations

from collections.abc import Sequence

from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.remote.session import Session
from thymio_sim_ros.device.variables import INT16

__all__ = ["RemoteVariables"]


class RemoteVariables:
    """The variables of the robot and of its program. Variables that were never read are 0."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def addresses(self) -> dict[str, tuple[int, int]]:
        """Address and size in words of every variable, including those of the program."""
        own = self._session.program.own
        return {**target(own.layout).addresses, **own.program.addresses}

    def words(self) -> list[int]:
        """Words (int16) of all variables in order of address."""
        places = sorted(self.addresses().items(), key=lambda item: item[1])
        return [word for name, _ in places for word in self.get(name)]

    def get(self, name: str) -> tuple[int, ...]:
        """Words (int16) of a variable. Raises KeyError for an unknown name."""
        _, size = self.addresses()[name]
        return self._session.value(name) or (0,) * size

    def set(self, name: str, words: Sequence[int]) -> None:
        """Write a whole variable. Raises KeyError for an unknown name, ValueError for a wrong size or value."""
        _, size = self.addresses()[name]
        if len(words) != size:
            raise ValueError(f"{name}: {len(words)} words found, expected {size}")
        wrong = [word for word in words if word not in INT16]
        if wrong:
            raise ValueError(f"{name}: {wrong[0]} found, expected -32768 to 32767")
        if self._session.node is None:
            raise ValueError(f"{name}: the robot is not connected ({self._session.problem})")
        self._session.write(name, words)
