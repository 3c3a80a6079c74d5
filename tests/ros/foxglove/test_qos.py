"""QoS derived from the graph, and visible names."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from thymio_sim_ros.ros.foxglove.graph import allow_list, is_parameter_service, visible, visible_topics
from thymio_sim_ros.ros.foxglove.qos import SubscriptionQos, publisher_qos, subscription_qos


def endpoint(*, reliable=True, transient_local=False, depth=0):
    return SimpleNamespace(
        qos_profile=SimpleNamespace(  # as Fast DDS reports it; a QoSProfile warns of depth 0
            depth=depth,
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if transient_local else DurabilityPolicy.VOLATILE,
        )
    )


@pytest.mark.parametrize(
    ("publishers", "expected"),
    [
        ([], SubscriptionQos(is_reliable=False, retained=0, depth=10)),
        ([endpoint()], SubscriptionQos(is_reliable=True, retained=0, depth=10)),
        ([endpoint(), endpoint(reliable=False)], SubscriptionQos(is_reliable=False, retained=0, depth=10)),
        ([endpoint(transient_local=True)], SubscriptionQos(is_reliable=True, retained=1, depth=10)),
        ([endpoint(transient_local=True, depth=3)] * 2, SubscriptionQos(is_reliable=True, retained=25, depth=10)),
        ([endpoint(transient_local=True), endpoint()], SubscriptionQos(is_reliable=True, retained=0, depth=10)),
        ([endpoint(depth=12)], SubscriptionQos(is_reliable=True, retained=0, depth=12)),
        ([endpoint(transient_local=True, depth=1000)], SubscriptionQos(is_reliable=True, retained=25, depth=25)),
    ],
)
def test_subscriptions_match_all_publishers(publishers, expected):
    assert subscription_qos(publishers, min_depth=10, max_depth=25) == expected


def test_a_subscription_may_be_best_effort_whatever_is_published():
    assert not subscription_qos([endpoint()], min_depth=10, max_depth=25, best_effort=True).is_reliable


def test_the_profile_has_the_same_qos_for_rclpy():
    profile = SubscriptionQos(is_reliable=True, retained=1, depth=7).profile
    assert (profile.reliability, profile.durability, profile.depth) == (
        ReliabilityPolicy.RELIABLE,
        DurabilityPolicy.TRANSIENT_LOCAL,
        7,
    )


def test_a_publisher_for_clients_is_reliable_and_transient_local_if_another_endpoint_is():
    plain, transient_local = endpoint(depth=1), endpoint(transient_local=True, depth=1)
    assert publisher_qos([], [plain]).durability == DurabilityPolicy.VOLATILE
    assert publisher_qos([], [plain, transient_local]).durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert publisher_qos([transient_local], []).reliability == ReliabilityPolicy.RELIABLE


def test_names_are_allowed_by_whole_matches():
    is_allowed = allow_list(["/a.*", "", "/b"])
    assert [name for name in ("/a", "/abc", "/b", "/bc", "") if is_allowed(name)] == ["/a", "/abc", "/b"]


def test_hidden_names_are_shown_on_demand():
    names = {"/a": ["x"], "/_b": ["x"], "/c/_action/status": ["x"], "/d_": ["x"]}
    assert list(visible(names, allow_list([".*"]), hidden=False)) == ["/a", "/d_"]
    assert list(visible(names, allow_list([".*"]), hidden=True)) == list(names)


def test_all_topics_but_those_of_actions_are_shown():
    names = {"/a": ["x"], "/_b": ["x"], "/c/_action/status": ["x"], "/d_": ["x"]}
    assert list(visible_topics(names, allow_list([".*"]), hidden=False)) == ["/a", "/_b", "/d_"]
    assert list(visible_topics(names, allow_list([".*"]), hidden=True)) == list(names)
    assert list(visible_topics(names, allow_list(["/a", "/c.*"]), hidden=True)) == ["/a", "/c/_action/status"]


def test_only_the_services_that_every_node_has_are_parameter_services():
    assert is_parameter_service("/peer/set_parameters")
    assert is_parameter_service("/ns/peer/get_type_description")
    assert not is_parameter_service("/aseba/get_variables")
    assert not is_parameter_service("/simulator/reset")
