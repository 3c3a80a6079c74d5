"""The web page as a ROS node: parameters, and an HTTP server in its own thread or in that of the bridge (`web`).

The page communicates with the bridge by the Foxglove protocol: on its own port if both are in one process, otherwise on
the port of the bridge, which is in `/config.json`. Beside that the server only serves files, read-only: those of the
page, the shipped playgrounds as `/playgrounds/NAME.json`, the list of missions and their pictures. It listens on
loopback by default. None of the files is secret, therefore it needs no tokens (SECURITY.md).
"""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Sequence
from dataclasses import dataclass

from rclpy.context import Context
from rclpy.executors import Executor

import thymio_sim_ros
from thymio_sim_ros.access import AccessCheck
from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.files import resources
from thymio_sim_ros.missions import MissionError, documents
from thymio_sim_ros.names.addresses import describe_urls
from thymio_sim_ros.names.ports import FOXGLOVE_PORT, HTTP_PORT
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.page_nodes.mount import mount
from thymio_sim_ros.page_nodes.who import Who
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.rclpy_ext import parameters
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, StartError, announce, run_main
from thymio_sim_ros.ros.rclpy_ext.parameter_node import parameter_node
from thymio_sim_ros.ros.rclpy_ext.parameters import param
from thymio_sim_ros.ros.web import tokens as node_tokens
from thymio_sim_ros.ros.web.proxies import trusted_proxies
from thymio_sim_ros.ros.web.tls import CERTFILE, KEYFILE, TLS, given_tls
from thymio_sim_ros.suite_config import ADDRESS
from thymio_sim_ros.web import Content, ServerThread, Settings


@dataclass(frozen=True)
class WebParams:
    """Parameters of the web node."""

    port: int = param(HTTP_PORT, "TCP port of the page; 0 selects a free one", low=0, high=65535, fixed=True)
    address: str = param(ADDRESS, "Address to listen on; 0.0.0.0 for all IPv4 interfaces", fixed=True)
    foxglove_port: int = param(
        FOXGLOVE_PORT,
        "Port of the Foxglove bridge on the same host, for a page in a process of its own; -1: that of the page",
        low=OFF,
        high=65535,
        fixed=True,
    )
    tls: bool = TLS
    certfile: str = CERTFILE
    keyfile: str = KEYFILE
    allowed_hosts: list[str] = param(
        [""], "Additional host names under which a page on loopback may be opened", fixed=True
    )
    trusted_proxies: tuple[str, ...] = param(
        ("",),
        "Addresses and networks of reverse proxies whose headers X-Forwarded-* are believed",
        fixed=True,
    )
    nodes: str = param(
        Who.LOCAL.value,
        "Who may run ROS nodes that are written on the page: local (the user of this computer), all (with full access, "
        "in isolation), none",
        choices=tuple(Who),
        fixed=True,
    )
    notice: str = param("", "Text that the page shows to its readers until it is empty, as from a teacher")
    notice_link: str = param("", "Address that the page offers with the notice, also relative to the page")
    pupil: str = param("", "Name of the pupil whose page this is, which the page shows")
    paused_by_teacher: bool = param(False, "Whether a teacher has paused time: the page locks its time controls")
    raised_hand: bool = param(False, "Whether the pupil has raised a hand on the page, until the teacher lowers it")
    handouts: str = param("[]", "Files that a teacher has handed out, as JSON, which the page of a pupil offers")
    draft: str = param("", "Text that the page of a pupil has in its editor, as an .aesl file")
    node_draft: str = param("", "ROS node in Python that the page of a pupil has in its editor")


