"""`python -m thymio_sim_ros`: the command `thymio-sim`."""

import sys

from thymio_sim_ros.entry_points import thymio_sim

if __name__ == "__main__":
    sys.exit(thymio_sim())
