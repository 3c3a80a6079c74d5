"""Entry point of `python -m aseba_vm`, the same as the command `aseba`."""

import sys

from aseba_vm.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
