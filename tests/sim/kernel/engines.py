"""How a kernel is run without compiling it."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from thymio_sim_ros.sim.kernel.memory import KernelMemory


def run_by_python(_memory: KernelMemory, _module: ModuleType, kernel: Any, *arguments: Any) -> Any:
    """Stands for `KernelMemory.bind`; reading beyond an array is an IndexError."""
    flat = [argument.reshape(-1) if isinstance(argument, np.ndarray) else argument for argument in arguments]
    return lambda: kernel(*flat)
