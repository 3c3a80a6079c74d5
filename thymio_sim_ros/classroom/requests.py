"""The HTTP interface of the teacher's page: request → action of the class → answer. Without sockets.

GET  class/state            pupils with what their robots do, see `Seat.summary`
GET  class/plans/<plan>     a playground seen from above, see `plan_of`
GET  class/sheet            names with links and their QR codes
GET  class/room             address and code with which pupils pick a name, and the QR code of both; not with links only
GET  class/programs.zip     the programs of all pupils
GET  class/missing          names of the pupils without one
POST class/<action>         {"pupils": [ids] or null for all, …}; actions: see `_ACTIONS`
"""

from __future__ import annotations

import io
import json
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.access import RefusedError, Visitor
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import MAX_MESSAGE, Classroom

__all__ = ["MAX_BODY", "Answer", "answer"]

MAX_BODY = 100_000
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


_ACTIONS: Mapping[str, Callable[[Classroom, Mapping[str, Any]], Awaitable[None]]] = {
    "pause": _pause,
    "restart": _restart,
    "message": _message,
    "show": _show,
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
