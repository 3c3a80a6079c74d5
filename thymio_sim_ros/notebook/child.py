"""`python -m thymio_sim_ros.notebook.child`: `thymio-sim` that ends when its standard input does.

So it ends with the process that has started it, however that ends.
"""

from __future__ import annotations

import os
import signal
import sys
import threading

from thymio_sim_ros.cli.main import main

STDIN = 0


def _end_with_input() -> None:
    while os.read(STDIN, 1024):
        pass
    signal.raise_signal(signal.SIGINT)


if __name__ == "__main__":
    threading.Thread(target=_end_with_input, daemon=True).start()
    sys.exit(main())
