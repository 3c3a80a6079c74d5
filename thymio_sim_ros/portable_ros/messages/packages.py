"""The modules of packages of messages: their classes, each of which is made when it is first used."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from thymio_sim_ros.portable_ros.messages.definitions import SERVICE_PARTS, names
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type

__all__ = ["fill"]


def fill(module: ModuleType) -> None:
    """Give a module such as `std_msgs.msg` its classes; a package such as `std_msgs` has none."""
    package, _, form = module.__name__.partition(".")
    if not form:
        return
    services = list(names(package, "srv")) if form == "srv" else []
    messages = (
        list(names(package, "msg"))
        if form == "msg"
        else [f"{one}_{part}" for one in services for part in SERVICE_PARTS]
    )
    known = {*services, *messages}

    def get(name: str) -> Any:
        if name not in known:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        made = (service_type if name in services else message_type)(f"{package}/{form}/{name}")
        setattr(module, name, made)
        return made

    module.__dict__.update(__getattr__=get, __dir__=lambda: sorted(known), __all__=sorted(known))
