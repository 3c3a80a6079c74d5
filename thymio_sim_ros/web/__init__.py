"""The HTTP server of the page: static files with connection limits, independent of ROS.

content       files, playgrounds and configuration as documents: bytes, type, entity tag
hosts         names by which a server may be addressed
http_connections
              connections with limits, on aiohttp (imported only in the server's thread: that takes a third of a second)
server        the answers of the page
thread        the thread of the event loop
"""

from __future__ import annotations

from thymio_sim_ros.web.content import Content, Document
from thymio_sim_ros.web.thread import PageThread, Settings

__all__ = ["Content", "Document", "PageThread", "Settings"]
