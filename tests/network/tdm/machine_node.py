"""A node of an Aseba network in memory: a machine that answers as docs/spec/aseba-protocol.md section 1.4 says."""

from __future__ import annotations

from collections.abc import Iterator

from aseba_vm import VirtualMachine, machine_messages, targets
from aseba_vm import protocol as p
from aseba_vm.target import TargetDescription


class MachineNode:
    """A machine with an id. Messages are executed at once; `run` executes the handlers."""

    def __init__(self, number: int = 1, target: TargetDescription = targets.THYMIO_II) -> None:
        self.number = number
        self.vm = VirtualMachine(target)
        self.name = ""

    def handle(self, message: p.Message) -> list[p.Message]:
        """Execute a message and return what the node sends."""
        if isinstance(message, p.Command) and message.node != self.number:
            return []
        replies = list(self._execute(message))
        return [*replies, *self._reports()]

    def run(self, limit: int = 1000) -> list[p.Message]:
        """Execute the active handler, and return what the node sends."""
        self.vm.run(limit)
        return self._reports()

    def start(self, event: int) -> list[p.Message]:
        """Start a handler and execute it."""
        self.vm.setup(event)
        return self.run()

    def value(self, name: str) -> tuple[int, ...]:
        """Words of a variable of the target."""
        address, size = self.vm.target.addresses[name]
        return tuple(self.vm.variables[address : address + size])

    def _execute(self, message: p.Message) -> Iterator[p.Message]:
        vm, number = self.vm, self.number
        match message:
            case p.ListNodes():
                yield p.NodePresent(number, min(message.version, 9))
            case p.GetNodeDescription():
                yield from self._description()
            case p.GetVariables(start=start, count=count):
                yield p.Variables(number, start, tuple(vm.variables[start : start + count]))
            case p.SetVariables(start=start, values=values):
                vm.write_variables(start, values)
            case p.SetBytecode(start=start, words=words):
                vm.set_bytecode(words, start)
                vm.reset()
            case p.Reset():
                vm.reset()
            case p.Run():
                vm.resume()
            case p.Pause():
                vm.pause()
            case p.Step():
                vm.step()
            case p.Stop():
                vm.stop()
            case p.GetExecutionState():
                vm.report_state()
            case p.SetBreakpoint(pc=pc):
                vm.set_breakpoint(pc)
            case p.ClearAllBreakpoints():
                vm.clear_breakpoints()
            case p.SetDeviceInfo(kind=2, data=data):
                self.name = data.decode()
            case p.GetDeviceInfo(kind=2):
                yield p.DeviceInfo(number, 2, b"a real one")
            case p.UserMessage(number=event, words=words, source=source):
                vm.receive(event, source, words)

    def _description(self) -> Iterator[p.Message]:
        target, number = self.vm.target, self.number
        sizes = target.bytecode_size, target.stack_size, target.variables_size
        counts = len(target.variables), len(target.local_events), len(target.natives)
        yield p.Description(number, target.name, 9, *sizes, *counts)
        for variable in target.variables:
            yield p.NamedVariable(number, variable.size, variable.name)
        for event in target.local_events:
            yield p.LocalEventDescription(number, event.name, event.description)
        for native in target.natives:
            yield p.NativeFunctionDescription(number, native.name, native.description, native.parameters)

    def _reports(self) -> list[p.Message]:
        number = self.number
        found: list[p.Message] = []
        for message in self.vm.pop_messages():
            match message:
                case machine_messages.Emitted(event, words):
                    found.append(p.UserMessage(number, event, words))
                case machine_messages.ExecutionState(pc, flags):
                    found.append(p.ExecutionStateChanged(number, pc, flags))
                case machine_messages.BreakpointSet(pc, is_set):
                    found.append(p.BreakpointSetResult(number, pc, int(is_set)))
                case machine_messages.DivisionByZero(pc):
                    found.append(p.DivisionByZero(number, pc))
                case machine_messages.OutOfBounds(pc, size, index):
                    found.append(p.ArrayAccessOutOfBounds(number, pc, size or 0, index or 0))
                case machine_messages.EventKilled(pc):
                    found.append(p.EventExecutionKilled(number, pc))
        return found
