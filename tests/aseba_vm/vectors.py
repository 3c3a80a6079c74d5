"""Golden answers of the reference, and functions that produce the same records with this package."""

from __future__ import annotations

import gzip
import json
import struct
import zlib
from functools import cache
from pathlib import Path
from typing import Any

from aseba_vm import Program, TargetDescription, VirtualMachine, compile
from aseba_vm.machine.machine_messages import (
    BadCode,
    BreakpointSet,
    DivisionByZero,
    Emitted,
    EventKilled,
    ExecutionState,
    Message,
    NativeCalled,
    NodeSpecific,
    OutOfBounds,
    VariablesRead,
)
from aseba_vm.machine.natives import NATIVES

SHIPPED = Path(__file__).parents[1] / "data" / "vectors"
FILES = ("aseba-compile", "aseba-errors", "aseba-execution", "aseba-execution-2x", "aseba-aesl")

Vector = dict[str, Any]


def _paths(folder: Path, name: str) -> list[Path]:
    """The files of a set with vectors of a kind, plain or compressed: ``NAME.jsonl``, ``NAME-anything.jsonl.gz`` …

    The machine of the 2.x fork answers the files of aseba-execution with ``-2x`` in their name.
    """
    is_fork, stem = name.endswith("-2x"), name.removesuffix("-2x")
    found: dict[str, Path] = {}
    for suffix in (".jsonl", ".jsonl.gz"):
        for path in sorted(folder.glob(f"{stem}*{suffix}")):
            rest = path.name.removeprefix(stem).removesuffix(suffix)
            if rest[:1] in ("", "-") and ("-2x" in rest) == is_fork:
                found.setdefault(stem + rest, path)
    return list(found.values())


def is_set(folder: Path) -> bool:
    """Return whether a folder has vectors."""
    return any(_paths(folder, name) for name in FILES)


@cache
def targets(folder: Path = SHIPPED) -> dict[str, TargetDescription]:
    path = folder / "aseba-targets.json"
    data = json.loads((path if path.is_file() else SHIPPED / path.name).read_text("utf-8"))
    return {name: TargetDescription.from_data(target) for name, target in data.items()}


@cache
def load(name: str, folder: Path = SHIPPED) -> tuple[Vector, ...]:
    """Vectors of a kind in a set, none if the set lacks it. Each remembers its folder, for its targets."""
    lines: list[str] = []
    for path in _paths(folder, name):
        data = path.read_bytes()
        lines += (gzip.decompress(data) if path.suffix == ".gz" else data).decode("utf-8").split("\n")
    return tuple({**json.loads(line), "folder": folder} for line in lines if line.strip())


def target_of(vector: Vector) -> TargetDescription:
    return targets(vector["folder"])[vector["target"]]


def compiled(vector: Vector) -> Program:
    return compile(
        vector["source"],
        target_of(vector),
        [(name, size) for name, size in vector["events"]],
        [(name, value) for name, value in vector["constants"]],
    )


def as_answer(program: Program) -> Vector:
    """Return a program in the format of the vectors."""
    return {
        "bytecode": list(program.words),
        "lines": list(program.lines),
        "allocated": program.allocated,
        "variables": [[variable.name, variable.address, variable.size] for variable in program.variables],
        "events": [[event.number, event.address, event.name] for event in program.events],
        "subs": [[sub.name, sub.address, sub.row] for sub in program.subs],
        "stack": list(program.stack),
    }


def as_list(value: object) -> object:
    return [as_list(item) for item in value] if isinstance(value, tuple | list) else value


def as_tuple(value: object) -> Any:
    return tuple(map(as_tuple, value)) if isinstance(value, list) else value


def said(message: Message) -> Vector:
    """Return a message of the machine in the format of the vectors."""
    match message:
        case Emitted(number, arguments):
            return {"emit": number, "args": list(arguments)}
        case NativeCalled(number, name, arguments):
            return {"call": name, "id": number, "args": [[at, size, list(words)] for at, size, words in arguments]}
        case ExecutionState(pc, flags):
            return {"state": {"pc": pc, "flags": flags}}
        case BreakpointSet(pc, is_set):
            return {"breakpoint": {"pc": pc, "ok": int(is_set)}}
        case VariablesRead(start, values):
            return {"variables": {"start": start, "values": list(values)}}
        case EventKilled(pc):
            return {"exception": "event-killed", "pc": pc}
        case OutOfBounds(pc, None, None):
            return {"exception": "out-of-bounds", "pc": pc}
        case OutOfBounds(pc, size, index):
            return {"exception": "out-of-bounds", "pc": pc, "size": size, "index": index}
        case DivisionByZero(pc):
            return {"exception": "division-by-zero", "pc": pc}
        case NodeSpecific(pc, reason):
            return {"exception": "node-specific", "pc": pc, "reason": reason}
        case BadCode(_, reason):
            return {"exception": "assert", "reason": reason}


