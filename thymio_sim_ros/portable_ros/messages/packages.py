"""The modules of packages of messages: their classes, each of which is made when it is first used.

They are `std_msgs.msg` and, as rosidl has them, those of each interface, such as `std_msgs.msg._string`: editors write
imports of these, and pickled messages name them.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

from thymio_sim_ros.portable_ros.messages.action_class import action_type
from thymio_sim_ros.portable_ros.messages.interface_files import is_action, messages, of_module, services
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type

__all__ = ["fill"]


def fill(module: ModuleType) -> None:
    """Give a module such as `std_msgs.msg` its classes; a package such as `std_msgs` has none."""
    if "." not in module.__name__:
        return
    makers: dict[str, Callable[[str], Any]] = {}
    for name in of_module(module.__name__):
        makers |= dict.fromkeys(messages(name), message_type)
        makers |= dict.fromkeys(services(name), service_type)
        if is_action(name):
            makers[name] = action_type
    known = {name.rpartition("/")[2]: name for name in makers}

    def get(short: str) -> Any:
        if short not in known:
            raise AttributeError(f"module {module.__name__!r} has no attribute {short!r}")
        made = makers[known[short]](known[short])
        setattr(module, short, made)
        return made

    module.__dict__.update(__getattr__=get, __dir__=lambda: sorted(known), __all__=sorted(known))
