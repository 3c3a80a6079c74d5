"""The six built-in behaviours against their tables, tick by tick over random histories of the senses."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.device.behaviour_oracle import ARROWS, ORACLES, STOP, Investigator, Senses, Shown
from tests.seeds import seeds
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.behavior_host import built_in
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.sim.commands import BUTTONS, MotorTargets, PlaySystemSound, SetLeds, ShowOnLeds, StopSound

TICK_NS = 20_000_000
BUDGET = 20_000
TICKS = 2000

BORDERS = (0, 499, 500, 501, 999, 1000, 1001, 1500, 1999, 2000, 2999, 3000, 3499, 3500, 3501, 3502, 4000, 4001, 4505)
GROUNDS = (0, 129, 130, 131, 149, 150, 151, 399, 400, 401, 450, 451, 600, 900, 1023)
ORDERS = (2, 80, 32, 8, 81, 33, 4, 85, 17, 77, 6, 86, 16, 78, 5, 87, 13, 1, 99)


class Bench:
    """A device with a behaviour and nothing around it: senses in, what it shows out."""

    def __init__(self, behaviour: str, device: AsebaDevice | None = None) -> None:
        self.behaviour = behaviour
        self.device = device or AsebaDevice()
        self.device.load(built_in(behaviour))
        self.device.advance(0)
        self.now_ns = 0
        self.shown = Shown()
        self._run()

    def tick(self, senses: Senses) -> Shown:
        """What is perceived comes first, then the tick."""
        feed(self.device, "buttons", {f"button.{name}": (int(name in senses.buttons),) for name in BUTTONS})
        feed(self.device, "prox", {"prox.horizontal": senses.p})
        self.device.feed("ground", (0, 0, *senses.g, *senses.g))
        feed(self.device, "acc", {"acc": senses.acc})
        if senses.tap:
            feed(self.device, "tap", {"acc._tap": (1,)})
        if senses.clap:
            feed(self.device, "mic", {"mic.intensity": (250,)})
        if senses.order is not None:
            feed(self.device, "rc5", {"rc5.command": (senses.order,)})
        if senses.sound_finished:
            feed(self.device, "sound.finished", {})
        if senses.frame is not None:
            intensities, rx = senses.frame
            feed(self.device, "prox.comm", {"prox.comm.rx._intensities": intensities, "prox.comm.rx": (rx,)})
        self.shown.sounds = []
        self._run()
        self.now_ns += TICK_NS
        self.device.advance(self.now_ns)
        self._run()
        return self.shown

    def _run(self) -> None:
        while self.device.is_busy:
            self.device.run(BUDGET)
        for command in self.device.pop_commands():
            match command:
                case MotorTargets(left, right):
                    self.shown.left, self.shown.right = left, right
                case SetLeds(("top" | "bottom_left" | "bottom_right" | "circle") as group, levels):
                    setattr(self.shown, group, levels)
                case ShowOnLeds("circle", levels) if self.behaviour != "fearful":  # which alone shows how it leans
                    self.shown.circle = levels
                case PlaySystemSound(number):
                    self.shown.sounds.append(number)
                case StopSound():
                    self.shown.sounds.append(STOP)
        (self.shown.tx,) = self.device.variables.get("prox.comm.tx")
        (self.shown.threshold,) = self.device.variables.get("mic.threshold")


def feed(device: AsebaDevice, event: str, values: dict[str, tuple[int, ...]]) -> None:
    """A reading of the sensor that raises this event: these variables, the others of it as they are."""
    number = 0xFFFE - target().local_event_number(event)
    sensor, binding = next((name, one) for name, one in bindings.sensors().items() if one.event == number)
    names = {address: name for name, (address, _size) in target().addresses.items()}
    words = [values.get(names[slot.address], device.variables.get(names[slot.address])) for slot in binding.slots]
    device.feed(sensor, [word for part in words for word in part])


def histories(seed: int) -> Iterator[Senses]:
    """Random senses that dwell, jump to borders, and hold and release buttons."""
    chance = random.Random(seed)
    p, g, acc = [0] * 7, [900, 900], [0, 0, 23]
    held: set[str] = set()
    often = ("left", "backward", "forward")[seed % 3]
    for _ in range(TICKS):
        if chance.random() < 0.2:
            reach = chance.choice([0, 300, 1200, 4505, 5300])
            p = [chance.choice([0, chance.choice(BORDERS), chance.randint(0, reach)]) for _ in range(7)]
            p[chance.randrange(5)] = chance.choice(BORDERS)
        if chance.random() < 0.1:
            g = [chance.choice(GROUNDS), chance.choice(GROUNDS)] if chance.random() < 0.6 else [900, 900]
        if chance.random() < 0.05:
            acc = chance.choice([[0, 0, 23], [1, -1, 2], [-12, 5, 18], [chance.randint(-32, 32) for _ in range(3)]])
        before = set(held)
        if chance.random() < 0.1:
            held ^= {chance.choice((*ARROWS, *[often] * 6))}
        if chance.random() < 0.01:
            held = set(chance.choice([(), ("left", "right"), ("forward", "backward")]))
        intensities = tuple(chance.choice([0, 1400, 2999, 3000, 3001, chance.randint(1400, 4600)]) for _ in range(7))
        if chance.random() < 0.5:
            intensities = (0, 0, chance.choice([3000, 3001, 4000]), 0, 0, 0, 0)
        yield Senses(
            p=tuple(p),
            g=(g[0], g[1]),
            buttons=frozenset(held),
            touched=frozenset(held - before),
            acc=(acc[0], acc[1], acc[2]),
            tap=chance.random() < 0.02,
            clap=chance.random() < 0.06,
            order=chance.choice(ORDERS) if chance.random() < 0.1 else None,
            frame=(intensities, chance.choice([0, 1, 2, 3, 4])) if chance.random() < 0.15 else None,
            sound_finished=chance.random() < 0.05,
        )


@pytest.mark.parametrize("seed", seeds(3))
@pytest.mark.parametrize("behaviour", ORACLES)
def test_a_behaviour_does_what_its_table_says(behaviour: str, seed: int) -> None:
    bench, oracle = Bench(behaviour), ORACLES[behaviour]()
    for number, senses in enumerate(histories(seed)):
        assert bench.tick(senses) == oracle.tick(senses), (number, senses)


def test_friendly_dances_before_a_friend_as_its_table_says() -> None:
    bench, oracle = Bench("friendly"), ORACLES["friendly"]()
    for tick in range(400):
        senses = Senses(
            p=(0, 0, 3000 + tick, 0, 0, 0, 0),
            g=(900, 100) if tick % 50 == 49 else (900, 900),
            frame=((0, 0, 4000, 0, 0, 0, 0), 1 + tick % 3) if tick % 5 == 0 else None,
        )
        assert bench.tick(senses) == oracle.tick(senses), tick


@pytest.mark.parametrize("seed", range(3))
def test_investigator_keeps_to_its_levels_whatever_they_are(seed: int) -> None:
    chance = random.Random(seed)
    bench, oracle = Bench("investigator"), Investigator()
    for pair in ("", "left right", "forward backward", "left right", "left right"):
        held, shade = frozenset(pair.split()), chance.choice([149, 150, 151, chance.randint(152, 900)])
        for touched in (held, frozenset[str](), frozenset[str]()):
            senses = Senses(g=(shade, shade + 1), buttons=held, touched=touched)
            assert bench.tick(senses) == oracle.tick(senses), senses
        borders = [level + step for level in (oracle.black, oracle.white) for step in (-1, 0, 1)]
        for _ in range(200):
            senses = Senses(g=(chance.choice(borders), chance.choice(borders)))
            assert bench.tick(senses) == oracle.tick(senses), senses


def test_investigator_keeps_its_levels_on_the_card(tmp_path: Path) -> None:
    device = AsebaDevice(options=DeviceOptions(card=tmp_path))
    bench = Bench("investigator", device)
    both = frozenset(("backward", "forward"))
    bench.tick(Senses(g=(200, 300), buttons=both, touched=both))
    bench.tick(Senses(g=(200, 300)))
    assert device.variables.get("black") == (400,)
    bench.tick(Senses(g=(300, 300), buttons=both, touched=both))
    bench.tick(Senses(g=(300, 300)))
    assert (tmp_path / "u450.dat").read_bytes() == (450).to_bytes(2, "little") * 2
    Bench("investigator", device)
    assert (device.variables.get("black"), device.variables.get("white")) == ((450,), (450,))
