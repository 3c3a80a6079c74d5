"""The server of page and bridge: one application, on one port or more, independent of ROS.

content       files, playgrounds and configuration as documents: bytes, type, entity tag
http_connections
              connections with limits, on aiohttp (imported only in the server's thread: that takes a third of a second)
application   which server answers a request
server        the answers of the page
thread        the thread of the event loop
"""

from __future__ import annotations

from thymio_sim_ros.web.content import Content, Document
from thymio_sim_ros.web.settings import Settings
from thymio_sim_ros.web.thread import ServerThread

__all__ = ["Content", "Document", "ServerThread", "Settings"]
