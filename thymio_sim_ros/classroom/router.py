"""The one port of a class: path → the page to pick a name, the teacher's page, or a pupil's page and suite.

/                 the page on which a pupil picks a name; room/names is its list, which needs the code of the room,
                  room says whether there is a code
/teacher/         the teacher's page; teacher/class/… is its interface (`requests`), which needs the teacher's token
/p/<id>/          a pupil: files of the page come from here, all other requests are passed on to the suite, except
                  p/<id>/class/handouts/<id>, a file that was handed out, which needs the pupil's token
"""

from __future__ import annotations

import json
import urllib.parse
from collections.abc import Mapping, Sequence

from aiohttp import web

from thymio_sim_ros.access import AccessCheck, AccessRules, RefusedError, Tokens, Visitor
from thymio_sim_ros.access.check import Report
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.requests import MAX_BODY, Answer, answer, opened
from thymio_sim_ros.classroom.seat import Seat
from thymio_sim_ros.classroom.suite_proxy import SuiteProxy, is_upgrade
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, start_answer, text_response
from thymio_sim_ros.web.server import Page

__all__ = ["Router"]

_CONFIG = "/config.json"
"""A file of the suite: it says whether the suite answers."""


class Router:
    """Creates the responses to requests."""

    def __init__(
        self,
        classroom: Classroom,
        page: Page,
        proxy: SuiteProxy,
        place: ClassAddress,
        report: Report,
    ) -> None:
        """`report`: as `Page`."""
        self._classroom, self._page, self._proxy = classroom, page, proxy
        self._teacher = _check(classroom.folder.teacher_token, "token of the teacher", report)
        self._room = _check(classroom.folder.room_code, "code of the room", report)
        self._pupils = {
            pupil: _check(seat.place.token, "token of the pupil", report) for pupil, seat in classroom.seats.items()
        }
        self._place = place

    async def answer(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request."""
        visitor = self._place.trusted_proxies.visitor_of(request)
        if (refusal := self._page.refusal(request, visitor)) is not None:
            return refusal
        try:
            return await self._route(request, visitor)
        except RefusedError as error:
            start_answer(request)
            response = text_response(error.status, str(error))
            response.force_close()  # the rest of a body may still arrive
            return response

    async def _route(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        path, mark, query = request.raw_path.partition("?")
        match names := _names(path):
            case ["teacher"]:
                return _redirect(request, f"teacher/{mark}{query}")
            case ["teacher", "class", *rest]:
                await self._teacher.role(visitor)
                body = await _body(request)
                return _response(
                    await answer(self._classroom, self._place, visitor, request.method, "/".join(rest), body)
                )
            case ["teacher", *rest]:
                return await self._page.answer(request, visitor, _file(rest, "class.html"))
            case ["room"]:
                start_answer(request)
                return _response(Answer(json.dumps({"has_code": self._place.has_room}).encode()))
            case ["room", "names"] if self._place.has_room:
                await self._room.role(visitor)
                start_answer(request)
                return _response(Answer(json.dumps(self._classroom.room()).encode()))
            case ["p", pupil] if pupil in self._classroom.seats:
                return _redirect(request, f"{pupil}/{mark}{query}")
            case ["p", pupil, "class", "handouts", number] if pupil in self._classroom.seats:
                await self._pupils[pupil].role(visitor)
                start_answer(request)
                return _response(await opened(self._classroom, pupil, number))
            case ["p", pupil, *rest] if pupil in self._classroom.seats:
                seat = self._classroom.seats[pupil]
                return await self._of_pupil(request, visitor, seat, f"{_file(rest, '')}{mark}{query}")
            case [first, *_] if first != "p":
                return await self._page.answer(request, visitor, _file(names, "join.html"))
        raise RefusedError(404, "There is no such page in this class.")

    async def _of_pupil(
        self, request: web.BaseRequest, visitor: Visitor, seat: Seat, target: str
    ) -> web.StreamResponse:
        path = target.partition("?")[0]
        if request.method in ("GET", "HEAD") and path != _CONFIG and not is_upgrade(request):
            file = await self._page.file(request, visitor, "/index.html" if path == "/" else path)
            if file is not None:
                return file
        return await self._proxy.forward(request, target, seat.port, visitor, seat.place.name)


def _check(token: str, what: str, report: Report) -> AccessCheck:
    """Lets in who has a token. It counts in the header Authorization only, which no foreign page can send."""
    hint = f"expected the {what}: Authorization: Bearer …"
    return AccessCheck(AccessRules(Tokens(token), allows_page_token=False, token_hint=hint), report)


def _names(path: str) -> Sequence[str]:
    """The parts of a path, with their escapes; none for a path that leads out of its folder."""
    names = path.removeprefix("/").split("/")
    plain = [urllib.parse.unquote(name) for name in names]
    if not path.startswith("/") or any(name in (".", "..") or "/" in name or "\\" in name for name in plain):
        return ()
    return names


def _file(names: Sequence[str], index: str) -> str:
    """The path of a file; that of its folder means `index`."""
    return f"/{'/'.join(names) or index}"


def _redirect(request: web.BaseRequest, place: str) -> web.StreamResponse:
    """To a place relative to the requested one: a proxy may serve it under another path."""
    start_answer(request)
    return text_response(308, place, {"Location": place})


def _response(done: Answer) -> web.StreamResponse:
    headers: Mapping[str, str] = {**COMMON_HEADERS, "Content-Type": done.media_type, "Cache-Control": "no-store"}
    file = {"Content-Disposition": f'attachment; filename="{done.file}"'} if done.file else {}
    return web.Response(body=done.body, headers={**headers, **file})


async def _body(request: web.BaseRequest) -> bytes:
    body = bytearray()
    if request.body_exists:
        async for chunk in request.content.iter_any():
            body += chunk
            if len(body) > MAX_BODY:
                raise RefusedError(413, f"expected a body of at most {MAX_BODY} bytes")
    start_answer(request)
    return bytes(body)
