"""The graph of nodes, and assets, for a real client."""

from __future__ import annotations

from std_msgs.msg import String
from std_srvs.srv import SetBool

from thymio_sim_ros.bridge import messages as ms


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
    assert studio.next(ms.AssetResponse) == ms.AssetResponse(3, b"", "package://std_msgs/no.stl does not exist")
