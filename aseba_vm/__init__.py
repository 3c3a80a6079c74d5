"""Compiler, virtual machine and .aesl files of the Aseba language, without a robot; standard library only.

>>> from aseba_vm import VirtualMachine, compile, targets
>>> program = compile("var n = 2  n = n * 21", targets.THYMIO_II)
>>> machine = VirtualMachine(targets.THYMIO_II)
>>> machine.load(program)
>>> machine.run()
True
>>> machine.variables[program.addresses["n"][0]]
42
"""

from aseba_vm import aesl, targets
from aseba_vm.bytecode import EventEntry, SubEntry
from aseba_vm.debug import Debugger
from aseba_vm.dispatch import FirmwareDispatch, PlaygroundDispatch
from aseba_vm.errors import AeslError, AsebaError, CompileError, SourcePos, TargetError
from aseba_vm.frontend.pipeline import Program, Stages, compile, compile_stages
from aseba_vm.frontend.syntax_tree import Memory
from aseba_vm.machine import machine_messages
from aseba_vm.machine.native_call import Native, NativeCall
from aseba_vm.machine.native_faults import NativeFault
from aseba_vm.target import LocalEvent, NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.vm import VirtualMachine

__all__ = [
    "AeslError",
    "AsebaError",
    "CompileError",
    "Debugger",
    "EventEntry",
    "FirmwareDispatch",
    "LocalEvent",
    "Memory",
    "Native",
    "NativeCall",
    "NativeFault",
    "NativeFunction",
    "Parameter",
    "PlaygroundDispatch",
    "Program",
    "SourcePos",
    "Stages",
    "SubEntry",
    "TargetDescription",
    "TargetError",
    "Variable",
    "VirtualMachine",
    "aesl",
    "compile",
    "compile_stages",
    "machine_messages",
    "targets",
]
