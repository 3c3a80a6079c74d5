"""What the suites of a class share in memory: made once, in the process from which they are forked.

These are all modules, the playground of the class if it is an installed one, and what plug-ins add to robots. Only for
that process, because the import changes it: rclpy is that of the embedded graph from then on, and what exists is never
collected. Nothing here starts a thread, and nothing is compiled: threads do not survive a fork.
"""

import contextlib
import gc
import os
from importlib import import_module

from thymio_sim_ros.classroom.suite_process import PLAYGROUND_VARIABLE
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import check_files
from thymio_sim_ros.files import resources
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.suite_config import SuiteConfig

import_hook.install(is_forced=True)
for name in ("cli.main", "cli.suite", "ros.combined", "ros.foxglove.node", "ros.web.node"):
    import_module(f"thymio_sim_ros.{name}")
with contextlib.suppress(Exception):  # a broken package can raise anything, and a suite says what is wrong with it
    import_module("wasmtime")
defaults = SuiteConfig()
chosen = os.environ.get(PLAYGROUND_VARIABLE, "")
playground = chosen if chosen in resources.playgrounds() else defaults.playground
with contextlib.suppress(UsageError):  # a suite says what is wrong with it
    check_files(playground, defaults.program, defaults.behaviour, defaults.device.layout)
gc.collect()
gc.freeze()  # a collection writes into each object that it looks at, and so would copy the memory for each process
