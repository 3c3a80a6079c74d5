"""A remote robot joined in memory with a device of ours: what one sends is decoded by the other."""

from __future__ import annotations

from aseba_vm.protocol import Message, decode, encode
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_node import NetworkNode
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.remote.remote_robot import RemoteRobot
from thymio_sim_ros.sim.commands import Command

TICK_NS = 50_000_000


class Pair:
    """Both ends and the commands that the device's actuators got. Time passes in `tick`."""

    def __init__(self, layout: str = "thymio", number: int = 3) -> None:
        self.host = BehaviorHost(AsebaDevice(node_id=number, options=DeviceOptions(layout)))
        self.device = self.host.device
        self.node = NetworkNode(self.host)
        self.node.connect(1)
        self.robot = RemoteRobot()
        self.remote = self.robot.device
        self.commands: list[Command] = []
        self.is_plugged = True
        self.now_ns = 0

    def plug_in(self) -> None:
        """Connect the stream."""
        self.is_plugged = True
        self.robot.start(self.now_ns)
        self.tick()

    def pull(self) -> None:
        """Pull the cable."""
        self.is_plugged = False
        self.robot.end("cable pulled")

    def tick(self, times: int = 1) -> None:
        """Poll, and let the device run; messages go there and back."""
        for _ in range(times):
            self.now_ns += TICK_NS
            self.robot.poll(self.now_ns)
            self.exchange()

    def exchange(self) -> None:
        """Deliver messages until there are none."""
        while True:
            to_node = self.robot.pop_messages()
            to_robot: list[Message] = []
            if self.is_plugged:
                for message in to_node:
                    to_robot += self.node.handle(1, decode(encode(message)))
            self.node.install_bytecode()
            self.device.advance(self.now_ns)
            self.device.run(5000)
            self.commands += self.device.pop_commands()
            self.device.pop_events()
            to_robot += self.node.pop_messages()
            if not to_node and not to_robot:
                return
            if self.is_plugged:
                for message in to_robot:
                    self.robot.receive(decode(encode(message)))

    def load(self, source: str, *events: tuple[str, int]) -> ThymioProgram:
        """Load a program by the network."""
        declared = "".join(f'<event size="{size}" name="{name}"/>' for name, size in events)
        code = source.replace("&", "&amp;").replace("<", "&lt;")
        text = f'<network>{declared}<node name="thymio-II">{code}</node></network>'
        program = load_program(text if events else source, "test.aesl", self.remote.layout)
        self.remote.load(program)
        self.exchange()
        return program

    def value(self, name: str) -> tuple[int, ...]:
        """A variable of the device itself."""
        return self.device.variables.get(name)
