"""Differences of connection graphs."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph, Names
from thymio_sim_ros.bridge.protocol.messages import (
    AdvertisedService,
    ConnectionGraphUpdate,
    PublishedTopic,
    SubscribedTopic,
)

EMPTY = ConnectionGraph()


def test_the_first_update_is_complete() -> None:
    graph = ConnectionGraph({"/a": ("/n",)}, {"/a": ("/m",), "/b": ("/m",)}, {"/s": ("/n",)})
    assert graph.since(EMPTY) == ConnectionGraphUpdate(
        (PublishedTopic("/a", ("/n",)),),
        (SubscribedTopic("/a", ("/m",)), SubscribedTopic("/b", ("/m",))),
        (AdvertisedService("/s", ("/n",)),),
    )


def test_equal_graphs_give_no_update() -> None:
    graph = ConnectionGraph({"/a": ("/n",)})
    assert graph.since(ConnectionGraph({"/a": ("/n",)})) is None


def test_a_topic_without_nodes_is_removed() -> None:
    update = EMPTY.since(ConnectionGraph({"/a": ("/n",)}, {"/a": ("/m",)}, {"/s": ("/n",)}))
    assert update == ConnectionGraphUpdate(removed_topics=("/a",), removed_services=("/s",))


def test_a_topic_that_keeps_its_subscribers_is_sent_without_publishers() -> None:
    before = ConnectionGraph({"/a": ("/n",)}, {"/a": ("/m",)})
    update = ConnectionGraph({}, {"/a": ("/m",)}).since(before)
    assert update == ConnectionGraphUpdate(published_topics=(PublishedTopic("/a", ()),))


NAMES = st.dictionaries(
    st.sampled_from(["/a", "/b", "/c"]),
    st.lists(st.sampled_from("xyz"), min_size=1, unique=True).map(sorted).map(tuple),
)
GRAPHS = st.builds(ConnectionGraph, NAMES, NAMES, NAMES)


@given(GRAPHS, GRAPHS)
def test_a_client_that_follows_the_updates_knows_the_graph(before: ConnectionGraph, after: ConnectionGraph) -> None:
    update = after.since(before) or ConnectionGraphUpdate()
    assert ConnectionGraph(
        _follow(before.published, [(t.name, t.publisher_ids) for t in update.published_topics], update.removed_topics),
        _follow(
            before.subscribed, [(t.name, t.subscriber_ids) for t in update.subscribed_topics], update.removed_topics
        ),
        _follow(
            before.services, [(s.name, s.provider_ids) for s in update.advertised_services], update.removed_services
        ),
    ) == ConnectionGraph(after.published, after.subscribed, after.services)


def _follow(known: Names, changed: list[tuple[str, tuple[str, ...]]], removed: tuple[str, ...]) -> Names:
    names = {**known, **dict(changed)}
    return {name: nodes for name, nodes in names.items() if nodes and name not in removed}
