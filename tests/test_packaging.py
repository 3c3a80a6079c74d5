"""pip reads pyproject.toml, colcon setup.cfg, ROS package.xml: all three describe the tree that is there."""

from __future__ import annotations

import configparser
import json
import os
import re
import subprocess
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

import thymio_sim_ros

ROOT = Path(__file__).parent.parent
NAME = "thymio_sim_ros"
OPTIONAL = {"tf2_geometry_msgs", "thymio_msgs"}
"""ROS packages that are used where they are installed."""
NODES = {"simulator", "aseba_runtime", "foxglove_bridge", "web_ui", "thymio"}
EXAMPLES = {path.stem for path in (ROOT / NAME / "examples").glob("*.py")} - {"__init__"}
EXECUTABLES = NODES | EXAMPLES

pytestmark = pytest.mark.skipif(not (ROOT / "pyproject.toml").is_file(), reason="the tests lie outside a source tree")


def _pyproject() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text())


def _setup() -> configparser.ConfigParser:
    parser = configparser.ConfigParser(delimiters=("=",))
    parser.optionxform = str  # type: ignore[assignment,method-assign]  # paths are case-sensitive
    parser.read(ROOT / "setup.cfg")
    return parser


def _manifest() -> ElementTree.Element:
    return ElementTree.parse(ROOT / "package.xml").getroot()


def _data_files() -> dict[str, list[str]]:
    """setup.cfg's data files, destination folder → patterns."""
    return {folder: patterns.split() for folder, patterns in _setup()["options.data_files"].items()}


def test_name_is_the_same_everywhere() -> None:
    assert _pyproject()["project"]["name"] == NAME
    assert _setup()["metadata"]["name"] == NAME
    assert _manifest().findtext("name") == NAME
    assert (ROOT / "resource" / NAME).read_bytes() == b""


def test_version_is_written_in_the_package_and_repeated_for_ros_alone() -> None:
    assert _manifest().findtext("version") == thymio_sim_ros.__version__
    assert _setup()["metadata"]["version"] == f"attr: {NAME}.__version__"
    assert _pyproject()["project"]["dynamic"] == ["version"]


def test_the_citation_is_that_of_this_version() -> None:
    lines = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    fields = dict(line.split(": ", 1) for line in lines if re.match(r"[a-z-]+: ", line))
    project = _pyproject()["project"]
    assert fields["version"] == thymio_sim_ros.__version__
    assert fields["license"] == project["license"]["text"]
    assert [line.removeprefix("  - ") for line in lines[lines.index("keywords:") + 1 :]] == project["keywords"]


def test_the_addresses_are_the_same_everywhere() -> None:
    urls = _pyproject()["project"].get("urls", {})
    listed = [urls.get("Homepage"), urls.get("Source"), urls.get("Issues")]
    in_manifest = {url.get("type"): url.text for url in _manifest().findall("url")}
    assert [in_manifest.get(kind) for kind in ("website", "repository", "bugtracker")] == listed
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    cited = [re.search(rf"^{key}: (.+)$", citation, re.MULTILINE) for key in ("url", "repository-code")]
    assert [match and match[1] for match in cited] == listed[:2]


@pytest.mark.parametrize(
    "name", ["pyproject.toml", "CITATION.cff", "CHANGELOG.md", "README.md", ".github/ISSUE_TEMPLATE/config.yml"]
)
def test_no_address_is_a_placeholder(name: str) -> None:
    assert re.findall(r"[\w.@:/-]+\.example\b", (ROOT / name).read_text(encoding="utf-8")) == []


def test_the_maintainers_are_the_same_everywhere() -> None:
    names = [maintainer.text for maintainer in _manifest().findall("maintainer")]
    assert [maintainer["name"] for maintainer in _pyproject()["project"]["maintainers"]] == names


def test_description_and_licence_agree() -> None:
    assert _manifest().findtext("description") == _pyproject()["project"]["description"]
    assert _manifest().findtext("license") == _pyproject()["project"]["license"]["text"] == "Apache-2.0"
    assert "Apache License" in (ROOT / "LICENSE").read_text()


