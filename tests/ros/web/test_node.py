"""The page's web server: files, configuration, what it says without a built page, and its port."""

from __future__ import annotations

import gzip
import http.client
import json
import socket

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import Tokens
from thymio_sim_ros.files import resources
from thymio_sim_ros.names import addresses
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.web import node
from thymio_sim_ros.ros.web.node import WebPage, WebParams
from thymio_sim_ros.sim.playground import reader as playgrounds


@pytest.fixture
def built_page(tmp_path, monkeypatch):
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Thymio</title>")
    (tmp_path / "assets" / "main.js").write_text("export {}")
    (tmp_path.parent / "secret.txt").write_text("not for you")
    monkeypatch.setattr(resources, "page", lambda: tmp_path)


def get(port, path, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", path, headers={name.replace("_", "-"): value for name, value in headers.items()})
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


@pytest.mark.parametrize("wanted", ["gzip", "gzip, deflate, br, zstd", "br;q=1.0, gzip;q=0.8", "deflate,gzip"])
def test_text_is_compressed_for_clients_that_accept_it(ros, built_page, tmp_path, wanted):
    (tmp_path / "assets" / "main.js").write_text("export {};" * 100)
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/assets/main.js?v=2", Accept_Encoding=wanted)
    assert (response.status, response.headers["Content-Encoding"]) == (200, "gzip")
    assert response.headers["Vary"] == "Accept-Encoding"
    assert gzip.decompress(body) == (tmp_path / "assets" / "main.js").read_bytes()


@pytest.mark.parametrize("wanted", ["", "identity", "br", "gzip;q=0", "gzip; q=0.0, br", "x-gzip-like"])
def test_other_clients_get_uncompressed_text(ros, built_page, tmp_path, wanted):
    (tmp_path / "assets" / "main.js").write_text("export {};" * 100)
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/assets/main.js", Accept_Encoding=wanted)
    assert "Content-Encoding" not in response.headers
    assert body == b"export {};" * 100


def test_a_missing_file_is_also_missing_compressed(ros, built_page):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    for path in ("/assets/none.js", "/%2e%2e/secret.txt", "/assets"):
        response, body = get(page.port, path, Accept_Encoding="gzip")
        assert response.status in (301, 404)
        assert b"not for you" not in body


def test_shipped_playgrounds_are_served_with_their_pictures_inside(ros, built_page):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/playgrounds/line_gradient.json")
    assert response.status == 200
    assert response.headers["Content-Type"] == "application/json"
    served = playgrounds.loads(body, "line_gradient.json")
    assert served.shapes == playgrounds.load(resources.playgrounds()["line_gradient"]).shapes
    assert get(page.port, "/playgrounds/line_gradient.json")[1] == body


def test_an_invalid_playground_is_reported_with_the_reason(ros, built_page, tmp_path, monkeypatch):
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
        "/" + "a" * 5000,
        "/%00",
        "/a%00.js",
        "/index.html/",
    ],
)
def test_nothing_outside_the_page_is_served(ros, built_page, path):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, path)
    assert response.status == 404
    assert b"not for you" not in body


@pytest.mark.parametrize("path", ["/", "/config.json", "/playgrounds/line.json", "/assets/main.js"])
def test_head_is_get_without_the_body(ros, built_page, path):
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    connection = http.client.HTTPConnection("127.0.0.1", page.port, timeout=PATIENCE_S)
    connection.request("HEAD", path)
    response = connection.getresponse()
    assert (response.status, response.read()) == (200, b"")
    wanted, body = get(page.port, path)
    assert response.headers["Content-Length"] == str(len(body)) == wanted.headers["Content-Length"]
    connection.close()


def test_without_a_built_page_the_answer_says_how_to_build_it(ros, monkeypatch):
    monkeypatch.setattr(resources, "page", lambda: None)
    page = ros.live(WebPage(ros.context, WebParams(port=0)))
    response, body = get(page.port, "/")
    assert response.status == 503
    assert resources.PAGE_BUILD_HINT in body.decode()


def test_without_aiohttp_the_error_says_what_to_install(ros, monkeypatch):
    monkeypatch.setattr(node.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(StartError, match="python3-aiohttp"):
        WebPage(ros.context, WebParams(port=0))


def test_tokens_are_in_the_access_urls_and_not_in_the_startup_message(ros, built_page, monkeypatch):
    monkeypatch.setattr(addresses, "own_address", lambda: "10.1.2.3")
    page = ros.live(WebPage(ros.context, WebParams(port=0, address="0.0.0.0"), Tokens("fulltoken", "looktoken")))
    assert page.access_urls.splitlines() == [
        f"Page      http://localhost:{page.port}/#token=fulltoken, from other computers "
        f"http://10.1.2.3:{page.port}/#token=fulltoken",
        f"Read only http://localhost:{page.port}/#token=looktoken, from other computers "
        f"http://10.1.2.3:{page.port}/#token=looktoken",
    ]
    assert "token" not in page.startup_message


def test_a_port_in_use_is_reported_in_one_sentence(ros):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(StartError, match=f"{port} cannot be used"):
            WebPage(ros.context, WebParams(port=port))
