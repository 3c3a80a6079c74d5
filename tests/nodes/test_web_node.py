"""The page's web server: files, configuration, what it says without a built page, and its port."""

from __future__ import annotations

import http.client
import json
import socket

import pytest

from thymio_sim_ros import resources
from thymio_sim_ros.nodes.life import StartError
from thymio_sim_ros.nodes.web_node import WebPage, WebParams
from thymio_sim_ros.sim import playground as playgrounds


@pytest.fixture
def built_page(tmp_path, monkeypatch):
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Thymio</title>")
    (tmp_path / "assets" / "main.js").write_text("export {}")
    (tmp_path.parent / "secret.txt").write_text("not for you")
    monkeypatch.setattr(resources, "page", lambda: tmp_path)


def get(port, path):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request("GET", path)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def test_the_page_and_its_configuration_are_served(ros, built_page):
    page = ros.live(WebPage(ros.context, WebParams(port=0, foxglove_port=1234)))
    response, body = get(page.port, "/")
    assert response.status == 200
    assert b"Thymio" in body
    assert response.headers["Cache-Control"] == "no-cache"
    response, body = get(page.port, "/config.json")
    assert json.loads(body)["foxglove_port"] == 1234
    response, _ = get(page.port, "/assets/main.js")
    assert response.headers["Content-Type"].startswith("text/javascript")


def test_shipped_playgrounds_are_served_with_their_pictures_inside(ros, built_page):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/playgrounds/line_gradient.json")
    assert response.status == 200
    assert response.headers["Content-Type"] == "application/json"
    served = playgrounds.loads(body, "line_gradient.json")
    assert served.shapes == playgrounds.load(resources.playgrounds()["line_gradient"]).shapes
    assert get(page.port, "/playgrounds/line_gradient.json")[1] == body


def test_a_playground_that_cannot_be_read_is_named_with_what_is_wrong(ros, built_page, tmp_path, monkeypatch):
    broken = tmp_path / "broken.json"
    broken.write_text('{"format": 1}')
    monkeypatch.setattr(resources, "playgrounds", lambda: {"broken": broken})
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/playgrounds/broken.json")
    assert response.status == 422
    assert b"title" in body


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/assets/",
        "/nothing",
        "/playgrounds/nothing.json",
        "/playgrounds/..%2fpyproject.json",
        "/playgrounds/playground.schema.json",
    ],
)
def test_nothing_outside_the_page_is_served(ros, built_page, path):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, path)
    assert response.status == 404
    assert b"not for you" not in body


def test_without_a_built_page_it_says_how_to_build_it(ros, monkeypatch):
    monkeypatch.setattr(resources, "page", lambda: None)
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/")
    assert response.status == 503
    assert resources.PAGE_BUILD_HINT in body.decode()


def test_a_port_in_use_is_one_clear_sentence(ros):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(StartError, match=f"{port} cannot be used"):
            WebPage(ros.context, WebParams(port=port))