def test_console_scripts_agree() -> None:
    lines = _setup()["options.entry_points"]["console_scripts"].strip().splitlines()
    assert dict(line.split(" = ") for line in lines) == _pyproject()["project"]["scripts"]


def test_the_pytest_plugin_is_entered_in_both_under_the_name_that_conftest_uses() -> None:
    lines = _setup()["options.entry_points"]["pytest11"].strip().splitlines()
    entered = dict(line.split(" = ") for line in lines)
    assert entered == _pyproject()["project"]["entry-points"]["pytest11"]
    assert entered == {f"{NAME}.pytest_plugin": f"{NAME}.pytest_plugin"}


@pytest.mark.parametrize("target", _pyproject()["project"]["scripts"].values())
def test_a_console_script_leads_to_a_function(target: str) -> None:
    module, function = target.split(":")
    source = ROOT.joinpath(*module.split(".")).with_suffix(".py").read_text()
    assert re.search(rf"^def {function}\(", source, re.MULTILINE) or f"import {function}" in source


def test_every_executable_has_a_launcher_and_a_console_script() -> None:
    assert {path.name for path in (ROOT / "resource" / "bin").iterdir()} == EXECUTABLES
    scripts = _pyproject()["project"]["scripts"]
    assert {f"thymio_{name}" for name in EXECUTABLES} == scripts.keys() - {"aseba", "thymio-sim"}


def test_launchers_are_one_text_and_executable() -> None:
    launchers = [ROOT / "resource" / "bin" / name for name in EXECUTABLES]
    assert len({path.read_text() for path in launchers}) == 1
    assert all(os.access(path, os.X_OK) for path in launchers)


