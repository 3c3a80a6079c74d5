"""The tile "Thymio" in the launcher of JupyterLab, for the package jupyter-server-proxy."""

from __future__ import annotations

import os
import secrets
import sys
from typing import Any

from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.files import resources

__all__ = ["ARGUMENTS", "launcher"]

ARGUMENTS = (
    "--no-foxglove-port",
    "--no-aseba",
    "--no-tdm-ports",
    "--quiet",
    "--trusted-proxy",
    "127.0.0.1",
    "--trusted-proxy",
    "::1",
)
"""Options of a suite behind jupyter-server-proxy: its page's port is the only one, its output is Jupyter's log."""

_BINDER = "BINDER_LAUNCH_HOST"
"""Variable of a container that Binder has started for one user, whose address has no token (`.binder/`)."""

START_S = 60
"""Time in which the suite has to answer."""


def launcher() -> dict[str, Any]:
    """Return how jupyter-server-proxy starts the suite at its first request, and the tile.

    On a computer with several users, everyone can connect to each port. The suite therefore has a token, which only the
    tile of its user knows. It is in the fragment of the address, because jupyter-server-proxy logs queries.

    Source: jupyter-server-proxy.readthedocs.io, "Server Process options".
    """
    token = "" if _BINDER in os.environ else secrets.token_urlsafe(16)
    page = resources.page()
    icon = {} if page is None else {"icon_path": str(page / "favicon.svg")}
    return {
        "command": [sys.executable, "-m", "thymio_sim_ros", *ARGUMENTS, "--port", "{port}"],
        "environment": {TOKEN_VARIABLE: token} if token else {},
        "timeout": START_S,
        "new_browser_tab": True,
        "launcher_entry": {"title": "Thymio", "path_info": f"thymio/#token={token}" if token else "thymio/", **icon},
    }
