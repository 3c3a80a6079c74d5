"""The command `thymio-sim class`: a suite for each pupil of a list, and a page for the teacher, until Ctrl-C."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import signal
import tempfile
from collections.abc import Sequence
from pathlib import Path

from thymio_sim_ros.access.visitor import TrustedProxies
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.folder import ClassFolder, Place
from thymio_sim_ros.classroom.pupils import read_pupils
from thymio_sim_ros.classroom.suite_process import SuiteOptions, discovery, preload
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import check_files, path_argument
from thymio_sim_ros.cli.output import print_text
from thymio_sim_ros.cli.page_options import (
    add_certificate_options,
    add_nodes_option,
    add_proxy_option,
    check_port,
    given_certificate,
    given_nodes,
)
from thymio_sim_ros.cli.ros.graph_choice import add_graph_options, check_ros
from thymio_sim_ros.cli.servers import address_argument, port_argument
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.end_signals import END_SIGNALS
from thymio_sim_ros.files import resources
from thymio_sim_ros.names.addresses import describe_urls
from thymio_sim_ros.names.domain import describe_range
from thymio_sim_ros.page_nodes.who import Who
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = ["run"]

PRELOADED = "thymio_sim_ros.cli.preload"

PORT = 8100
FIRST_DOMAIN = 1
LAST_DOMAIN = 232
"""The highest ROS domain whose ports exist (docs.ros.org, "The ROS_DOMAIN_ID")."""


def run(argv: Sequence[str]) -> int:
    """Run the class until Ctrl-C; return the exit code. Raises UsageError before anything starts."""
    given = _parser().parse_args(argv)
    try:
        names = read_pupils(given.pupils.read_bytes(), str(given.pupils))
    except OSError as error:
        raise UsageError(f"{given.pupils}: {error.strerror}; expected a CSV file with a name in each line") from error
    except ClassError as error:
        raise UsageError(str(error)) from error
    check_files(given.playground, given.program, "", THYMIO)
    options = SuiteOptions(given.playground, given.program, _first_domain(given), given_nodes(given) is Who.ALL)
    tls = given_certificate(given)
    proxies = TrustedProxies(given.trusted_proxy)
    place = ClassAddress(given.address, given.port, proxies, tls, has_room=not given.links_only)
    if options.first_domain is None:
        preload(PRELOADED, given.playground)
    with contextlib.ExitStack() as stack:
        path = given.folder or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="thymio-class-")))
        try:
            folder = ClassFolder(path)
            places = folder.places(names)
            classroom = Classroom(places, options, folder)
        except ClassError as error:
            raise UsageError(str(error)) from error
        except OSError as error:
            raise UsageError(f"{error.filename}: {error.strerror}; expected a file that can be written") from error
        _check_domains(options, places)
        check_port(place.address, place.port, "the class", "--port")
        with asyncio.Runner(loop_factory=asyncio.SelectorEventLoop) as runner:  # as `ServerThread`
            runner.run(_serve(place, classroom, is_kept=given.folder is not None))
    return 0


def _first_domain(given: argparse.Namespace) -> int | None:
    """The first ROS domain, None for the embedded graph. Raises UsageError for a missing ROS 2, or a useless domain."""
    if given.ros:
        check_ros()
        return FIRST_DOMAIN if given.first_domain is None else int(given.first_domain)
    if given.first_domain is not None:
        raise UsageError("--first-domain: expected --ros with it; without, no robot is in a ROS domain")
    return None


async def _serve(place: ClassAddress, classroom: Classroom, *, is_kept: bool) -> None:
    from thymio_sim_ros.classroom.server import serve_class  # aiohttp: not for the check of the command line

    listeners = listen(place.address, place.port)
    page = resources.page()
    tasks = [
        asyncio.create_task(classroom.run()),
        asyncio.create_task(serve_class(listeners, classroom, page, place)),
    ]
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    # Not `loop.add_signal_handler`, which Windows does not have: handlers run when the loop wakes there, twice a second
    for number in END_SIGNALS:
        signal.signal(number, lambda _number, _frame: loop.call_soon_threadsafe(stop.set))
    print_text(_banner(place, classroom, is_kept=is_kept))
    if page is None:
        print_text(resources.PAGE_BUILD_HINT)
    ended = asyncio.create_task(stop.wait())
    try:
        await asyncio.wait({ended, *tasks}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
        for listener in listeners:
            listener.close()
    for result in results:
        if isinstance(result, Exception):
            raise result


def _banner(place: ClassAddress, classroom: Classroom, *, is_kept: bool) -> str:
    folder, options = classroom.folder, classroom.options
    numbers = [seat.place.number for seat in classroom.seats.values()]
    keys = "the code or a link" if place.has_room else "a link"
    access = "this computer only" if place.is_loopback else f"everyone in your network with {keys}"
    at = place.scheme, place.address, place.port
    pupils = f"{describe_urls(*at, '/')}, code {folder.room_code}" if place.has_room else "by their links"
    room = "a QR code for the room, and " if place.has_room else ""
    kept = "kept" if is_kept else "lost at the end: keep them with --folder"
    if options.first_domain is None:
        graph = "embedded graphs: nodes of pupils reach their robots by `thymio-sim node`; --ros is for other ROS nodes"
    else:
        domains = sorted(options.first_domain + number for number in (numbers[0], numbers[-1]))
        graph = f"ROS_DOMAIN_ID {domains[0]} to {domains[1]}, {describe_range(discovery(os.environ))}"
    return "\n".join(
        [
            f"ROS       {graph}",
            f"Teacher   {describe_urls(*at, '/teacher/', folder.teacher_token)}",
            f"Pupils    {pupils}",
            f"Places    {len(numbers)}; the teacher's page has {room}a link for each pupil",
            f"Access    {access}",
            f"Programs  {kept}",
            "Stop      Ctrl-C",
        ]
    )


def _check_domains(options: SuiteOptions, places: Sequence[Place]) -> None:
    """Raise UsageError for domains that do not exist."""
    last = max(places, key=lambda place: place.number)
    if (domain := options.domain(last)) is not None and domain > LAST_DOMAIN:
        raise UsageError(
            f"--first-domain {options.first_domain}: the last domain would be {domain}, expected at most {LAST_DOMAIN}"
        )


def _domain_argument(text: str) -> int:
    number = int(text) if text.isascii() and text.isdigit() else -1
    if not 0 <= number <= LAST_DOMAIN:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a number from 0 to {LAST_DOMAIN}")
    return number


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim class",
        description="A class on one machine: a world, a page and a link for each pupil, and a page for the teacher "
        "(docs/classroom.md). Ctrl-C ends everything.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--pupils", type=path_argument, required=True, metavar="FILE.csv", help="names, one per line, or a column"
    )
    parser.add_argument(
        "--folder",
        type=path_argument,
        metavar="DIR",
        help="folder in which links and programs are kept from lesson to lesson (default: a temporary one)",
    )
    parser.add_argument(
        "--playground", default=SuiteConfig.playground, metavar="NAME|FILE", help="of all pupils (default: %(default)s)"
    )
    parser.add_argument(
        "--program",
        default=SuiteConfig.program,
        metavar="NAME|FILE",
        help="of pupils without a program of their own (default: %(default)s)",
    )
    parser.add_argument(
        "--address",
        type=address_argument,
        default=SuiteConfig.address,
        metavar="IPV4",
        help="address on which the class listens; 0.0.0.0 is the whole network (default: %(default)s)",
    )
    parser.add_argument(
        "--port",
        type=port_argument,
        default=PORT,
        help="port of the class, for the teacher and all pupils (default: %(default)s)",
    )
    parser.add_argument(
        "--links-only",
        action="store_true",
        help="no code of the room: pupils enter by their own links only, so that no one can choose another name",
    )
    add_nodes_option(parser)
    add_certificate_options(parser, "the class speaks")
    add_proxy_option(parser)
    add_graph_options(parser, default="the embedded graph, which takes half of the machine")
    parser.add_argument(
        "--first-domain",
        type=_domain_argument,
        metavar="ID",
        help=f"ROS domain of the first pupil, the others have the next ones (with --ros; default: {FIRST_DOMAIN})",
    )
    return parser