@pytest.mark.process
def test_a_launcher_starts_the_console_script_of_its_own_installation(tmp_path: Path) -> None:
    launcher = tmp_path / "lib" / NAME / "simulator"
    script = tmp_path / "bin" / "thymio_simulator"
    for path in (launcher, script):
        path.parent.mkdir(parents=True)
    launcher.symlink_to(ROOT / "resource" / "bin" / "simulator")
    script.write_text('#!/bin/sh\necho "$@"\n')
    script.chmod(0o755)
    arguments = ["--ros-args", "-p", "text:=two words"]
    answer = subprocess.run([launcher, *arguments], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == " ".join(arguments)


def test_both_installers_fill_the_same_folders() -> None:
    shared = _pyproject()["tool"]["hatch"]["build"]["targets"]["wheel"]["shared-data"]
    expected: set[str] = set()
    for source, target in shared.items():
        if (ROOT / source).is_dir():
            inner = [folder for folder in (ROOT / source).rglob("*/") if folder.name != "__pycache__"]
            expected |= {target, *(f"{target}/{folder.relative_to(ROOT / source)}" for folder in inner)}
        elif (ROOT / source).exists():
            expected.add(str(Path(target).parent))
    assert expected == {folder for folder in _data_files() if not folder.startswith(f"share/{NAME}/web_ui")}


def test_no_file_of_a_shared_folder_is_missed_by_setup_cfg() -> None:
    shared = _pyproject()["tool"]["hatch"]["build"]["targets"]["wheel"]["shared-data"]
    wanted = {
        file for source in shared for file in [ROOT / source, *(ROOT / source).rglob("*")] if file.is_file()
    } - set(ROOT.rglob("__pycache__/*"))  # fmt: skip
    taken = {file for patterns in _data_files().values() for pattern in patterns for file in ROOT.glob(pattern)}
    assert {str(file.relative_to(ROOT)) for file in wanted - taken} == set()


def test_setup_cfg_takes_every_file_of_a_built_page() -> None:
    dist = ROOT / "web_ui" / "dist"
    if not dist.is_dir():
        pytest.skip("the page is not built")
    taken = {file for patterns in _data_files().values() for pattern in patterns for file in ROOT.glob(pattern)}
    files = {file for file in dist.rglob("*") if file.is_file() and not file.name.startswith(".")}
    assert {str(file.relative_to(dist)) for file in files - taken} == set()


def test_every_data_file_of_a_package_has_a_pattern() -> None:
    patterns = {name: value.replace(" ", "").split(",") for name, value in _setup()["options.package_data"].items()}
    taken = {
        file
        for init in (init for package in ("aseba_vm", NAME) for init in (ROOT / package).rglob("__init__.py"))
        for pattern in [*patterns["*"], *patterns.get(".".join(init.parent.relative_to(ROOT).parts), [])]
        for file in init.parent.glob(pattern)
    }
    data = {
        file
        for package in ("aseba_vm", NAME)
        for file in (ROOT / package).rglob("*")
        if file.is_file() and file.suffix not in {".py", ".pyc"}
    }
    assert {str(file.relative_to(ROOT)) for file in data - taken} == set()


def test_every_folder_with_modules_is_a_package_for_setuptools() -> None:
    folders = {path.parent for package in ("aseba_vm", NAME) for path in (ROOT / package).rglob("*.py")}
    folders.discard(ROOT / NAME / "launch")
    assert {str(folder.relative_to(ROOT)) for folder in folders if not (folder / "__init__.py").is_file()} == set()


def test_setup_py_holds_the_bare_call_that_colcon_looks_for() -> None:
    lines = (ROOT / "setup.py").read_text().splitlines()
    assert lines[-1] == "setup()"
    assert _setup()["options.extras_require"]["test"] == "pytest"


def test_package_xml_is_what_ros_expects() -> None:
    manifest = _manifest()
    assert manifest.get("format") == "3"
    assert manifest.findtext("export/build_type") == "ament_python"
    assert manifest.find("export/architecture_independent") is not None


def test_every_ros_package_that_is_imported_is_declared() -> None:
    depends = {element.text for tag in ("depend", "exec_depend") for element in _manifest().iter(tag)}
    embedded = ROOT / NAME / "portable_ros"  # serves the packages that it imports
    imported = {
        module
        for path in (ROOT / NAME).rglob("*.py")
        if embedded not in path.parents
        for module in re.findall(r"^\s*(?:from|import) (\w+)", path.read_text(), re.MULTILINE)
    }
    ros = {name for name in imported if name.endswith("_msgs") or name in {"rclpy", "launch", "launch_ros"}}
    assert ros - OPTIONAL <= depends


def test_the_environment_of_robostack_has_what_the_package_depends_on() -> None:
    environment = tomllib.loads((ROOT / "docs/robostack/pixi.toml").read_text())
    assert environment["pypi-dependencies"][NAME]["path"] == "../.."
    assert environment["tasks"]["start"].split()[0] in _pyproject()["project"]["scripts"]
    depends = {element.text or "" for tag in ("depend", "exec_depend") for element in _manifest().iter(tag)}
    ros = {f"ros-jazzy-{name.replace('_', '-')}" for name in depends if not name.startswith("python3-")}
    assert ros <= environment["dependencies"].keys()


def test_ros_wheels_are_never_a_plain_dependency() -> None:
    project = _pyproject()["project"]
    assert not any(requirement.startswith("ros-") for requirement in project["dependencies"])
    assert all("x86_64" in requirement for requirement in project["optional-dependencies"]["ros"])


def test_no_requirement_has_an_upper_bound() -> None:
    project = _pyproject()["project"]
    extras = [item for extra in project["optional-dependencies"].values() for item in extra]
    versions = [item.split(";")[0] for item in [*project["dependencies"], *extras]]
    assert [version for version in versions if "<" in version or "==" in version] == []


def test_lock_file_names_no_download_address() -> None:
    lock = ROOT / "web_ui" / "package-lock.json"
    packages = json.loads(lock.read_text())["packages"]
    assert [name for name, entry in packages.items() if "resolved" in entry] == []
    assert [name for name, entry in packages.items() if name and "integrity" not in entry] == []
    assert "omit-lockfile-registry-resolved=true" in (ROOT / "web_ui" / ".npmrc").read_text()
    assert not (ROOT / "uv.lock").exists()
