"""Fixtures of all tests; those that need ROS come from the package itself, as a teacher would use them."""

import json
import signal
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import hypothesis
import pytest

from aseba_vm import languages

# Whatever a shell starts in the background ignores Ctrl-C, and so would every program that a test starts.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

hypothesis.settings.register_profile("thymio", deadline=None)  # a loaded machine is no defect
hypothesis.settings.load_profile("thymio")

# The same name as the entry point: where the package is installed, pytest has loaded it already.
pytest_plugins = ["pytester", "thymio_sim_ros.pytest_plugin"]


@pytest.fixture(autouse=True)
def _signal_handlers() -> Iterator[None]:
    """Restore the handlers: `run_main` ignores signals at its end, and programs of later tests would inherit that."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.getsignal(number) for number in numbers]
    yield
    for number, handler in zip(numbers, before, strict=True):
        if signal.getsignal(number) is not handler:
            signal.signal(number, handler)


@pytest.fixture
def add_language(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Callable[..., None]]:
    """Adds a language beside those that are shipped: its code, and the texts of each of its files by key."""
    shipped = languages._FOLDER

    def add(code: str, **files: Mapping[str, str]) -> None:
        folder = tmp_path / "languages"
        (folder / code).mkdir(parents=True)
        for path in shipped.glob("*/language.json"):
            (folder / path.parent.name).symlink_to(path.parent)
        for name, table in {"language": {"name": code}, **files}.items():
            (folder / code / f"{name}.json").write_text(json.dumps(table), encoding="utf-8")
        monkeypatch.setattr(languages, "_FOLDER", folder)
        monkeypatch.setattr(languages, "LANGUAGES", languages._languages())
        languages.texts.cache_clear()

    yield add
    languages.texts.cache_clear()


def pytest_addoption(parser):
    about = "run tests/aseba_vm and tests/sim on the vectors of this folder (plain or .gz) instead of ours"
    parser.addoption("--vectors", metavar="DIR", type=Path, default=None, help=about)
    about = "keep the pictures of the page as they are now, in tests/data/web/snapshots"
    parser.addoption("--update-snapshots", action="store_true", help=about)


def pytest_collection_modifyitems(items):
    """Mark the tests that need ROS, so that `make check` can leave them out: by their folder or by their fixtures."""
    folders = [Path(__file__).parent / name for name in ("ros", "testing/ros", "tf")]
    for item in items:
        fixtures = {"ros", "ros_domain", "_shared"}.intersection(getattr(item, "fixturenames", ()))
        if fixtures or any(folder in item.path.parents for folder in folders):
            item.add_marker("ros")
