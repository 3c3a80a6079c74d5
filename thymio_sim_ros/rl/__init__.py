"""Environments for reinforcement learning (docs/reinforcement-learning.md); they need the extra `rl`.

Importing this package registers `thymio/Avoid-v0` and `thymio/Line-v0` with Gymnasium. `ThymioParallelEnv`, which needs
PettingZoo, is in `thymio_sim_ros.rl.parallel_env`.
"""

from __future__ import annotations

import gymnasium

from thymio_sim_ros.rl.env import ThymioEnv
from thymio_sim_ros.rl.errors import TaskError
from thymio_sim_ros.rl.tasks import TASKS, Rewards, Task
from thymio_sim_ros.rl.vector_env import ThymioVectorEnv

__all__ = ["TASKS", "Rewards", "Task", "TaskError", "ThymioEnv", "ThymioVectorEnv"]

for _name in TASKS:
    gymnasium.register(
        id=f"thymio/{_name.capitalize()}-v0",
        entry_point="thymio_sim_ros.rl.env:ThymioEnv",
        vector_entry_point="thymio_sim_ros.rl.vector_env:ThymioVectorEnv",
        kwargs={"task": _name},
    )
