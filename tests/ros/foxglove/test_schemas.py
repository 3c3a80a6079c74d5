"""Definitions, type names and assets of installed packages."""

from __future__ import annotations

import importlib
import sys

import pytest

from thymio_sim_ros.ros.foxglove import assets, schemas
from thymio_sim_ros.ros.foxglove.assets import AssetError, load_asset
from thymio_sim_ros.ros.foxglove.schemas import message_definition, service_definitions
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type

PACKAGES = ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "visualization_msgs", "rcl_interfaces")


def all_types(kind):
    """Names of every type of one kind in the installed packages."""
    for package in PACKAGES:
        try:
            module = importlib.import_module(f"{package}.{kind}")
        except ImportError:
            continue
        names = [name for name in dir(module) if name[0].isupper() and not name.startswith("_")]
        yield from (f"{package}/{kind}/{name}" for name in names if hasattr(getattr(module, name), "__slots__"))


def fields(text):
    """(type, name) of each field of the first part of a definition."""
    own = text.partition("=" * 80)[0]
    rows = [line.partition("#")[0].split() for line in own.splitlines()]
    return [(row[0].split("/")[-1], row[1]) for row in rows if len(row) >= 2 and "=" not in "".join(row[1:3])]


def test_the_definition_has_every_type_it_needs_once():
    text = message_definition("nav_msgs/msg/Odometry")
    headings = [line for line in text.splitlines() if line.startswith("MSG: ")]
    assert sorted(headings) == sorted(set(headings))
    assert {"MSG: std_msgs/Header", "MSG: builtin_interfaces/Time", "MSG: geometry_msgs/Point"} <= set(headings)
    assert text.count("=" * 80) == len(headings)


@pytest.mark.parametrize("name", sorted(all_types("msg")))
def test_files_and_classes_give_the_same_fields(name, monkeypatch):
    from_file = fields(message_definition(name))
    monkeypatch.setattr(schemas, "share_folders", list)
    from_class = fields(message_definition(name))
    assert [field for _, field in from_class] == [field for _, field in from_file]


def test_a_service_has_two_definitions():
    request, response = service_definitions("std_srvs/srv/SetBool")
    assert fields(request) == [("bool", "data")]
    assert fields(response) == [("bool", "success"), ("string", "message")]


def test_an_empty_service_has_two_empty_definitions():
    assert service_definitions("std_srvs/srv/Empty") == ("", "")


def test_a_service_without_a_file_is_described_by_its_class(monkeypatch):
    monkeypatch.setattr(schemas, "share_folders", list)
    request, response = service_definitions("std_srvs/srv/SetBool")
    assert (request, response) == ("bool data\n", "bool success\nstring message\n")


@pytest.mark.parametrize(
    ("python", "ros"),
    [
        ("boolean", "bool"),
        ("octet", "byte"),
        ("double", "float64"),
        ("sequence<float>", "float32[]"),
        ("sequence<double, 3>", "float64[<=3]"),
        ("double[9]", "float64[9]"),
        ("string<10>", "string<=10"),
        ("sequence<string<10>>", "string<=10[]"),
        ("geometry_msgs/Point", "geometry_msgs/Point"),
    ],
)
def test_field_types_of_classes_are_translated(python, ros):
    assert schemas._ros_type(python) == ros


def test_transforms_are_described_without_tf2_msgs():
    text = message_definition("tf2_msgs/msg/TFMessage")
    assert text.splitlines()[0] == "geometry_msgs/TransformStamped[] transforms"
    assert "MSG: geometry_msgs/TransformStamped" in text


@pytest.mark.parametrize(
    "name", ["no_such_msgs/msg/Thing", "std_msgs/msg/Thing", "nonsense", "os/path/join", "a/b-c/d"]
)
def test_a_type_that_is_not_installed_is_missed_by_name(name):
    with pytest.raises(MissingTypeError, match=name.replace(".", r"\.")):
        load_type(name)


def test_loading_a_type_imports_no_other_module():
    for name in ("this/msg/Zen", "antigravity/srv/Fly"):
        with pytest.raises(MissingTypeError, match="there is no package"):
            load_type(name)
    assert not {"this", "antigravity"} & sys.modules.keys()


def test_short_type_names_are_completed():
    assert full_name("geometry_msgs/Twist") == "geometry_msgs/msg/Twist"
    assert full_name("geometry_msgs/msg/Twist") == "geometry_msgs/msg/Twist"
    assert full_name("std_srvs/Empty", "srv") == "std_srvs/srv/Empty"


def test_installed_files_are_found_without_and_with_an_ament_prefix(monkeypatch, tmp_path):
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    assert [str(folder) for folder in schemas.share_folders()] == [f"{sys.prefix}/share"]
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}:/opt/ros/jazzy")
    assert schemas.share_folders()[0] == tmp_path / "share"


@pytest.fixture
def package(monkeypatch, tmp_path):
    """A share folder with one package and a file beside it."""
    (tmp_path / "robot" / "meshes").mkdir(parents=True)
    (tmp_path / "robot" / "meshes" / "body part.STL").write_bytes(b"mesh")
    (tmp_path / "robot" / "secret.txt").write_bytes(b"secret")
    (tmp_path / "outside.stl").write_bytes(b"outside")
    (tmp_path / "robot" / "link.stl").symlink_to(tmp_path / "outside.stl")
    (tmp_path / "robot" / "folder.stl").mkdir()
    monkeypatch.setattr(assets, "share_folders", lambda: [tmp_path])


@pytest.mark.usefixtures("package")
def test_a_file_of_a_package_is_loaded():
    assert load_asset("package://robot/meshes/body%20part.STL") == b"mesh"


@pytest.mark.usefixtures("package")
@pytest.mark.parametrize(
    ("uri", "text"),
    [
        ("file:///etc/passwd", "expected package://"),
        ("package://robot/secret.txt", "is rejected: asset_uri_allowlist"),
        ("package://robot/../outside.stl", "is not inside its package"),
        ("package://robot/%2e%2e/outside.stl", "is not inside its package"),
        ("package://../outside.stl", "is not inside its package"),
        (f"package://robot/{'a' * 300}.stl", "does not exist"),
        (f"package://robot/{'a/' * 3000}b.stl", "does not exist"),
        ("package://robot/\ud800.stl", "does not exist"),
        ("package:///outside.stl", "is not inside its package"),
        ("package://robot//outside.stl", "does not exist"),
        ("package://robot/link.stl", "does not exist"),
        ("package://robot/folder.stl", "does not exist"),
        ("package://robot/no.stl", "does not exist"),
        ("package://robot/\0.stl", "is not inside its package"),
    ],
)
def test_other_files_are_rejected(uri, text):
    with pytest.raises(AssetError, match=text):
        load_asset(uri)


@pytest.mark.usefixtures("package")
def test_the_allowed_uris_can_be_set():
    assert load_asset("package://robot/secret.txt", (r"package://robot/.*\.txt",)) == b"secret"
    with pytest.raises(AssetError, match="asset_uri_allowlist"):
        load_asset("package://robot/meshes/body%20part.STL", (r"package://robot/.*\.txt",))


@pytest.mark.usefixtures("package")
def test_a_very_large_file_is_rejected(monkeypatch):
    monkeypatch.setattr(assets, "_MAX_SIZE", 3)
    with pytest.raises(AssetError, match="is larger than"):
        load_asset("package://robot/meshes/body%20part.STL")
