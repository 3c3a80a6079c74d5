"""All seats of a class, and what the teacher does to them."""

from __future__ import annotations

import asyncio
import csv
import io
import os
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from thymio_sim_ros.classroom.folder import ClassFolder, Place
from thymio_sim_ros.classroom.handouts import Handout, Handouts
from thymio_sim_ros.classroom.plan import plan_of
from thymio_sim_ros.classroom.progress import Progress
from thymio_sim_ros.classroom.pupils import archive_name
from thymio_sim_ros.classroom.seat import Notice, Seat
from thymio_sim_ros.classroom.suite_process import SuiteOptions
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files.loading import load_playground

__all__ = ["MAX_MESSAGE", "WATCHED_S", "Classroom"]

WATCHED_S = 5.0
"""The teacher's page counts as open for this time after its last request."""
STARTS, STARTS_ROS = 4, 1
"""Suites that start at the same time for each core, on embedded graphs and with ROS 2: the first ones mostly wait."""
MAX_MESSAGE = 500
"""Characters of a message."""
_PLANS = 64
"""Plans of playgrounds that are kept."""


class Classroom:
    """The class while it runs. Only for the thread of the event loop."""

    def __init__(self, places: Sequence[Place], options: SuiteOptions, folder: ClassFolder) -> None:
        """Read what was handed out. Raises ClassError and OSError for files of the folder that cannot be used."""
        at_once = STARTS if options.first_domain is None else STARTS_ROS
        starting = asyncio.Semaphore(at_once * (os.cpu_count() or 1))
        self.options, self.folder = options, folder
        self.handouts = Handouts(folder.handouts)
        self.seats = {place.id: Seat(place, options, folder, self.handouts, starting) for place in places}
        self._messages: dict[str, str] = {}
        self._shown: str | None = None
        self._plans: dict[str, dict[str, Any]] = {}
        self._asked_s = float("-inf")

    async def run(self) -> None:
        """Keep all suites running until this task is cancelled, which ends them."""
        tasks = [asyncio.create_task(seat.run()) for seat in self.seats.values()]
        tasks.append(asyncio.create_task(self._follow_watching()))
        try:
            await asyncio.gather(*tasks)
        except Exception:  # a canceled `gather` has canceled them: a second time would interrupt the end of the suites
            for task in tasks:
                task.cancel()
            raise
        finally:
            await asyncio.gather(*tasks, return_exceptions=True)

    def state(self) -> Mapping[str, Any]:
        """The data that the teacher's page shows; poses are received from now on for a while."""
        self._asked_s = asyncio.get_running_loop().time()
        pupils = [{**seat.summary(), "notice": self._messages.get(pupil, "")} for pupil, seat in self.seats.items()]
        return {"pupils": pupils, "shown": self._shown}

    def room(self) -> Sequence[Mapping[str, str]]:
        """The names on the page of the room, each with its link from there."""
        return [{"name": seat.place.name, "link": f"p/{seat.link()}"} for seat in self.seats.values()]

    async def plan(self, number: str) -> Mapping[str, Any] | None:
        """A playground seen from above by the `plan` of a pupil; None if there is none that can be read."""
        seat = next((seat for seat in self.seats.values() if seat.plan == number), None)
        if number not in self._plans and seat is not None:
            try:
                plan = await asyncio.to_thread(lambda: plan_of(load_playground(seat.playground)[1]))
            except (ThymioSimError, OSError):
                return None
            if len(self._plans) >= _PLANS:
                del self._plans[next(iter(self._plans))]
            self._plans[number] = plan
        return self._plans.get(number)

    async def pause(self, ids: Iterable[str], *, paused: bool) -> None:
        """Pause the worlds of these pupils, or let them run."""
        await asyncio.gather(*(self.seats[pupil].pause(paused=paused) for pupil in ids))

    async def restart(self, ids: Iterable[str]) -> None:
        """Start the suites of these pupils anew, with their programs."""
        await asyncio.gather(*(self.seats[pupil].restart() for pupil in ids))

    async def message(self, ids: Iterable[str], text: str) -> None:
        """Show a message on the pages of these pupils; an empty one removes it."""
        chosen = list(ids)
        self._messages |= dict.fromkeys(chosen, text)
        await self._show_notices(chosen)

    async def show(self, shown: str | None) -> None:
        """Offer a look at one pupil's robot on the pages of all others; None ends that."""
        self._shown = shown
        await self._show_notices(self.seats)

    async def hand_out(self, handout: Handout) -> None:
        """Show a hand-out, or that it was taken back, on the pages of its pupils."""
        await asyncio.gather(*(self.seats[one].show_handouts() for one in handout.pupils if one in self.seats))

    async def open(self, pupil: str, handout: Handout) -> bytes:
        """The content of a hand-out that a pupil opens, also one who has it by a link. Raises OSError."""
        content = await asyncio.to_thread(self.handouts.content, handout)
        await self.seats[pupil].open(self.handouts.give(handout, pupil))
        return content

    async def lower_hands(self, ids: Iterable[str]) -> None:
        """Lower the hands that these pupils have raised."""
        await asyncio.gather(*(self.seats[pupil].lower_hand() for pupil in ids))

    def results(self) -> list[tuple[Handout, Seat, Progress]]:
        """How far each pupil is with each hand-out that the pupil has."""
        return [
            (handout, seat, seat.progress.of(handout))
            for handout in self.handouts.all()
            for pupil, seat in self.seats.items()
            if pupil in handout.pupils
        ]

    def table(self) -> str:
        """The results as CSV."""
        rows = io.StringIO()
        writer = csv.writer(rows)
        columns = "pupil,handout,kind,given,due,opened,tries,stars,passed,best_s,changed,late"
        writer.writerow(columns.split(","))
        for handout, seat, progress in self.results():
            at = [progress.opened, progress.tries, progress.stars, progress.passed, progress.best_s, progress.changed]
            late = "yes" if handout.is_late(progress.passed or progress.changed) else ""
            writer.writerow([seat.place.name, handout.name, handout.kind, handout.given, handout.due, *at, late])
        return rows.getvalue()

    def programs(self) -> bytes:
        """A zip with a folder for each pupil, which `thymio-sim grade` reads.

        It has the program that ran last, a different text of the editor, a ROS node in Python, and the programs and
        nodes for hand-outs under the names of these. The folder of a pupil without any of it is empty.
        """
        packed = io.BytesIO()
        folders: list[str] = []
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for seat in self.seats.values():
                folders.append(archive_name(seat.place.name, folders))
                archive.mkdir(folders[-1])
                for name, text in self._files(seat):
                    archive.writestr(f"{folders[-1]}/{name}", text)
        return packed.getvalue()

    def _files(self, seat: Seat) -> Iterator[tuple[str, str]]:
        """The names and texts of what a pupil has written."""
        work = self.folder.work(seat.place)
        if work.program is not None:
            yield "program.aesl", work.program
        if work.draft is not None and work.draft != work.program:
            yield "draft.aesl", work.draft
        nodes = []
        for handout in self.handouts.all():
            if (text := seat.progress.program(handout)) is not None:
                yield f"{handout.stem}.aesl", text
            if (text := seat.progress.node(handout)) is not None:
                nodes.append(text)
                yield f"{handout.stem}.py", text
        if work.node is not None and work.node not in nodes:
            yield "draft.py", work.node

    def missing(self) -> list[str]:
        """The names of the pupils who have neither run a program nor written one."""
        works = {seat.place.name: self.folder.work(seat.place) for seat in self.seats.values()}
        return [name for name, work in works.items() if (work.program, work.draft, work.node) == (None, None, None)]

    async def _show_notices(self, ids: Iterable[str]) -> None:
        await asyncio.gather(*(self.seats[pupil].show(self._notice(pupil)) for pupil in ids))

    def _notice(self, pupil: str) -> Notice:
        text = self._messages.get(pupil, "")
        if self._shown is None or self._shown == pupil:
            return Notice(text)
        shown = self.seats[self._shown]
        return Notice(text or shown.place.name, f"../{shown.link(read_only=True)}")

    async def _follow_watching(self) -> None:
        """Receive poses while the teacher's page is open."""
        while True:
            is_watched = asyncio.get_running_loop().time() - self._asked_s < WATCHED_S
            await asyncio.gather(*(seat.watch_overview(wanted=is_watched) for seat in self.seats.values()))
            await asyncio.sleep(0.5)
