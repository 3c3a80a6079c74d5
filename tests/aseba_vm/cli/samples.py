"""Programs and command lines that the tests of the command line share."""

import os
import sys

ASEBA = [sys.executable, "-m", "aseba_vm"]


ASCII = os.environ | {"PYTHONIOENCODING": "ascii"}


GOOD = "var n = 1\nonevent ping\nn = n + event.args[0]\nemit ping n\ncall leds.top(n, 0, 32)\n"


AESL = """<!DOCTYPE aesl-source>
<network>
<event size="1" name="ping"/>
<constant value="7" name="START"/>
<node nodeId="1" name="thymio-II">var n = START
onevent ping
n = {code}
</node>
</network>
"""
