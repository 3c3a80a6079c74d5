"""The HTTP server of the page: static files with limits on what clients may take; no ROS in here.

content       files, playgrounds and configuration as documents: bytes, type, entity tag
connections   which connections are open, and which one is closed next
server        HTTP itself, on aiohttp (imported only in the server's thread: that takes a third of a second)
thread        the event loop's thread
"""

from __future__ import annotations

from thymio_sim_ros.web.content import Content, Document
from thymio_sim_ros.web.thread import PageThread, Settings

__all__ = ["Content", "Document", "PageThread", "Settings"]
