"""Lifecycle nodes."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.lifecycle.managed_entity import ManagedEntity
from thymio_sim_ros.portable_ros.rclpy.lifecycle.publisher import LifecyclePublisher
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile
from thymio_sim_ros.portable_ros.rclpy_parts.state_machine import (
    STATES,
    TRANSITIONS,
    StateMachine,
    Transition,
    TransitionCallbackReturn,
)
from thymio_sim_ros.portable_ros.rclpy_parts.state_machine import LifecycleState as LifecycleState

_Ids = ros_types.Transition
_CALLBACKS = {
    ros_types.State.TRANSITION_STATE_CONFIGURING: "on_configure",
    ros_types.State.TRANSITION_STATE_CLEANINGUP: "on_cleanup",
    ros_types.State.TRANSITION_STATE_SHUTTINGDOWN: "on_shutdown",
    ros_types.State.TRANSITION_STATE_ACTIVATING: "on_activate",
    ros_types.State.TRANSITION_STATE_DEACTIVATING: "on_deactivate",
    ros_types.State.TRANSITION_STATE_ERRORPROCESSING: "on_error",
}


class LifecycleNodeMixin(ManagedEntity):
    """The part of a lifecycle node beside `Node`: states, transitions, managed entities.

    The callbacks call those of all managed entities, until one does not succeed.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        """`enable_communication_interface`: offer the services and the topic of lifecycle nodes."""
        self._managed_entities: dict[ManagedEntity, None] = {}
        self._state_machine = StateMachine(self._publish_transition)
        self._transition_publisher: Any = None
        if enable_communication_interface:
            self._offer(self, callback_group)

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node. Raises RCLError, as the other methods, if its state does not have this transition."""
        return self._change_state(_Ids.TRANSITION_CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Undo the configuration."""
        return self._change_state(_Ids.TRANSITION_CLEANUP)

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Start."""
        return self._change_state(_Ids.TRANSITION_ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Stop."""
        return self._change_state(_Ids.TRANSITION_DEACTIVATE)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """End."""
        found = next((one.id for one in self._state_machine.available() if one.label == "shutdown"), None)
        if found is None:
            raise RCLError("Shutdown transition not possible")
        return self._change_state(found)

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Call the callbacks of an entity, too. Raises TypeError for any other object."""
        if not isinstance(entity, ManagedEntity):
            raise TypeError("Expected a rclpy.lifecycle.ManagedEntity instance.")
        self._managed_entities[entity] = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the managed entities."""
        return self._call_entities("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo the configuration of the managed entities."""
        return self._call_entities("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """End the managed entities."""
        return self._call_entities("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start the managed entities."""
        return self._call_entities("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the managed entities."""
        return self._call_entities("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up the managed entities after another callback has failed."""
        return self._call_entities("on_error", state)

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> LifecyclePublisher[Any]:
        """Make a managed publisher. Arguments and errors are those of `create_publisher`."""
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        node: Any = self
        found: Any = Node.create_publisher(node, *args, **kwargs, publisher_class=LifecyclePublisher)
        made: LifecyclePublisher[Any] = found
        self._managed_entities[made] = None
        return made

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        """Remove a managed publisher; return whether it was one of this node."""
        self._managed_entities.pop(publisher, None)
        node: Any = self
        return Node.destroy_publisher(node, publisher)

    def _offer(self, node: Any, group: CallbackGroup | None) -> None:
        """Make the services and the topic."""
        name = node.get_fully_qualified_name()
        for kind, short, answer in (
            (ros_types.ChangeState, "change_state", self._on_change_state),
            (ros_types.GetState, "get_state", self._on_get_state),
            (ros_types.GetAvailableStates, "get_available_states", _on_get_states),
            (ros_types.GetAvailableTransitions, "get_available_transitions", self._on_get_transitions),
            (ros_types.GetAvailableTransitions, "get_transition_graph", _on_get_graph),
        ):
            node.create_service(kind, f"{name}/{short}", answer, callback_group=group)
        topic = f"{name}/transition_event"
        self._transition_publisher = Node.create_publisher(node, ros_types.TransitionEvent, topic, QoSProfile(depth=10))
        self._transition_publisher.is_part = True

    def _publish_transition(self, transition: Transition) -> None:
        """Publish the states; rcl does not set the other fields."""
        if self._transition_publisher is not None:
            event = ros_types.TransitionEvent(start_state=_state(transition.start), goal_state=_state(transition.goal))
            self._transition_publisher.publish(event)

    def _call_entities(self, callback: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in list(self._managed_entities):
            result = getattr(entity, callback)(state)
            if not isinstance(result, TransitionCallbackReturn):
                raise TypeError(
                    f"{callback}() return value of class {type(entity)} should be `TransitionCallbackReturn`.\n"
                    f"Instance of the class that caused the failure: {entity}"
                )
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def _change_state(self, wanted: int) -> TransitionCallbackReturn:
        """Make a transition and that which follows by the result of its callback, which is returned."""
        before = self._state_machine.state
        self._state_machine.trigger(wanted)
        result = self._call(before)
        self._state_machine.trigger(result.to_label())
        if result is TransitionCallbackReturn.ERROR:
            self._state_machine.trigger(self._call(before).to_label())
        return result

    def _call(self, before: LifecycleState) -> TransitionCallbackReturn:
        """Call the callback of the present state of transition; an exception is an error."""
        callback = getattr(self, _CALLBACKS[self._state_machine.state.state_id])
        try:
            result: TransitionCallbackReturn = callback(before)
        except Exception:
            return TransitionCallbackReturn.ERROR
        return result

    def _on_change_state(
        self, request: ros_types.ChangeState.Request, response: ros_types.ChangeState.Response
    ) -> ros_types.ChangeState.Response:
        wanted = request.transition.id
        if request.transition.label:
            try:
                wanted = self._state_machine.find(request.transition.label).id
            except RCLError:
                return response
        response.success = self._change_state(wanted) is TransitionCallbackReturn.SUCCESS
        return response

    def _on_get_state(self, _: object, response: ros_types.GetState.Response) -> ros_types.GetState.Response:
        response.current_state.id, response.current_state.label = self._state_machine.current_state
        return response

    def _on_get_transitions(
        self, _: object, response: ros_types.GetAvailableTransitions.Response
    ) -> ros_types.GetAvailableTransitions.Response:
        response.available_transitions = [_description(one) for one in self._state_machine.available()]
        return response


class LifecycleNode(LifecycleNodeMixin, Node):
    """A node with a lifecycle."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        """The other arguments and errors are those of `Node`."""
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)


def _on_get_states(_: object, response: ros_types.GetAvailableStates.Response) -> ros_types.GetAvailableStates.Response:
    response.available_states = [_state(one) for one in STATES]
    return response


def _on_get_graph(
    _: object, response: ros_types.GetAvailableTransitions.Response
) -> ros_types.GetAvailableTransitions.Response:
    response.available_transitions = [_description(one) for one in TRANSITIONS]
    return response


def _state(of: LifecycleState) -> ros_types.State:
    return ros_types.State(id=of.state_id, label=of.label)


def _description(of: Transition) -> ros_types.TransitionDescription:
    transition = ros_types.Transition(id=of.id, label=of.label)
    return ros_types.TransitionDescription(
        transition=transition, start_state=_state(of.start), goal_state=_state(of.goal)
    )
