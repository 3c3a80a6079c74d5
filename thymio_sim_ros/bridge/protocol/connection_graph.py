"""The connection graph as a value: which nodes publish, subscribe to and serve what."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.bridge.protocol.messages import (
    AdvertisedService,
    ConnectionGraphUpdate,
    PublishedTopic,
    SubscribedTopic,
)

Names = Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class ConnectionGraph:
    """Topic or service → sorted node names (/ns/node). Names without nodes are left out."""

    published: Names = field(default_factory=dict)
    subscribed: Names = field(default_factory=dict)
    services: Names = field(default_factory=dict)

    def since(self, earlier: ConnectionGraph) -> ConnectionGraphUpdate | None:
        """The difference from an `earlier` graph as a message, or None if they are equal."""
        topics = self.published.keys() | self.subscribed.keys()
        update = ConnectionGraphUpdate(
            tuple(PublishedTopic(*item) for item in _changed(earlier.published, self.published, topics)),
            tuple(SubscribedTopic(*item) for item in _changed(earlier.subscribed, self.subscribed, topics)),
            tuple(AdvertisedService(*item) for item in _changed(earlier.services, self.services, self.services.keys())),
            tuple(sorted((earlier.published.keys() | earlier.subscribed.keys()) - topics)),
            tuple(sorted(earlier.services.keys() - self.services.keys())),
        )
        return None if update == ConnectionGraphUpdate() else update


def _changed(before: Names, after: Names, alive: Collection[str]) -> list[tuple[str, tuple[str, ...]]]:
    """Names whose nodes differ, with their nodes now; no nodes for a name in `alive` that lost its last one."""
    names = sorted(name for name in before.keys() | after.keys() if before.get(name, ()) != after.get(name, ()))
    return [(name, after.get(name, ())) for name in names if name in alive]
