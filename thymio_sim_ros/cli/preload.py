"""What the suites of a class share in memory: imported once, in the process from which they are forked.

Only for that process, because the import changes it: rclpy is that of the embedded graph from then on, and what exists
is never collected. Nothing here starts a thread, and nothing is compiled: threads do not survive a fork.
"""

import gc
from importlib import import_module

from thymio_sim_ros.portable_ros import import_hook

import_hook.install(is_forced=True)
for name in ("cli.main", "ros.combined", "ros.foxglove.node", "ros.web.node"):
    import_module(f"thymio_sim_ros.{name}")
gc.collect()
gc.freeze()  # a collection writes into each object that it looks at, and so would copy the memory for each process