class WebPage:
    """The web node and its HTTP server; `port` is the actual port."""

    def __init__(
        self,
        context: Context,
        defaults: WebParams | None = None,
        tokens: Tokens | None = None,
        thread: ServerThread | None = None,
        access: AccessCheck | None = None,
    ) -> None:
        """Start the server. Raises StartError if aiohttp is missing or the port cannot be used.

        `tokens` of the bridge are part of the printed address; None: those of the environment or of parameters.
        `thread`: that of other servers of this process, such as the bridge, which are then on the page's port, too.
        `access`: the check of the bridge in this process, which then runs nodes of the page.
        """
        self._is_stopped = False
        self.node = parameter_node("web_ui", context=context)
        try:
            self.params = parameters.declare(self.node, defaults or WebParams())
            parameters.warn_of_unknown(
                self.node, "ros2-tools.md", lambda name: self.node.has_parameter(name) or name in node_tokens.PARAMETERS
            )
            self.tokens = node_tokens.given_tokens(self.node) if tokens is None else tokens
            if importlib.util.find_spec("aiohttp") is None:
                raise StartError("the page needs aiohttp: pip install aiohttp, or the system's python3-aiohttp")
            self._trusted_proxies = trusted_proxies(self.params.trusted_proxies)
            self._thread = thread.share() if thread else ServerThread(warn=self.node.get_logger().warning)
            self._thread.trust(self._trusted_proxies)
            try:
                self._serve(has_bridge=thread is not None)
                if access is not None:
                    mount(self._thread, access, Who(self.params.nodes))
            except BaseException:
                self._thread.close()
                raise
        except BaseException:
            self.node.destroy_node()
            raise

    def _serve(self, *, has_bridge: bool) -> None:
        values = self.params
        tls = given_tls(tls=values.tls, certfile=values.certfile, keyfile=values.keyfile)
        page = resources.page()
        if page is None:
            self.node.get_logger().warning(resources.PAGE_BUILD_HINT)
        foxglove_port = OFF if has_bridge else values.foxglove_port
        config: dict[str, str | int] = {"version": thymio_sim_ros.__version__}
        if foxglove_port != OFF:
            config["foxglove_port"] = foxglove_port
        settings = Settings(
            foxglove_port,
            is_loopback=is_loopback(values.address) and not self._trusted_proxies,
            allowed_hosts=tuple(name.lower() for name in values.allowed_hosts if name),
        )
        try:
            self.port = self._thread.listen(values.address, values.port, tls)[1]
        except OSError as error:
            where = f"{values.address}:{values.port}"
            raise StartError(
                f"the page's port {where} cannot be used: {error.strerror}; "
                "choose another with --port, or port:=NUMBER of ros2"
            ) from error
        self._thread.mount_page(Content(page, json.dumps(config).encode(), self._find_mission), settings)

    def _find_mission(self, names: Sequence[str]) -> tuple[bytes, str] | None:
        try:
            return documents.find(names)
        except (MissionError, OSError) as error:
            self.node.get_logger().warning(f"missions: {error}")
            return None

    @property
    def _scheme(self) -> str:
        return "https" if self.params.tls else "http"

    @property
    def startup_message(self) -> str:
        """Addresses of the page, as text for the log."""
        return f"Page: {describe_urls(self._scheme, self.params.address, self.port, '/')}"

    @property
    def access_urls(self) -> str:
        """Addresses with their tokens, for standard output; not for the log, which clients can read."""
        if not self.tokens.is_required:
            return ""
        place = self._scheme, self.params.address, self.port, "/"
        full, read_only = (describe_urls(*place, token) for token in (self.tokens.full, self.tokens.read_only))
        return f"Page      {full}\nRead only {read_only}"

    def run_once(self, executor: Executor) -> None:
        """Spin the executor once, for the services of parameters."""
        executor.spin_once(timeout_sec=SPIN_SLICE_S)

    def stop(self) -> None:
        """Stop the server, with the last node that uses its thread."""
        if not self._is_stopped:
            self._is_stopped = True
            self._thread.close()

    def close(self) -> None:
        """Stop the server and destroy the node."""
        self.stop()
        self.node.destroy_node()


def main(args: Sequence[str] | None = None) -> int:
    """The executable `web_ui`."""
    with dds_profile.used(dds_profile.ANNOUNCING):
        return run_main(lambda context: announce([WebPage(context)]), args)
