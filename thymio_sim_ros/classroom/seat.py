"""A pupil's place: keeps the suite running, and the work.

A suite that ends, or that does not answer, is started again with its program and playground. Each end within `STEADY_S`
doubles the wait, so that a suite that cannot run takes little time from the others. From the second one on, the
playground is that of the class: it may be the reason.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import logging
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from websockets.exceptions import WebSocketException

from thymio_sim_ros.classroom.bridge_client import (
    DRAFT,
    NODE_DRAFT,
    PLAYGROUND,
    PROGRAM_NAME,
    RAISED_HAND,
    SOURCE,
    BridgeClient,
    SuiteStatus,
)
from thymio_sim_ros.classroom.folder import ClassFolder, Place, Work
from thymio_sim_ros.classroom.handouts import Handout, Handouts, now
from thymio_sim_ros.classroom.many_tries import TryHistory
from thymio_sim_ros.classroom.progress import ProgressLog
from thymio_sim_ros.classroom.suite_process import SuiteOptions, SuiteProcess, command, environment, free_port
from thymio_sim_ros.classroom.suite_state import MissionTry
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import NO_PROGRAM, is_playground_text

__all__ = ["FIRST_WAIT_S", "MAX_WAIT_S", "START_S", "STEADY_S", "Notice", "Seat", "next_wait_s"]

FIRST_WAIT_S, MAX_WAIT_S = 1.0, 60.0
"""Time before the first restart, and the longest one."""
STEADY_S = 60.0
"""A suite that has run for this time counts as working: its next restart comes soon."""
START_S = 90.0
"""Time until a suite that has started must answer; long, for twenty that start together."""
RECONNECT_S = 10.0
"""Time until a suite whose connection was lost must answer again."""
_CONNECT_S = 0.3


_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Notice:
    """A message on a page: a text, and a link."""

    text: str = ""
    link: str = ""


def next_wait_s(wait_s: float, ran_s: float) -> float:
    """The time before the next restart of a suite that ran for `ran_s`, after one of `wait_s` (0: none yet)."""
    return FIRST_WAIT_S if ran_s >= STEADY_S or wait_s == 0.0 else min(MAX_WAIT_S, 2 * wait_s)


class Seat:
    """Supervises one suite. `run` keeps it running until it is cancelled. Only for the thread of the event loop."""

    def __init__(
        self,
        place: Place,
        options: SuiteOptions,
        folder: ClassFolder,
        handouts: Handouts,
        starting: asyncio.Semaphore | None = None,
    ) -> None:
        """`starting` limits how many suites start at the same time. Raises OSError."""
        self.place = place
        self.progress = ProgressLog(folder.pupil(place))
        """How far the pupil is with what was handed out."""
        self.hand = ""
        """When the pupil raised a hand (ISO 8601); "": it is not raised."""
        self._tries = TryHistory()
        self._handouts = handouts
        self._options, self._folder = options, folder
        self._starting = starting or asyncio.Semaphore(1)
        self._client: BridgeClient | None = None
        self._process: SuiteProcess | None = None
        self._asked = asyncio.Event()
        self._wants_overview = False
        self._notice = Notice()
        self._wants_pause = False
        self._work = Work()
        self._set_playground(options.playground)
        self.port = 0
        """Port of the suite on loopback, a new one for each start; 0: it has not started yet."""
        self.phase = "waiting"
        """waiting (for its turn to start), starting, running, or broken: waits before the next restart."""
        self.restarts = 0
        self.reason = ""
        """Why the suite has ended last."""

    @property
    def status(self) -> SuiteStatus:
        """The last report of the suite, empty while it does not run."""
        return SuiteStatus() if self._client is None else self._client.status

    @property
    def pid(self) -> int | None:
        """Process id of the suite, None while there is none."""
        return None if self._process is None else self._process.pid

    def link(self, *, read_only: bool = False) -> str:
        """Address of the pupil's page with the token, relative to the folder `p/` of the class."""
        token = self.place.read_only_token if read_only else self.place.token
        return f"{self.place.id}/#token={token}"

    async def run(self) -> None:
        """Keep the suite running until this task is cancelled, which ends the suite."""
        clock_s = asyncio.get_running_loop().time
        wait_s = 0.0
        try:
            while True:
                began_s = clock_s()
                try:
                    async with self._starting:
                        began_s = clock_s()
                        self.phase = "starting"
                        await self._start(is_steady=wait_s <= FIRST_WAIT_S)
                        serving = asyncio.create_task(self._serve())
                        await self._until_ready(serving)
                    reason = await self._until_end(serving)
                    self._process = None  # not if this task is cancelled: then it still has to be ended
                except OSError as error:  # its files cannot be read or written, or there is no process for it
                    reason = f"{error.filename or self.place.name}: {error.strerror}"
                if self._asked.is_set():
                    self._asked.clear()
                    wait_s, self.phase = 0.0, "waiting"
                    continue
                self.restarts += 1
                self.reason, self.phase = reason, "broken"
                wait_s = next_wait_s(wait_s, clock_s() - began_s)
                with contextlib.suppress(TimeoutError):  # asked to restart: at once
                    await asyncio.wait_for(self._asked.wait(), wait_s)
                self._asked.clear()
        finally:
            if self._process is not None:
                await self._process.end()

    async def restart(self) -> None:
        """Start the suite anew, also before the wait after a crash is over."""
        self.reason = ""
        self._asked.set()

    async def pause(self, *, paused: bool) -> None:
        """Pause the world or let it run. A pause holds until this lets it run, also after a restart of the suite."""
        self._wants_pause = paused
        await self._show_page()
        if self._client is not None:
            await self._attempt(self._client.pause(paused=paused))

    async def lower_hand(self) -> None:
        """The teacher has seen the raised hand."""
        self.hand = ""
        await self._show_page()

    async def open(self, handout: Handout) -> None:
        """The pupil has opened a hand-out. Raises OSError."""
        self.progress.open(handout)
        await self._show_page()

    async def show_handouts(self) -> None:
        """Show on the page what is handed out now."""
        await self._show_page()

    async def show(self, notice: Notice) -> None:
        """Show a notice on the page; a suite that is restarted shows it too."""
        self._notice = notice
        await self._show_page()

    async def watch_overview(self, *, wanted: bool) -> None:
        """Receive poses, or no longer."""
        self._wants_overview = wanted
        if self._client is not None:
            await self._attempt(self._client.watch_overview(wanted=wanted))

    async def _show_page(self) -> None:
        if self._client is not None:
            await self._attempt(self._client.set_page(self._page))

    @property
    def _page(self) -> Mapping[str, str | bool]:
        """The data about the class that the page shows, as parameters of its node."""
        return {
            "pupil": self.place.name,
            "paused_by_teacher": self._wants_pause,
            "notice_link": self._notice.link,
            "notice": self._notice.text,
            "raised_hand": self.hand != "",
            "handouts": json.dumps([self._shown(handout) for handout in self._handouts.of(self.place.id)]),
        }

    def _shown(self, handout: Handout) -> Mapping[str, Any]:
        """What the page of the pupil shows of a hand-out."""
        progress = self.progress.of(handout)
        solved = self._handouts.find(handout.solution_of)
        return {
            "id": handout.id,
            "kind": handout.kind,
            "name": handout.title or handout.name,
            "due": handout.due,
            "solution_of": "" if solved is None else solved.title or solved.name,
            "opened": progress.opened != "",
            "stars": progress.stars,
        }

    async def _start(self, *, is_steady: bool) -> None:
        work = self._work = self._folder.work(self.place)
        is_of_class = work.class_playground != self._options.playground or not is_steady
        self._set_playground(self._options.playground if is_of_class else work.playground)
        program = self._options.program if work.program is None else NO_PROGRAM
        parameters = self._folder.write_parameters(self.place, _parameters(work, is_of_class=is_of_class))
        self.port = free_port()
        self._process = await SuiteProcess.start(
            command(self._options, self.port, program, parameters),
            environment(self._options, self.place, os.environ),
            self._folder.pupil(self.place) / "suite.log",
        )

    async def _serve(self) -> None:
        """Follow the suite by its bridge; returns when it does not answer any more."""
        url = f"ws://127.0.0.1:{self.port}/"
        clock_s = asyncio.get_running_loop().time
        end_s = clock_s() + START_S
        try:
            while clock_s() < end_s:
                client = self._client = BridgeClient(url, self.place.token, self._on_parameter, self._on_try)
                greeting = asyncio.create_task(self._greet(client))
                try:
                    await client.run()
                except (OSError, WebSocketException):
                    if client.status.state is not None:  # a connection that worked is lost: perhaps only that
                        end_s = clock_s() + RECONNECT_S
                    await asyncio.sleep(_CONNECT_S)
                finally:
                    greeting.cancel()
        finally:
            self._client = None

    async def _greet(self, client: BridgeClient) -> None:
        """Bring a suite that has started to the state that the teacher wants."""
        await client.is_ready.wait()
        self.phase = "running"
        await client.watch_overview(wanted=self._wants_overview)
        await client.set_page(self._page)
        while True:  # a pupil can let time run by other ways than the page, which locks its button
            client.has_changed.clear()
            state = client.status.state
            if self._wants_pause and state is not None and not state.paused:
                await client.pause(paused=True)
            await client.has_changed.wait()

    async def _until_ready(self, serving: asyncio.Task[None]) -> None:
        assert self._process is not None
        ended = asyncio.create_task(self._process.wait())
        asked = asyncio.create_task(self._asked.wait())
        while self.phase == "starting" and not (ended.done() or serving.done() or asked.done()):
            await asyncio.wait({ended, serving, asked}, timeout=_CONNECT_S, return_when=asyncio.FIRST_COMPLETED)
        ended.cancel()
        asked.cancel()

    async def _until_end(self, serving: asyncio.Task[None]) -> str:
        """Wait until the suite ends, does not answer, or is to be restarted; end it and return the reason."""
        assert self._process is not None
        process = self._process
        ended = asyncio.create_task(process.wait())
        asked = asyncio.create_task(self._asked.wait())
        try:
            await asyncio.wait({ended, serving, asked}, return_when=asyncio.FIRST_COMPLETED)
            if asked.done():
                await process.end()
            elif not ended.done():
                # A bridge that ends first says nothing: the reason is that of the process, if it ends, too.
                await asyncio.wait({ended}, timeout=_CONNECT_S * 10)
                if not ended.done():
                    process.kill()
                    return "did not answer"
            return await ended
        finally:
            for task in (ended, asked, serving):
                task.cancel()

    def _on_parameter(self, name: str, value: str | bool) -> None:
        if isinstance(value, bool):
            # A suite that has just started does not know yet that the hand is raised.
            if name == RAISED_HAND and self.phase == "running" and value != (self.hand != ""):
                self.hand = now() if value else ""
            return
        work = self._work
        # A path that a node of the pupil has set is not opened here.
        if name == PLAYGROUND and (is_playground_text(value) or value in resources.playgrounds()):
            self._set_playground(value)
            work = replace(work, playground=value, class_playground=self._options.playground)
        elif name == DRAFT and value:
            work = replace(work, draft=value)
        elif name == NODE_DRAFT and value:
            work = replace(work, node=value)
        elif name == PROGRAM_NAME and value:
            work = replace(work, program_name=value)
        elif name == SOURCE and value:
            work = replace(work, program=value)
        if work == self._work:
            return
        self._work = work
        with self._reporting():
            self._folder.keep(self.place, work)
            handout = self._handouts.find(self.progress.current)
            if handout is not None and name == SOURCE:
                self.progress.run(handout, value)
            elif handout is not None and name == NODE_DRAFT:
                self.progress.write_node(handout, value)

    def _on_try(self, attempt: MissionTry) -> None:
        self._tries.add(attempt)
        with self._reporting():
            of_class = self._handouts.of(self.place.id)
            handout = next((one for one in of_class if self._handouts.is_tried(one, attempt)), None)
            if handout is not None:
                self.progress.tried(handout, attempt)

    @contextlib.contextmanager
    def _reporting(self) -> Iterator[None]:
        """Report files that cannot be written: the lesson goes on."""
        try:
            yield
        except OSError as error:
            _log.error("the work of %s is not kept: %s: %s", self.place.name, error.filename, error.strerror)

    def _set_playground(self, value: str) -> None:
        self.playground = value
        """The playground of the suite, as `load_playground` takes it."""
        self.plan = hashlib.sha256(value.encode("utf-8", "surrogatepass")).hexdigest()[:16]
        """Names it; the same for the same playground."""

    def _trouble(self) -> str:
        """What hinders the pupil in the mission that is open: that of the robot, or else "tries" (see `TryHistory`)."""
        attempt = self.status.attempt
        if attempt is None:
            return ""
        return attempt.trouble or ("tries" if self._tries.is_stuck else "")

    async def _attempt(self, request: Any) -> None:
        with contextlib.suppress(OSError, WebSocketException):  # the suite has just ended, and is restarted
            await request

    def summary(self) -> Mapping[str, Any]:
        """The data about this pupil that the teacher's page shows, as JSON values."""
        state, client = self.status.state, self.status
        programs = [
            {key: values.get(key, "") for key in ("state", "program", "line", "fault")}
            for values in client.programs.values()
        ]
        return {
            "id": self.place.id,
            "name": self.place.name,
            "phase": self.phase,
            "reason": self.reason,
            "restarts": self.restarts,
            "paused": state is not None and state.paused,
            "held": self._wants_pause,
            "achieved": 0.0 if state is None else state.achieved,
            "fallen": [] if state is None else state.fallen,
            "programs": programs,
            "overview": client.overview,
            "hand": self.hand,
            "trouble": self._trouble(),
            "plan": self.plan,
            "link": f"../p/{self.link()}",
            "watch": f"../p/{self.link(read_only=True)}",
        }


def _parameters(work: Work, *, is_of_class: bool) -> Mapping[str, Mapping[str, str]]:
    """The parameters by which a suite starts with what a pupil has made, by node and name."""
    program = {} if work.program is None else {"script.source": work.program, "script.name": work.program_name}
    return {"aseba_runtime": program, "simulator": {} if is_of_class else {"playground": work.playground}}
