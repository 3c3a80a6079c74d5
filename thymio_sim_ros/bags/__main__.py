"""The commands `record` and `play`: `python -m thymio_sim_ros.bags record [TOPIC …]` on an installed ROS.

On the embedded graph, which is that of one process, a program uses `Recorder` and `Player` beside its own nodes.
"""

from __future__ import annotations

import sys

from thymio_sim_ros.bags.commands import main

if __name__ == "__main__":
    sys.exit(main())
