"""Build hook: the web page goes into every wheel and source distribution.

Node is a build requirement from PyPI only where the page must be built and no fitting Node is installed.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_PAGE_SHARE = "share/thymio_sim_ros/web_ui"


class WebPageHook(BuildHookInterface[Any]):
    """Builds web_ui/dist when it is missing or older than its sources, and ships it."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """The Node wheel, if the coming build needs it."""
        webbuild = _webbuild(self.root)
        return [] if webbuild.is_ready(self._page) else [webbuild.NODE_WHEEL]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page. An editable install goes on without one: `make web` builds it later."""
        webbuild = _webbuild(self.root)
        try:
            webbuild.build(self._page)
        except webbuild.WebBuildError as error:
            if version != "editable":
                self.app.abort(f"The web page could not be built. {error}")
            self.app.display_warning(f"Installed without the web page. {error}")
        dist = self._page / "dist"
        if self.target_name == "wheel" and dist.is_dir():
            build_data["shared_data"][str(dist)] = _PAGE_SHARE

    @property
    def _page(self) -> Path:
        return Path(self.root, "web_ui")


def _webbuild(root: str) -> ModuleType:
    """Load the module from its path: the package is not installed while it is being built."""
    spec = importlib.util.spec_from_file_location("_thymio_webbuild", Path(root, "thymio_sim_ros", "webbuild.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    sys.path.insert(0, root)  # the module imports thymio_sim_ros.errors
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(root)
    return module
