"""The HTTP interface of the teacher's page: request → action of the class → answer. Without sockets.

GET  class/state            pupils with what their robots do, see `Seat.summary`
GET  class/plans/<plan>     a playground seen from above, see `plan_of`
GET  class/sheet            names with links and their QR codes
GET  class/room             address and code with which pupils pick a name, and the QR code of both; not with links only
GET  class/programs.zip     the programs of all pupils
GET  class/missing          names of the pupils without one
GET  class/handouts         what was handed out, and how far each pupil is
GET  class/handouts/<id>    a link with which pupils of the class open a hand-out, and its QR code
GET  class/results.csv      how far each pupil is, for a spreadsheet
POST class/<action>         {"pupils": [ids] or null for all, …}; actions: see `_ACTIONS`
"""

from __future__ import annotations

import asyncio
import base64
import io
import json
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from thymio_sim_ros.access import RefusedError, Visitor
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import MAX_MESSAGE, Classroom
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.handouts import KINDS, MAX_CONTENT, Handout, check_time, checked_content

__all__ = ["MAX_BODY", "Answer", "answer", "opened"]

MAX_BODY = MAX_CONTENT * 4 // 3 + 100_000
"""Bytes of a request's body."""
_JSON = "application/json"


@dataclass(frozen=True, slots=True)
class Answer:
    """Body and media type of an answer with status 200; `file` is the name under which a browser saves it."""

    body: bytes
    media_type: str = _JSON
    file: str = ""


async def answer(
    classroom: Classroom, place: ClassAddress, visitor: Visitor, method: str, name: str, body: bytes
) -> Answer:
    """Carry out a request of a visitor; `name` is its path after `class/`. Raises RefusedError."""
    if method == "GET":
        return await _read(classroom, place, name, place.public_url(visitor))
    if method != "POST":
        raise RefusedError(405, f"found {method[:20]}, expected GET or POST")
    act = _ACTIONS.get(name)
    if act is None:
        raise RefusedError(404, f"found no such action; expected {', '.join(_ACTIONS)}")
    try:
        fields = json.loads(body or b"{}")
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, f"not JSON: {error}") from error
    if not isinstance(fields, dict):
        raise RefusedError(400, "expected a JSON object")
    await act(classroom, fields)
    return _json({})


async def opened(classroom: Classroom, pupil: str, number: str) -> Answer:
    """A hand-out that a pupil opens: kind, name and content in base64. Raises RefusedError."""
    handout = classroom.handouts.find(number)
    if handout is None:
        raise RefusedError(404, "Your teacher has taken this back.")
    try:
        content = base64.b64encode(await classroom.open(pupil, handout)).decode()
    except OSError as error:
        raise _not_kept(error) from error
    return _json({"kind": handout.kind, "name": handout.name, "content": content})


async def _read(classroom: Classroom, place: ClassAddress, name: str, url: str) -> Answer:
    if name == "state":
        return _json({**classroom.state(), "has_room": place.has_room})
    if name == "sheet":
        seats = classroom.seats.values()
        return _json([{"name": seat.place.name, **_with_qr_code(f"{url}p/{seat.link()}")} for seat in seats])
    if name == "room" and place.has_room:
        code = classroom.folder.room_code
        return _json({"address": url, "code": code, **_with_qr_code(f"{url}#token={code}")})
    if name == "programs.zip":
        return Answer(classroom.programs(), "application/zip", "programs.zip")
    if name == "missing":
        return _json(classroom.missing())
    if name == "results.csv":
        return Answer(f"\ufeff{classroom.table()}".encode(), "text/csv; charset=utf-8", "results.csv")
    if name == "handouts":
        return _json(_handouts(classroom))
    number = name.removeprefix("handouts/")
    if name != number and place.has_room and (handout := classroom.handouts.find(number)):
        code = classroom.folder.room_code
        return _json({"name": handout.name, **_with_qr_code(f"{url}#token={code}&handout={handout.id}")})
    if name.startswith("plans/") and (plan := await classroom.plan(name.removeprefix("plans/"))) is not None:
        return _json(plan)
    raise RefusedError(404, "there is no such document")


