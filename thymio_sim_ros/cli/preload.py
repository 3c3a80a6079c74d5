"""What the suites of a class share in memory: made once, in the process from which they are forked.

A suite runs here for a moment and ends before the first one is forked. So these are all modules, classes of messages,
compiled kernels, and the playground of the class if it is an installed one. Only for that process, because the import
changes it: rclpy is that of the embedded graph from then on, and what exists is never collected. No thread remains:
threads do not survive a fork.
"""

import contextlib
import gc
import os

from thymio_sim_ros.portable_ros import import_hook

import_hook.install(is_forced=True)

from thymio_sim_ros.classroom.suite_process import PLAYGROUND_VARIABLE
from thymio_sim_ros.cli import main, suite  # noqa: F401 - for the forked processes
from thymio_sim_ros.files import resources
from thymio_sim_ros.network import tdm_server  # noqa: F401 - for the forked processes
from thymio_sim_ros.network.http import server  # noqa: F401 - for the forked processes
from thymio_sim_ros.ros.combined import run_ticks
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.suite_config import SuiteConfig

_TICKS = 100
"""Ticks in which everything runs that runs often."""

chosen = os.environ.get(PLAYGROUND_VARIABLE, "")
playground = chosen if chosen in resources.playgrounds() else SuiteConfig.playground
with contextlib.suppress(StartError):  # a suite says what is wrong with it
    run_ticks(SuiteConfig(playground=playground, port=0, foxglove_port=0), _TICKS)
gc.collect()
gc.freeze()  # a collection writes into each object that it looks at, and so would copy the memory for each process