class Replay:
    """A machine that executes the script of a vector and records the results."""

    def __init__(self, vector: Vector, *, kills_long_events: bool, is_traced: bool) -> None:
        target = target_of(vector)
        natives = {native.name: self._recorder(number, native.name) for number, native in enumerate(target.natives)}
        self.machine = VirtualMachine(target, natives, kills_long_events=kills_long_events)
        self.bytecode = vector["bytecode"]
        self.trace: list[int] = []
        if is_traced:
            self.machine.tracer = self.trace.append
        self.memory = list(self.machine.variables)
        self.code = self.machine.bytecode

    def _recorder(self, number: int, name: str) -> Any:
        standard = NATIVES.get(name)

        def native(call: Any) -> None:
            self.machine.outbox.append(call.record(number))
            if standard is not None:
                standard(call)

        return native

    def record(self, operation: Vector) -> Vector:
        """Execute one operation; return its record."""
        self.trace.clear()
        record = self._obey(operation)
        record["out"] = [said(message) for message in self.machine.pop_messages()]
        record["changed"] = _runs(self.memory, self.machine.variables)
        self.memory = list(self.machine.variables)
        record["memory_crc"] = zlib.crc32(struct.pack(f"<{len(self.memory)}h", *self.memory))
        if any(entry.get("exception") == "assert" for entry in record["out"]):
            record.pop("ran", None)
        else:
            record |= {"pc": self.machine.pc, "sp": self.machine.sp, "flags": self.machine.flags}
        code = self.machine.bytecode
        if code != self.code and operation["do"] != "load":
            changes = enumerate(zip(self.code, code, strict=True))
            record["bytecode_changed"] = [[at, new] for at, (old, new) in changes if old != new]
        self.code = code
        return record

    def _obey(self, operation: Vector) -> Vector:
        machine = self.machine
        match operation["do"]:
            case "load":
                machine.set_bytecode(self.bytecode)
            case "reset":
                machine.reset()
            case "run":
                machine.resume()
            case "pause":
                machine.pause()
            case "step":
                machine.step()
            case "stop":
                machine.stop()
            case "get-state":
                machine.report_state()
            case "break":
                machine.set_breakpoint(operation["pc"])
            case "unbreak":
                machine.clear_breakpoint(operation["pc"])
            case "unbreak-all":
                machine.clear_breakpoints()
            case "go":
                return self._go(operation.get("limit", 0))
            case "event":
                machine.receive(operation["id"], operation.get("source", 0), operation.get("args", []))
            case "local":
                machine.start_local(operation["index"])
            case "setup":
                machine.setup(operation["id"])
            case "poke":
                machine.write_variables(operation["addr"], operation["values"])
            case "peek":
                machine.report_variables(operation["addr"], operation["count"])
            case "seed":
                machine.random_state = operation["value"]
            case other:
                raise AssertionError(other)
        return {}

    def _go(self, limit: int) -> Vector:
        before = self.machine.instructions
        has_run = self.machine.run(limit)
        record: Vector = {"ran": int(has_run), "instructions": self.machine.instructions - before}
        if self.machine.tracer is not None:
            record["trace_crc"] = zlib.crc32(struct.pack(f"<{len(self.trace)}H", *self.trace))
            if 1 <= len(self.trace) <= 48:
                record["trace"] = list(self.trace)
        return record


def _runs(old: list[int], new: list[int]) -> list[list[Any]]:
    runs: list[list[Any]] = []
    for address, (before, after) in enumerate(zip(old, new, strict=True)):
        if before == after:
            continue
        if runs and runs[-1][0] + len(runs[-1][1]) == address:
            runs[-1][1].append(after)
        else:
            runs.append([address, [after]])
    return runs
