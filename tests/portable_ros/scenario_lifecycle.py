"""More of what rclpy and the embedded graph do alike (see scenario.py): lifecycle nodes, events of services, types."""

from __future__ import annotations

import json
import sys
from typing import Any

import rclpy
from lifecycle_msgs.msg import TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, SimpleManagedEntity, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from scenario import attempt, seen, spin_until
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from type_description_interfaces.srv import GetTypeDescription

SUCCESS, FAILURE, ERROR = (
    TransitionCallbackReturn.SUCCESS,
    TransitionCallbackReturn.FAILURE,
    TransitionCallbackReturn.ERROR,
)
TRANSITIONS = ("configure", "cleanup", "activate", "deactivate", "shutdown")


class Managed(LifecycleNode):
    """Notes its callbacks, which return or raise what `results` has."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self.called: list[tuple[str, str, int]] = []
        self.results: dict[str, Any] = {}

    def note(self, name: str, state: LifecycleState) -> Any:
        """Note a callback, and return or raise its result."""
        self.called.append((name, state.label, state.state_id))
        result = self.results.get(name, SUCCESS)
        if isinstance(result, Exception):
            raise result
        return getattr(LifecycleNode, name)(self, state) if result is SUCCESS else result

    def on_configure(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_cleanup", state)

    def on_activate(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_deactivate", state)

    def on_shutdown(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_shutdown", state)

    def on_error(self, state: LifecycleState) -> Any:
        """Note."""
        return self.note("on_error", state)


def change(node: Managed, transition: str) -> tuple[Any, ...]:
    """The result of a transition, the state after it, and the callbacks."""
    node.called.clear()
    try:
        found = getattr(node, f"trigger_{transition}")().name
    except Exception as error:
        spelled = "trans" + "tion"  # rclpy's word
        found = f"{type(error).__name__}: {str(error).partition(', at ')[0].replace(spelled, 'transition')}"
    return found, node._state_machine.current_state, list(node.called)


def states(executor: Any) -> None:
    """All transitions, with the results of callbacks and with errors."""
    node = Managed("states")
    seen["results"] = [(one.name, int(one), one.to_label()) for one in (SUCCESS, FAILURE, ERROR)]
    steps = ["activate", "configure", "configure", "cleanup", "configure", "activate", "deactivate", "activate"]
    seen["transitions"] = [change(node, one) for one in (*steps, "shutdown", "shutdown", "configure")]
    for result in (FAILURE, ERROR, ValueError("no"), None):
        node = Managed(f"node_{str(result).rpartition('.')[2]}")
        node.results = {"on_configure": result}
        seen[f"configuration: {result!s:.20}"] = change(node, "configure")
    for result in (FAILURE, ERROR):
        node = Managed(f"twice_{int(result)}")
        node.results = {"on_activate": ERROR, "on_error": result}
        seen[f"error: {int(result)}"] = change(node, "configure"), change(node, "activate"), change(node, "shutdown")
    for name in ("activate", "deactivate", "cleanup", "shutdown"):
        node = Managed(f"fails_{name}")
        node.results = {f"on_{name}": FAILURE}
        before = {"activate": 1, "deactivate": 2, "cleanup": 1, "shutdown": 2}[name]
        seen[f"failure: {name}"] = [change(node, one) for one in (*("configure", "activate")[:before], name)]


def managed_entities(executor: Any) -> None:
    """Publishers of lifecycle nodes, and other entities."""
    node = Managed("entities", enable_communication_interface=False)
    executor.add_node(node)
    received: list[str] = []
    missed: list[str] = []
    publisher = node.create_lifecycle_publisher(String, "text", 10)
    node.create_subscription(String, "text", lambda message: received.append(message.data), 10)

    class Lamp(SimpleManagedEntity):
        """Shines while it is active."""

        @SimpleManagedEntity.when_enabled
        def shine(self) -> None:
            """Note."""
            received.append("light")

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: missed.append("dark"))
        def flash(self) -> None:
            """Note."""
            received.append("flash")

    lamp = Lamp()
    node.add_managed_entity(lamp)
    seen["no entity"] = attempt(node.add_managed_entity, "lamp")
    seen["no class"] = attempt(node.create_lifecycle_publisher, String, "text", 1, publisher_class=None)
    spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    for transition in ("configure", "activate", "deactivate"):
        publisher.publish(String(data=f"before {transition}"))
        lamp.shine()
        lamp.flash()
        change(node, transition)
        seen[f"after {transition}"] = publisher.is_activated, lamp.is_activated
    spin_until(executor, lambda: "before deactivate" in received)
    seen["received"] = sorted(received), missed
    lamp.on_activate = lambda _: "yes"
    seen["wrong result"] = change(node, "activate")
    seen["destroyed"] = node.destroy_lifecycle_publisher(publisher), node.destroy_lifecycle_publisher(publisher)
    executor.remove_node(node)
    node.destroy_node()


def services(node: Node, executor: Any) -> None:
    """What other nodes see and do."""
    managed = Managed("managed", namespace="space")
    executor.add_node(managed)
    events: list[Any] = []

    def note(event: TransitionEvent) -> None:
        states = event.start_state, event.goal_state
        events.append([event.timestamp, event.transition.id, [(one.id, one.label) for one in states]])

    node.create_subscription(TransitionEvent, "/space/managed/transition_event", note, 10)
    own = "/space/managed/"
    spin_until(executor, lambda: node.count_subscribers(f"{own}transition_event") == 1)
    seen["services"] = [one.srv_name for one in managed.services][-6:]
    seen["topics"] = [one.topic_name for one in managed.publishers]

    def ask(kind: Any, name: str, **values: Any) -> Any:
        client = node.create_client(kind, own + name)
        spin_until(executor, client.service_is_ready)
        request = kind.Request()
        for field, value in values.items():
            setattr(request.transition, field, value)
        future = client.call_async(request)
        spin_until(executor, future.done)
        return future.result()

    seen["state"] = repr(ask(GetState, "get_state"))
    seen["states"] = repr(ask(GetAvailableStates, "get_available_states"))
    seen["available"] = repr(ask(GetAvailableTransitions, "get_available_transitions"))
    seen["graph"] = repr(ask(GetAvailableTransitions, "get_transition_graph"))
    seen["by label"] = ask(ChangeState, "change_state", label="configure").success
    seen["unknown label"] = ask(ChangeState, "change_state", label="explode").success
    seen["by id"] = ask(ChangeState, "change_state", id=3).success
    managed.results = {"on_deactivate": FAILURE}
    seen["not successful"] = ask(ChangeState, "change_state", id=4).success
    seen["at the end"] = repr(ask(GetState, "get_state"))
    spin_until(executor, lambda: len(events) == 6)
    seen["events of transitions"] = events
    executor.remove_node(managed)
    managed.destroy_node()


def service_events(node: Node, executor: Any) -> None:
    """Requests and responses, as both ends of a service publish them."""
    events: list[Any] = []

    def answer(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.message = f"data is {request.data}"
        return response

    service = node.create_service(SetBool, "observed", answer)
    client = node.create_client(SetBool, "observed")
    spin_until(executor, client.service_is_ready)
    topic = "observed/_service_event"
    node.create_subscription(SetBool.Event, topic, events.append, 10)
    seen["introspection"] = [(one.name, one.value) for one in map(ServiceIntrospectionState, range(3))]
    for state in (ServiceIntrospectionState.METADATA, ServiceIntrospectionState.CONTENTS):
        for end in (service, client):
            end.configure_introspection(node.get_clock(), qos_profile_system_default, state)
        spin_until(executor, lambda: node.count_publishers(topic) == 2)
        spin_until(executor, lambda: all(one.get_publisher_count() == 2 for one in list(node.subscriptions)[-1:]))
        events.clear()
        future = client.call_async(SetBool.Request(data=True))
        spin_until(executor, lambda future=future: future.done() and len(events) == 4)
        found = sorted((one.info.event_type, [*one.request, *one.response]) for one in events)
        seen[state.name] = [(kind, repr(content)) for kind, content in found]
        seen[f"{state.name} numbers"] = len({one.info.sequence_number for one in events})
        seen[f"{state.name} stamps"] = all(one.info.stamp.sec > 0 for one in events)
    seen["listed"] = [one.topic_name for one in node.publishers if "_service_event" in one.topic_name]
    for end in (service, client):
        end.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.OFF)
    spin_until(executor, lambda: node.count_publishers(topic) == 0)


def types(node: Node, executor: Any) -> None:
    """Descriptions of the types that a node uses."""
    used = rclpy.create_node("used")
    executor.add_node(used)
    used.create_publisher(TransitionEvent, "events", 1)
    used.create_service(Trigger, "trigger", lambda _, response: response)
    client = node.create_client(GetTypeDescription, "used/get_type_description")
    spin_until(executor, client.service_is_ready)
    digest = str(used.get_publishers_info_by_topic("events")[0].topic_type_hash)
    without = rclpy.create_node(
        "without", parameter_overrides=[Parameter("start_type_description_service", value=False)]
    )
    seen["is offered"] = [
        any(service.srv_name.endswith("get_type_description") for service in one.services) for one in (used, without)
    ]

    def ask(**values: Any) -> Any:
        future = client.call_async(GetTypeDescription.Request(**values))
        spin_until(executor, future.done)
        return future.result()

    name = "lifecycle_msgs/msg/TransitionEvent"
    found = ask(type_name=name, type_hash=digest)
    seen["description"] = repr(found.type_description)
    seen["sources"] = [(one.type_name, one.encoding) for one in found.type_sources]
    seen["no sources"] = repr(ask(type_name=name, type_hash=digest, include_type_sources=False))
    seen["not described"] = [
        repr(ask(type_name=name, type_hash=f"RIHS01_{'0' * 64}")),
        repr(ask(type_name=name, type_hash="RIHS01")),
        repr(ask()),
    ]
    executor.remove_node(used)


def main() -> None:
    """Run all parts on an executor and print what was seen."""
    rclpy.init(args=[])
    node = rclpy.create_node("own")
    executor: Any = MultiThreadedExecutor(2) if "multi" in sys.argv else SingleThreadedExecutor()
    executor.add_node(node)
    states(executor)
    managed_entities(executor)
    services(node, executor)
    service_events(node, executor)
    types(node, executor)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
