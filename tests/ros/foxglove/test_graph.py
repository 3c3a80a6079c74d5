"""The graph of nodes, and assets, for a real client."""

from __future__ import annotations

from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool

from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.ros.foxglove import assets
from thymio_sim_ros.ros.foxglove.graph import connection_graph


def flip(request, response):
    response.success = request.data
    response.message = "done"
    return response


def test_the_connection_graph_names_publishers_subscribers_and_providers(ros, studio):
    ros.node.create_publisher(String, "/chat", 10)
    ros.node.create_subscription(String, "/chat", lambda _: None, 10)
    ros.node.create_service(SetBool, "/flip", flip)
    studio.service("/flip")
    studio.channel("/chat")
    studio.send(ms.SubscribeConnectionGraph())
    update = studio.next(ms.ConnectionGraphUpdate)
    assert ms.PublishedTopic("/chat", ("/test",)) in update.published_topics
    assert ms.SubscribedTopic("/chat", ("/test",)) in update.subscribed_topics
    assert ms.AdvertisedService("/flip", ("/test",)) in update.advertised_services
    assert "/foxglove_bridge/get_parameters" not in [service.name for service in update.advertised_services]


def test_an_asset_that_is_not_there_is_an_error_for_its_request(studio):
    studio.send(ms.FetchAsset("package://std_msgs/no.stl", 3))
    assert studio.next(ms.AssetResponse) == ms.AssetResponse(3, b"", "'package://std_msgs/no.stl' does not exist")


def test_a_node_that_leaves_is_taken_from_the_graph(ros, studio):
    leaver = Node("leaver", context=ros.context, enable_rosout=False)
    leaver.create_publisher(String, "/chat", 10)
    leaver.create_service(SetBool, "/flip", flip)
    studio.service("/flip")
    studio.channel("/chat")
    studio.send(ms.SubscribeConnectionGraph())
    studio.next(
        ms.ConnectionGraphUpdate,
        lambda update: ms.AdvertisedService("/flip", ("/leaver",)) in update.advertised_services,
    )
    leaver.destroy_node()
    gone = {"/chat", "/flip"}
    while gone:
        update = studio.next(ms.ConnectionGraphUpdate)
        gone -= {*update.removed_topics, *update.removed_services}


def test_a_mesh_of_an_installed_package_is_fetched(studio, monkeypatch, tmp_path):
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "body.stl").write_bytes(bytes(range(256)) * 1000)
    monkeypatch.setattr(assets, "share_folders", lambda: [tmp_path])
    studio.send(ms.FetchAsset("package://robot/body.stl", 4))
    assert studio.next(ms.AssetResponse) == ms.AssetResponse(4, bytes(range(256)) * 1000)


def test_nodes_of_one_name_are_all_in_the_graph(ros, studio):
    twins = [Node("twin", context=ros.context, enable_rosout=False) for _ in range(2)]
    for twin, topic in zip(twins, ("/left", "/right"), strict=True):
        twin.create_publisher(String, topic, 10)
        studio.channel(topic)
    studio.send(ms.SubscribeConnectionGraph())
    found = {}
    while not {"/left", "/right"} <= found.keys():
        update = studio.next(ms.ConnectionGraphUpdate)
        found |= {item.name: item.publisher_ids for item in update.published_topics}
    assert found["/left"] == found["/right"] == ("/twin",)
    for twin in twins:
        twin.destroy_node()


def test_a_node_that_has_just_left_is_not_in_the_graph(ros):
    class Late:
        """A node that still lists the name of a node that has ended."""

        def __getattr__(self, name):
            return getattr(ros.node, name)

        def get_node_names_and_namespaces(self):
            return [("gone", "/"), *ros.node.get_node_names_and_namespaces()]

    ros.node.create_publisher(String, "/chat", 10)
    ros.until(lambda: ros.node.count_publishers("/chat"), what="the publisher in the graph")
    graph = connection_graph(Late(), ["/chat"], [])
    assert graph.published == {"/chat": ("/test",)}
    assert graph.subscribed == graph.services == {}
