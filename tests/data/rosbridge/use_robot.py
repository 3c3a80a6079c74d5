"""Uses a robot by roslibpy, and prints what happens, one JSON object per line."""

import json
import os
import threading
from urllib.parse import urlsplit

import roslibpy

url = urlsplit(os.environ["BRIDGE_URL"])
ros = roslibpy.Ros(host=url.hostname, port=url.port)


def say(**what: object) -> None:
    print("#" + json.dumps({key.replace("_", " "): value for key, value in what.items()}), flush=True)


def drive() -> None:
    wheels = roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist")
    odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry", throttle_rate=20)
    has_moved = threading.Event()

    def follow(message: dict) -> None:
        wheels.publish(roslibpy.Message({"linear": {"x": 0.1}}))
        if message["pose"]["pose"]["position"]["x"] > 0.02:
            has_moved.set()

    odometry.subscribe(follow)
    say(has_moved=has_moved.wait(30))
    odometry.unsubscribe()
    wheels.unadvertise()


def serve() -> None:
    service = roslibpy.Service(ros, "/client/switch", "std_srvs/SetBool")

    def answer(request: dict, response: dict) -> bool:
        response["success"] = request["data"]
        response["message"] = "from the client"
        return True

    service.advertise(answer)
    other = roslibpy.Service(ros, "/client/switch", "std_srvs/SetBool")
    done = threading.Event()
    other.call(roslibpy.ServiceRequest({"data": True}), lambda found: (say(answer=dict(found)), done.set()), print)
    done.wait(30)
    try:
        other.call(roslibpy.ServiceRequest({"flag": True}), timeout=30)
    except Exception as error:
        say(refused=str(error.args[0]) if error.args else "")
    service.unadvertise()


ros.run(timeout=30)
say(topic_type=ros.get_topic_type("/odom"), has_node="/simulator" in ros.get_nodes())
say(parameter=ros.get_param("/simulator:playground"))
drive()
serve()
ros.terminate()
