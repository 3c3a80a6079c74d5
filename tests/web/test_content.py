"""Documents by the paths of requests: only files of the page."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest

from tests.systems import links
from thymio_sim_ros.web import Content


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    page = tmp_path / "dist"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<!doctype html><title>Thymio</title>")
    (page / "assets" / "index-DGs6OHeF.js").write_text("export {};" * 100)
    (tmp_path / "secret.txt").write_text("not for you")
    return page


@pytest.fixture
def content(folder: Path) -> Content:
    return Content(folder, b"{}")


def test_a_document_has_its_type_its_gzip_and_a_tag_of_its_content(content, folder):
    found = content.find("/assets/index-DGs6OHeF.js")
    assert found.media_type == "text/javascript; charset=utf-8"
    assert gzip.decompress(found.compressed) == found.body == b"export {};" * 100
    assert found.is_immutable
    assert not content.find("/").is_immutable
    assert content.find("/index.html") == content.find("/")
    assert found.tag != content.find("/").tag


def test_a_file_that_is_built_again_is_read_again(content, folder):
    old = content.find("/")
    (folder / "index.html").write_text("<!doctype html><title>Another</title>")
    new = content.find("/")
    assert b"Another" in new.body
    assert new.tag != old.tag


def test_the_installed_shapes_are_declared_with_a_tag(content):
    found = content.find("/shapes.json")
    assert found is content.find("/shapes.json")
    assert found.media_type == "application/json"
    assert gzip.decompress(found.compressed) == found.body
    assert not found.is_immutable
    assert {"box", "track"} <= set(json.loads(found.body)["shapes"])


def test_small_files_are_not_made_larger(content, folder):
    (folder / "one.js").write_text("1")
    assert content.find("/one.js").compressed is None


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/assets/..%2f..%2fsecret.txt",
        "/assets/..%5c..%5csecret.txt",
        "/..%c0%afsecret.txt",
        "//etc/passwd",
        "/%2fetc/passwd",
        "/assets",
        "/assets/",
        "/.",
        "/%00",
        "/index.html%00.js",
        "/index.html/",
        "/" + "a" * 5000,
        "http://elsewhere/index.html",
        "*",
        "",
        "/playgrounds/..%2fpyproject.json",
        "/playgrounds/nothing.json",
        "/playgrounds/playground.schema.json",
    ],
)
def test_nothing_else_is_found(content, path):
    assert content.find(path) is None


@links
def test_only_links_of_colcon_lead_out_of_the_folder(tmp_path, folder):
    installed = tmp_path / "install" / "web_ui"
    (installed / "assets").mkdir(parents=True)
    (installed / "index.html").symlink_to(folder / "index.html")
    (installed / "assets" / "index-DGs6OHeF.js").symlink_to(folder / "assets" / "index-DGs6OHeF.js")
    (installed / "leak.js").symlink_to(tmp_path / "secret.txt")
    (installed / "out").symlink_to(tmp_path)
    content = Content(installed, b"{}")
    assert content.find("/") is not None
    assert content.find("/assets/index-DGs6OHeF.js") is not None
    assert content.find("/leak.js") is None
    assert content.find("/out/secret.txt") is None


def test_shipped_playgrounds_are_found(content):
    found = content.find("/playgrounds/line.json")
    assert found.media_type == "application/json"
    assert content.find("/playgrounds/line.json") is found


def test_further_documents_are_found_after_the_files_of_the_page(folder):
    pictures = {("missions", "one.png"): b"picture", ("index.html",): b"another"}
    content = Content(folder, b"{}", lambda names: (pictures[names], ".png") if names in pictures else None)
    found = content.find("/missions/one.png")
    assert (found.body, found.media_type) == (b"picture", "image/png")
    assert content.find("/missions/one.png") is found
    assert b"Thymio" in content.find("/index.html").body
    assert content.find("/missions/two.png") is None
    pictures["missions", "one.png"] = b"changed"
    assert content.find("/missions/one.png").tag != found.tag
