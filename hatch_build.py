"""Build hook: builds the web page and adds it to wheels and source distributions.

The Node wheel of PyPI is a build requirement only if the page must be built and no suitable Node is installed.
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
    """Builds web_ui/dist if it is missing or outdated, and adds it to the wheel."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """The Node wheel, if the coming build needs it."""
        page_build = _page_build(self.root)
        return [] if page_build.is_ready(self._page) else [page_build.NODE_WHEEL]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page. If that fails, an editable installation continues: `make web` builds the page later."""
        page_build = _page_build(self.root)
        try:
            page_build.build(self._page)
        except page_build.WebBuildError as error:
            if version != "editable":
                self.app.abort(f"The web page could not be built. {error}")
            self.app.display_warning(f"Installed without the web page. {error}")
        dist = self._page / "dist"
        if self.target_name == "wheel" and dist.is_dir():
            build_data["shared_data"][str(dist)] = _PAGE_SHARE

    @property
    def _page(self) -> Path:
        return Path(self.root, "web_ui")


def _page_build(root: str) -> ModuleType:
    """Load `web_ui/build.py`, which is not part of an installed package."""
    spec = importlib.util.spec_from_file_location("_thymio_page_build", Path(root, "web_ui", "build.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # for `dataclass`, which looks up the module of its class
    spec.loader.exec_module(module)
    return module
