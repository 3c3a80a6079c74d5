"""What natives take, beside what they are charged (`thymio_sim_ros/device/costs.py`).

    PYTHONPATH=. python benchmarks/aseba_costs.py [--rounds 200]

The unit is an instruction on the interpreter, in a loop that counts. Each native is called in Python with arguments of
one word and, where it takes any number, of a hundred: the median of the rounds. "short" are natives that take more than
five times their charge.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from aseba_vm import VirtualMachine, compile
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.machine.native_call import Signature
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.costs import BYTES_PER_INSTRUCTION, COSTS
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.options import DeviceOptions

COUNT = "var i\nvar k = 0\nwhile k == 0 do\ni = i + 1\nend"
FIRST = 200
"""Address of the first argument: behind the robot's own variables."""
MANY = 100
SHORT = 5.0
SOUND_BYTES = 1_000_000


def instruction_us() -> float:
    """Time of an instruction."""
    machine = VirtualMachine(THYMIO_II, engine=INTERPRETER)
    machine.load(compile(COUNT, THYMIO_II))
    machine.run(1000)
    return min(_timed(lambda: machine.run(20_000)) for _ in range(20)) / 20_000


def _timed(act: Callable[[], object]) -> float:
    begin = time.perf_counter()
    act()
    return (time.perf_counter() - begin) * 1e6


def measure(rounds: int) -> None:
    """Print the table."""
    unit_us = instruction_us()
    print(f"an instruction: {unit_us:.3f} us")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        device = AsebaDevice(options=DeviceOptions(card=folder / "card", settings=folder / "settings"))
        for letter in "pr":
            (folder / "card" / f"{letter}1.wav").write_bytes(bytes(44 + SOUND_BYTES))
        machine = device._vm
        for number, native in enumerate(target().natives):
            signature = Signature.of(native, COSTS.of(native.name))
            for size in (1, MANY) if native.free_sizes else (1,):
                addresses, end = [], FIRST
                for parameter in native.parameters:
                    addresses.append(end)
                    end += parameter.size if parameter.size > 0 else size
                popped = addresses + [size] * (signature.count - len(addresses))
                if end > len(machine.variables):
                    continue
                times = []
                for _ in range(rounds if "flash" not in native.name and "sound." not in native.name else 20):
                    machine.variables[FIRST:end] = [1] * (end - FIRST)
                    device.body.wanted = ""
                    machine.extra_cost = 0
                    times.append(_timed(lambda: machine.invoke(number, 0, popped)))  # noqa: B023  # called at once
                charged = 1 + signature.call_cost(popped) + machine.extra_cost
                machine.extra_cost = 0
                device.pop_commands()
                device.load_meter.pop()
                machine.pop_messages()
                taken = statistics.median(times) / unit_us
                mark = "  short" if taken > SHORT * charged else ""
                print(f"{native.name:24s} {size:4d} words {taken:9.0f} instructions, charged {charged:6d}{mark}")
    print(f"bytes of a sound for an instruction: {BYTES_PER_INSTRUCTION}; an event: {COSTS.emit}")


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=200)
    measure(parser.parse_args().rounds)


if __name__ == "__main__":
    main()
