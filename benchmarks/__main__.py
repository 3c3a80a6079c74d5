"""The command: `python -m benchmarks --help`."""

import sys

from benchmarks.lib.command import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
