"""The Foxglove bridge as a ROS node: offers any ROS graph to Foxglove Studio, Lichtblick and the web page.

There are two threads: the executor's thread owns all ROS objects and runs this module, the thread of the event loop
owns the clients (`bridge`). Commands are passed on by `BridgeServer.execute`, events arrive by `Mailbox`; nothing else
is shared. Topics, services and parameters each have a module, which follows the polled graph. Messages of topics are
forwarded in serialized form.
"""

from __future__ import annotations

import time
import traceback
import uuid
from collections.abc import Sequence
from dataclasses import replace
from typing import assert_never
from urllib.parse import quote

from rclpy.clock import Clock, JumpThreshold, TimeJump
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import UInt32

from thymio_sim_ros.access import AccessCheck
from thymio_sim_ros.bridge import BridgeServer, ServerInfo, ServerSettings, Tokens
from thymio_sim_ros.bridge.protocol.constants import CDR, JSON
from thymio_sim_ros.bridge.protocol.messages import AssetResponse
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.names.addresses import describe_access, describe_urls, urls
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.foxglove.assets import AssetError, load_asset
from thymio_sim_ros.ros.foxglove.discovery import SHARE, Discovery, Filters
from thymio_sim_ros.ros.foxglove.graph import allow_list
from thymio_sim_ros.ros.foxglove.options import FoxgloveParams, check, server_capabilities
from thymio_sim_ros.ros.foxglove.parameters import Parameters
from thymio_sim_ros.ros.foxglove.publishers import ClientPublishers
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host
from thymio_sim_ros.ros.foxglove.rosbridge.sessions import Sessions
from thymio_sim_ros.ros.foxglove.service_calls import ServiceCalls
from thymio_sim_ros.ros.foxglove.services import Services
from thymio_sim_ros.ros.foxglove.topics import Topics
from thymio_sim_ros.ros.interface.qos import TRANSIENT_LOCAL
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.mailbox import Mailbox
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, StartError, announce, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.rclpy_ext.peers import follow_clock
from thymio_sim_ros.ros.web import tokens as node_tokens
from thymio_sim_ros.ros.web.proxies import trusted_proxies
from thymio_sim_ros.ros.web.tls import given_tls
from thymio_sim_ros.web import ServerThread

__all__ = ["FoxgloveBridge", "main"]

_DISCOVERY_PERIOD_S = 0.25
_REFRESH_PERIOD_S = 1.0
_RESEND_DELAY_S = 1.0
"""Delay after a new session until retained messages are sent again: a client that is dropping the data of the last
session may drop messages that arrive meanwhile (measured with Lichtblick)."""
_FAST_POLL_PERIOD_S = 0.02
"""Period of polling while calls, messages, subscriptions or answers are waiting."""


