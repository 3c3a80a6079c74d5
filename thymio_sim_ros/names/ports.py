"""TCP ports of the suite, unless others are chosen."""

from __future__ import annotations

__all__ = ["FOXGLOVE_PORT", "HTTP_PORT"]

HTTP_PORT = 8080
"""The page."""
FOXGLOVE_PORT = 8765
"""The bridge."""