async def _pause(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    paused = fields.get("paused")
    if not isinstance(paused, bool):
        raise RefusedError(400, "paused: expected true or false")
    await classroom.pause(_pupils(classroom, fields), paused=paused)


async def _restart(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    await classroom.restart(_pupils(classroom, fields))


async def _message(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    text = fields.get("text")
    if not isinstance(text, str) or len(text) > MAX_MESSAGE:
        raise RefusedError(400, f"text: expected a text of at most {MAX_MESSAGE} characters")
    await classroom.message(_pupils(classroom, fields), text.strip())


async def _show(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    shown = fields.get("pupil")
    if shown is not None and not (isinstance(shown, str) and shown in classroom.seats):
        raise RefusedError(400, "pupil: expected the id of a pupil, or null")
    await classroom.show(shown)


async def _lower(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    await classroom.lower_hands(_pupils(classroom, fields))


async def _hand_out(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    kind, name, content, due = (fields.get(key) for key in ("kind", "name", "content", "due"))
    title = fields.get("title", "")
    if kind not in KINDS:
        raise RefusedError(400, f"kind: expected {', '.join(KINDS)}")
    if not isinstance(name, str) or not isinstance(content, str) or not isinstance(title, str):
        raise RefusedError(400, "name, content, title: expected texts")
    if not isinstance(due, str):
        raise RefusedError(400, "due: expected a time, or an empty text")
    if due:
        try:
            check_time(due)
        except ValueError as error:
            raise RefusedError(400, f"due: {error}") from error
    solution_of = "" if fields.get("solution_of") in (None, "") else _handout(classroom, fields, "solution_of").id
    pupils = _pupils(classroom, fields)
    try:
        data = await asyncio.to_thread(checked_content, kind, name, content)
        await classroom.hand_out(
            classroom.handouts.add(kind, name, data, pupils, due=due, solution_of=solution_of, title=title)
        )
    except ClassError as error:
        raise RefusedError(400, str(error)) from error
    except OSError as error:
        raise _not_kept(error) from error


def _not_kept(error: OSError) -> RefusedError:
    return RefusedError(507, f"{error.filename}: {error.strerror}; expected a folder of the class with room")


async def _take_back(classroom: Classroom, fields: Mapping[str, Any]) -> None:
    handout = _handout(classroom, fields, "handout")
    try:
        classroom.handouts.remove(handout)
    except OSError as error:
        raise _not_kept(error) from error
    await classroom.hand_out(handout)


def _handout(classroom: Classroom, fields: Mapping[str, Any], key: str) -> Handout:
    """The hand-out that a request is for."""
    number = fields.get(key)
    handout = classroom.handouts.find(number) if isinstance(number, str) else None
    if handout is None:
        raise RefusedError(400, f"{key}: expected the id of a hand-out")
    return handout


def _handouts(classroom: Classroom) -> list[Mapping[str, Any]]:
    """The hand-outs with the progress of their pupils, by id."""
    progress: dict[str, dict[str, Any]] = {handout.id: {} for handout in classroom.handouts.all()}
    for handout, seat, reached in classroom.results():
        late = handout.is_late(reached.passed or reached.changed)
        progress[handout.id][seat.place.id] = {**asdict(reached), "late": late}
    return [{**asdict(handout), "progress": progress[handout.id]} for handout in classroom.handouts.all()]


_ACTIONS: Mapping[str, Callable[[Classroom, Mapping[str, Any]], Awaitable[None]]] = {
    "pause": _pause,
    "restart": _restart,
    "message": _message,
    "show": _show,
    "lower": _lower,
    "handout": _hand_out,
    "take_back": _take_back,
}


def _pupils(classroom: Classroom, fields: Mapping[str, Any]) -> list[str]:
    """The ids of the pupils that a request is for."""
    ids = fields.get("pupils")
    if ids is None:
        return list(classroom.seats)
    if not isinstance(ids, list) or not all(isinstance(pupil, str) and pupil in classroom.seats for pupil in ids):
        raise RefusedError(400, "pupils: expected ids of pupils, or null for all")
    return ids


def _with_qr_code(url: str) -> dict[str, str]:
    """A URL, and its QR code as an SVG image: "" where the library is not installed."""
    try:
        import segno
    except ImportError:
        return {"url": url, "qr": ""}
    drawn = io.BytesIO()
    segno.make_qr(url, error="m").save(drawn, kind="svg", border=2, xmldecl=False, svgns=True)
    return {"url": url, "qr": drawn.getvalue().decode()}


def _json(value: Any) -> Answer:
    return Answer(json.dumps(value, separators=(",", ":")).encode())