class FoxgloveBridge:
    """The node and its server, which listens when the constructor returns; `port` is then the actual port, or `OFF`.

    Belongs to the thread that spins the node's executor.
    """

    def __init__(
        self,
        *,
        context: Context,
        port: int | None = None,
        address: str | None = None,
        use_sim_time: bool | None = None,
        defaults: FoxgloveParams | None = None,
        tokens: Tokens | None = None,
        peers: tuple[Node, Node] | None = None,
        page_thread: ServerThread | None = None,
    ) -> None:
        """Start the server. Raises StartError for invalid parameters or if the port cannot be used.

        `tokens` are those of the command line; None: tokens from the environment and parameters, or new ones if the
        address is reachable from the network. `peers` subscribe and publish for clients, where the endpoints of
        `context` do not match each other; None: the bridge's node does. `page_thread`:
        that of a page, which serves the bridge on its port as well. The other arguments override parameters.
        """
        overrides = [] if use_sim_time is None else [Parameter("use_sim_time", value=use_sim_time)]
        self.node = parameter_node("foxglove_bridge", context=context, parameter_overrides=overrides)
        self.peers: tuple[Node, ...] = peers or ()
        self._subscriber, self._publisher = peers or (self.node, self.node)
        if peers is not None:
            follow_clock(self.node, self._subscriber)
        try:
            values = defaults or FoxgloveParams()
            values = replace(
                values,
                port=values.port if port is None else port,
                address=values.address if address is None else address,
            )
            self.params = parameters.declare(self.node, values)
            check(self.params)
            if self.params.port == OFF and page_thread is None:
                raise StartError("parameter port: found -1, expected a port, because no page serves the bridge")
            parameters.warn_of_unknown(
                self.node, "foxglove.md", lambda name: self.node.has_parameter(name) or name in node_tokens.PARAMETERS
            )
            self._trusted_proxies = trusted_proxies(self.params.trusted_proxies)
            self.tokens = self._own_tokens() if tokens is None else tokens
            self._uses_sim_time = bool(self.node.get_parameter("use_sim_time").value)
            self._mailbox: Mailbox[ev.Event] = Mailbox(
                self.node, self._on_event, sender=_sender, weight=lambda event: 1 + (ev.size_of(event) >> 14)
            )
            self._thread = page_thread.share() if page_thread else ServerThread(warn=self.node.get_logger().warning)
            try:
                self._thread.trust(self._trusted_proxies)
                self._server = self._open_server()
            except BaseException:
                self._thread.close()
                raise
        except BaseException:
            self.node.destroy_node()
            raise
        self._is_stopped = False
        self._sim_now_ns = 0
        self._build()

    @property
    def access_check(self) -> AccessCheck:
        """Whether its server answers a request; only in the thread of the servers."""
        return self._server.access

    @property
    def startup_message(self) -> str:
        """Addresses for clients, as text for the log."""
        place = self._scheme, self.address, self.port
        if self.port == OFF:
            return f"Foxglove: on the port of the page; access: {self._access}"
        is_open = not self.tokens.is_required
        how = f"or {_app_link(urls(*place)[0])}" if is_open else "with the token on standard output"
        return f"Foxglove: {describe_urls(*place)} {how}; access: {self._access}"

    @property
    def access_urls(self) -> str:
        """Addresses with their tokens, for standard output; not for the log, which clients can read."""
        if not self.tokens.is_required or self.port == OFF:
            return ""
        place = self._scheme, self.address, self.port
        full = urls(*place, "/", self.tokens.full)
        read_only = describe_urls(*place, "/", self.tokens.read_only)
        return f"Foxglove  {', from other computers '.join(full)} or {_app_link(full[0])}\nRead only {read_only}"

    @property
    def _access(self) -> str:
        return describe_access(self.address, self.tokens, is_proxied=bool(self._trusted_proxies))

    @property
    def _scheme(self) -> str:
        return "wss" if self.params.tls else "ws"

    def _own_tokens(self) -> Tokens:
        given = node_tokens.given_tokens(self.node)
        if not self.params.require_token:
            return Tokens()
        is_proxied = bool(self._trusted_proxies)
        return Tokens.for_address(self.params.address, given.full, given.read_only, is_proxied=is_proxied)

    def run_once(self, executor: Executor) -> None:
        """Spin the executor once; returns after `SPIN_SLICE_S` at the latest."""
        executor.spin_once(timeout_sec=SPIN_SLICE_S)

    def stop(self) -> None:
        """Stop the server and its thread. The executor must not be spinning any more."""
        self._mailbox.close()
        if not self._is_stopped:
            self._is_stopped = True
            self._thread.close()

    def close(self) -> None:
        """Stop the server, end all endpoints, and destroy the node."""
        self.stop()
        self._jump_handle.unregister()
        self._rosbridge.close()
        self._topics.close()
        self._publishers.close_all()
        self.node.destroy_node()

    def _open_server(self) -> BridgeServer:
        """Serve on the port of the bridge, and on that of a page in the same thread."""
        values = self.params
        tls = given_tls(tls=values.tls, certfile=values.certfile, keyfile=values.keyfile)
        self.address, self.port = values.address, OFF
        try:
            if values.port != OFF:
                self.address, self.port = self._thread.listen(values.address, values.port, tls)
        except OSError as error:
            hint = "choose another with --foxglove-port, or -p port:=NUMBER for the node alone"
            raise StartError(f"the Foxglove bridge {error.strerror}; {hint}") from error
        info = ServerInfo(
            "thymio_sim_ros",
            server_capabilities(values, uses_sim_time=self._uses_sim_time),
            (CDR, JSON),
            {"namespace": self.node.get_namespace()},
            session_id=_new_id(),
        )
        settings = ServerSettings(
            allowed_origins=tuple(filter(None, values.allowed_origins)),
            buffer_limit=values.send_buffer_limit,
            max_message_size=values.max_message_size,
            tokens=self.tokens,
            is_read_only_service=allow_list(values.read_only_services),
        )
        board = Switchboard(info, is_read_only_service=settings.is_read_only_service)
        server = BridgeServer(board, self._mailbox, self._thread.loop, settings)
        self._thread.mount_bridge(server)
        return server

    def _build(self) -> None:
        values, post = self.params, self._server.execute
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        filters = Filters(
            allow_list(values.topic_whitelist), allow_list(values.service_whitelist), values.include_hidden
        )
        self._discovery = Discovery(self.node, filters, lambda graph: post(ev.SetGraph(graph)))
        self._fast_poll_timer = self.node.create_timer(_FAST_POLL_PERIOD_S, self._poll_waiting, clock=steady)
        self._fast_poll_timer.cancel()
        self._resend_timer = self.node.create_timer(_RESEND_DELAY_S, self._resend_retained, clock=steady)
        self._resend_timer.cancel()
        self._calls = ServiceCalls(self._subscriber, wake=self._poll_soon)
        self._topics = Topics(
            self._subscriber,
            post,
            self._server.publish,
            self._now_ns,
            min_depth=values.min_qos_depth,
            max_depth=values.max_qos_depth,
            is_best_effort=allow_list(values.best_effort_qos_topic_whitelist),
            wake=self._poll_soon,
        )
        self._services = Services(self.node, self._calls, post)
        self._parameters = Parameters(
            self._subscriber,
            self._calls,
            post,
            is_allowed=allow_list(values.param_whitelist),
            wake=self._poll_soon,
        )
        self._publishers = ClientPublishers(
            self._publisher, post, is_allowed=allow_list(values.client_topic_whitelist), wake=self._poll_soon
        )
        self._rosbridge = Sessions(
            Host(
                node=self.node,
                subscriber=self._subscriber,
                publisher=self._publisher,
                calls=self._calls,
                send=self._server.send,
                now_ns=self._now_ns,
                wake=self._poll_soon,
                offered=server_capabilities(values, uses_sim_time=self._uses_sim_time),
                max_size=values.max_message_size,
                depths=(values.min_qos_depth, values.max_qos_depth),
                is_topic=filters.is_topic,
                is_client_topic=allow_list(values.client_topic_whitelist),
                is_service=filters.is_service,
                is_read_only_service=allow_list(values.read_only_services),
            )
        )
        self._published_count = -1
        self._count = (
            self.node.create_publisher(UInt32, "~/client_count", TRANSIENT_LOCAL)
            if values.publish_client_count
            else None
        )
        self._next_check_s = 0.0
        self._jump_handle = self.node.get_clock().create_jump_callback(
            JumpThreshold(
                min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1), on_clock_change=True
            ),
            post_callback=self._on_time,
        )
        self.node.create_timer(_DISCOVERY_PERIOD_S, self._discover, clock=steady)
        self.node.create_timer(_REFRESH_PERIOD_S, self._refresh, clock=steady)

    def _now_ns(self) -> int:
        return self._sim_now_ns if self._uses_sim_time else time.time_ns()

    def _on_time(self, jump: TimeJump) -> None:
        """Forward simulated time; a jump backwards is a reset of the simulation and starts a new session."""
        if not self._uses_sim_time:
            return
        now_ns = self.node.get_clock().now().nanoseconds
        if now_ns < self._sim_now_ns:
            self._server.execute(ev.NewSession(_new_id()))
            self._resend_timer.reset()
        self._sim_now_ns = now_ns
        self._server.execute(ev.SetTime(now_ns))

    def _resend_retained(self) -> None:
        self._resend_timer.cancel()
        self._server.execute(ev.ResendRetained())

    def _discover(self) -> None:
        """Poll the graph and pass changes on."""
        self._mailbox.drain()
        self._check_publishers()
        self._rosbridge.refresh()
        found = self._discovery.poll()
        self._calls.forget_gone(self._discovery.services)
        if found is not None:
            self._topics.update(found.topics)
            self._services.update(found.services)
            self._parameters.update(self._discovery.services)

    def _check_publishers(self) -> None:
        """Continue the check of all subscribed topics; start a new one every `_REFRESH_PERIOD_S`."""
        if time.monotonic() >= self._next_check_s and self._topics.refresh(_DISCOVERY_PERIOD_S * SHARE):
            self._next_check_s = time.monotonic() + _REFRESH_PERIOD_S

    def _refresh(self) -> None:
        self._parameters.refresh(has_clients=self._server.client_count > 0)
        if self._count is not None and self._published_count != self._server.client_count:
            self._published_count = self._server.client_count
            self._count.publish(UInt32(data=self._published_count))
        self._discovery.mark_outdated()

    def _poll_soon(self) -> None:
        """Start polling. A timer that is reset repeatedly would never fire; therefore a running one is left alone."""
        if self._fast_poll_timer.is_canceled():
            self._fast_poll_timer.reset()

    def _poll_waiting(self) -> None:
        waits = [self._calls.poll(), self._publishers.poll(), self._topics.poll(), self._parameters.poll()]
        waits.append(self._rosbridge.poll())
        if not any(waits):
            self._fast_poll_timer.cancel()

    def _on_event(self, event: ev.Event) -> None:
        try:
            self._handle(event)
        except Exception:
            # A failed request of one client must not end the bridge for the others; it is dropped.
            self.node.get_logger().error(
                f"internal error (please report): {type(event).__name__} failed:\n{traceback.format_exc()}"
            )
            if isinstance(event, ev.ServiceCalled):
                self._services.fail(event.client, event.request, "internal error (please report), see the log")
            elif isinstance(event, (ev.ParametersSet, ev.ParametersRequested)):
                self._server.execute(ev.SendParameters(event.client, (), event.request_id, ev.size_of(event)))

    def _handle(self, event: ev.Event) -> None:
        match event:
            case ev.ChannelSubscribed():
                self._topics.subscribe(event.channel_id)
            case ev.ChannelUnsubscribed():
                self._topics.unsubscribe(event.channel_id)
            case ev.ClientChannelOpened():
                self._publishers.open(event.client, event.channel)
            case ev.ClientChannelClosed():
                self._publishers.close(event.client, event.channel_id)
            case ev.ClientMessageReceived():
                self._publishers.publish(event.client, event.channel_id, event.payload)
            case ev.ServiceCalled():
                self._services.call(event.client, event.request)
            case ev.ParametersSet():
                self._parameters.set(event)
            case ev.ParametersRequested():
                self._parameters.get(event)
            case ev.ParametersWatched():
                self._parameters.watch(event)
            case ev.GraphSubscriptionChanged():
                self._discovery.want_connections(wanted=event.wanted)
            case ev.AssetRequested():
                self._on_asset_requested(event)
            case ev.RosbridgeJoined() | ev.RosbridgeReceived() | ev.RosbridgeLeft():
                self._rosbridge.handle(event)
            case _:
                assert_never(event)

    def _on_asset_requested(self, event: ev.AssetRequested) -> None:
        try:
            answer = AssetResponse(event.request_id, load_asset(event.uri, self.params.asset_uri_allowlist))
        except AssetError as error:
            answer = AssetResponse(event.request_id, b"", str(error))
        self._server.execute(ev.SendToClient(event.client, answer))


def _sender(event: ev.Event) -> int:
    """The client of an event; 0 for events that have none."""
    return getattr(event, "client", 0)


def _app_link(url: str) -> str:
    return f"https://app.foxglove.dev/?ds=foxglove-websocket&ds.url={quote(url, safe='')}"


def _new_id() -> str:
    return str(uuid.uuid4())


def main(args: Sequence[str] | None = None) -> int:
    """The executable `foxglove_bridge`."""
    with dds_profile.used(dds_profile.ANNOUNCING):
        return run_main(lambda context: announce([FoxgloveBridge(context=context)]), args)
