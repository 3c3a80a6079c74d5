"""Reads and runs programs with expected results in their comments (tests/data/programs/README.md)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from aseba_vm import CompileError, Program, VirtualMachine, aesl, compile
from aseba_vm.frontend.lint import CompileWarning
from aseba_vm.machine.machine_messages import Emitted, Message, NativeCalled
from tests.aseba_vm.vectors import targets

FOLDER = Path(__file__).parents[1] / "data" / "programs"
LIMIT = 20_000
"""Maximum number of instructions per event."""
VERBS = frozenset(
    ("target", "global", "constant", "event", "emits", "calls", "expect", "stops", "goes", "error", "warning")
)


@dataclass(frozen=True, slots=True)
class Order:
    """A comment ``#! verb words``; ``line`` is its line in the file."""

    line: int
    verb: str
    words: tuple[str, ...]

    def __str__(self) -> str:
        return " ".join(("#!", self.verb, *self.words))


class Scenario:
    """A program with its directives."""

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        network = aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, "thymio-II")
        self.node = network.nodes[0]
        self.orders = [self._order(number, line) for number, line in enumerate(text.split("\n"), 1) if "#! " in line]
        self.target = targets()[next((order.words[0] for order in self.orders if order.verb == "target"), "thymio2")]
        self.events = [*network.events, *((name, int(size)) for name, size in self._words_of("global"))]
        self.constants = [*network.constants, *((name, int(value)) for name, value in self._words_of("constant"))]

    def _order(self, number: int, line: str) -> Order:
        verb, *words = line.partition("#! ")[2].split()
        assert verb in VERBS, f"{self.name}:{number}: '#! {verb}' is not one of {', '.join(sorted(VERBS))}"
        return Order(number, verb, tuple(words))

    def _words_of(self, verb: str) -> list[tuple[str, ...]]:
        return [order.words for order in self.orders if order.verb == verb]

    def check(self, engine: str) -> None:
        """Compile and run. Raises AssertionError with the line of the file and the difference."""
        refusals = [order for order in self.orders if order.verb == "error"]
        try:
            program = compile(self.node.code, self.target, self.events, self.constants)
        except CompileError as error:
            self._compare(refusals[0] if refusals else None, "error", self._located(error), str(error))
            return
        assert not refusals, f"{self.name}:{refusals[0].line}: {refusals[0]}\nfound: a program that compiles"
        doubts = [" ".join(("#! warning", self._located(warning))) for warning in program.warnings]
        expected = [str(order) for order in self.orders if order.verb == "warning"]
        assert doubts == expected, f"{self.name}: expected warnings {expected}\nfound: {doubts}"
        _Play(self, program, engine).play()

    def _located(self, doubt: CompileError | CompileWarning) -> str:
        if doubt.pos is None:
            return doubt.kind
        row, col = self.node.place(doubt.pos.offset)
        return f"{doubt.kind} at {row + 1}:{col + 1}"

    def _compare(self, order: Order | None, verb: str, found: str, remark: str = "") -> None:
        place = self.name if order is None else f"{self.name}:{order.line}"
        expected = "nothing of the kind" if order is None else str(order)
        assert expected == f"#! {verb} {found}".rstrip(), f"{place}\nexpected: {expected}\nfound: {found} {remark}"


class _Play:
    """One run of a program and its directives."""

    def __init__(self, scenario: Scenario, program: Program, engine: str) -> None:
        self.scenario = scenario
        self.program = program
        self.addresses = scenario.target.addresses | program.addresses
        self.machine = VirtualMachine(scenario.target, engine=engine)
        self.rows = scenario.node.rows_in_file()
        self.machine.load(program)

    def play(self) -> None:
        said = self._run()
        last = None
        for order in self.scenario.orders:
            match order.verb:
                case "event":
                    self._nothing_more(last, said)
                    self._start(order)
                    said = self._run()
                case "expect":
                    self._expect(order)
                case "emits" | "calls" | "stops" | "goes":
                    found = next(said, "nothing")
                    assert found == str(order), self._complaint(order, found)
            last = order
        self._nothing_more(last, said)

    def _start(self, order: Order) -> None:
        name, *values = order.words
        numbers = [number for number, (event, _) in enumerate(self.scenario.events) if event == name]
        if numbers:
            self.machine.receive(numbers[-1], 1, list(map(int, values)))
        else:
            self.machine.start_local(0xFFFE - self.scenario.target.local_event_number(name))

    def _run(self) -> Iterator[str]:
        self.machine.run(LIMIT)
        said = [self._told(message) for message in self.machine.pop_messages()]
        fault = self.machine.fault
        if fault is not None:
            row = self.program.row_of(fault.pc)
            line = "?" if row is None else self.rows[row] + 1
            said.append(f"#! stops at {line}: {fault.message}")
        elif self.machine.is_active:
            said.append("#! goes on")
        self.machine.stop()
        self.machine.resume()
        self.machine.pop_messages()
        return iter([text for text in said if text])

    def _told(self, message: Message) -> str:
        match message:
            case Emitted(number, values):
                return _joined("emits", self.scenario.events[number][0], values)
            case NativeCalled(_, name, arguments):
                return _joined("calls", name, [word for _, _, words in arguments for word in words])
        return ""

    def _expect(self, order: Order) -> None:
        name, sign, *values = order.words
        assert sign == "=", f"{self.scenario.name}:{order.line}: '#! expect NAME = VALUES' is the form"
        address, size = self.addresses[name]
        found = self.machine.variables[address : address + size]
        assert found == list(map(int, values)), self._complaint(order, f"{name} = {' '.join(map(str, found))}")

    def _nothing_more(self, last: Order | None, said: Iterator[str]) -> None:
        more = list(said)
        assert not more, self._complaint(last, "more than that: " + ", ".join(more))

    def _complaint(self, order: Order | None, found: str) -> str:
        line = order.line if order else 1
        return f"{self.scenario.name}:{line}\nexpected: {order or 'nothing'}\nfound: {found}"


def _joined(verb: str, name: str, values: Sequence[int]) -> str:
    return " ".join(("#!", verb, name, *map(str, values)))
