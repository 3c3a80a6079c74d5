"""What the suites of a class share in memory: made once, in the process from which they are forked.

These are all modules, the installed playgrounds, and what plug-ins add to robots and programs. Only for that process,
because the import changes it: rclpy is that of the embedded graph from then on, and what exists is never collected.
Nothing here starts a thread, and nothing is compiled: threads do not survive a fork.
"""

import contextlib
import gc
from importlib import import_module

from thymio_sim_ros.cli.options import check_files
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.suite_config import SuiteConfig

import_hook.install(is_forced=True)
for name in ("cli.main", "cli.suite", "ros.combined", "ros.foxglove.node", "ros.web.node"):
    import_module(f"thymio_sim_ros.{name}")
with contextlib.suppress(Exception):  # a broken package can raise anything, and a suite says what is wrong with it
    import_module("wasmtime")
for playground in resources.playgrounds():
    with contextlib.suppress(ThymioSimError, OSError):  # of another package
        load_playground(playground)
defaults = SuiteConfig()
check_files(defaults.playground, defaults.program, defaults.behaviour, defaults.device.layout)
gc.collect()
gc.freeze()  # a collection writes into each object that it looks at, and so would copy the memory for each process
