"""The built-in behaviours once more, tick by tick, written from the tables of docs/spec/thymio-behaviors.md and nothing
else."""

from __future__ import annotations

from dataclasses import dataclass, field

FULL = 32
DARK3, RED3 = (0, 0, 0), (FULL, 0, 0)
DARK8 = (0,) * 8
ARROWS = ("backward", "left", "forward", "right")
STOP = -1
"""In place of a sound: silence."""


@dataclass(frozen=True)
class Senses:
    """What the robot perceives in one tick of 20 ms."""

    p: tuple[int, ...] = (0,) * 7
    g: tuple[int, int] = (900, 900)
    buttons: frozenset[str] = frozenset()
    touched: frozenset[str] = frozenset()
    acc: tuple[int, int, int] = (0, 0, 23)
    tap: bool = False
    clap: bool = False
    order: int | None = None
    frame: tuple[tuple[int, ...], int] | None = None
    sound_finished: bool = False


@dataclass
class Shown:
    """What the robot does after one tick; `sounds` those that began (or STOP) in it."""

    left: int = 0
    right: int = 0
    top: tuple[int, ...] = DARK3
    bottom_left: tuple[int, ...] = DARK3
    bottom_right: tuple[int, ...] = DARK3
    circle: tuple[int, ...] = DARK8
    tx: int = 0
    threshold: int = 0
    sounds: list[int] = field(default_factory=list)


def quotient(dividend: int, divisor: int) -> int:
    """As C divides: toward zero."""
    result = abs(dividend) // abs(divisor)
    return result if (dividend < 0) == (divisor < 0) else -result


def limited(value: int, limit: int) -> int:
    return max(-limit, min(limit, value))


def light(*levels: int) -> tuple[int, ...]:
    return tuple(min(level, FULL) for level in levels)


def only(*lit: int) -> tuple[int, ...]:
    """A circle with these lights on."""
    return tuple(FULL * (index in lit) for index in range(8))


class Pulse:
    """P of section 1."""

    def __init__(self) -> None:
        self.counter = 0

    def next(self) -> int:
        self.counter += 1
        if self.counter <= 0:
            return -self.counter // 4
        value = self.counter
        if value == 41:
            self.counter = -128
        return value


class Rainbow:
    """Section 1: three colors of the body."""

    def __init__(self) -> None:
        self.index = 0

    def next(self) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
        self.index = (self.index + 1) % 97
        a, b, c = (self._level(x if x <= 96 else x - 96) for x in (self.index, self.index + 32, self.index + 64))
        return (a, b, c), (c, a, b), (b, c, a)

    @staticmethod
    def _level(x: int) -> int:
        if x < 32:
            return x
        return 64 - x if x < 64 else 0


class Behaviour:
    """State of one behaviour; `tick` is one tick of it."""

    has_own_sounds = False

    def __init__(self) -> None:
        self.pulse = Pulse()
        self.shown = Shown()

    def tick(self, senses: Senses) -> Shown:
        self.shown.sounds = []
        self.perceive(senses)
        touched = [arrow for arrow in ARROWS if arrow in senses.touched]
        self.shown.sounds += [2] * (len(touched) if self.has_own_sounds else bool(touched))
        self.act(senses)
        return self.shown

    def perceive(self, senses: Senses) -> None:
        """What happens between two ticks."""

    def act(self, senses: Senses) -> None:
        raise NotImplementedError

    def drive(self, left: int, right: int) -> None:
        self.shown.left, self.shown.right = left, right

    def ground_safety(self, senses: Senses) -> None:
        """Section 1, after everything else is shown: bottom red says it."""
        over = min(senses.g) < 130
        if over:
            self.drive(0, 0)
        red = FULL if over else 0
        self.shown.bottom_left = (red, *self.shown.bottom_left[1:])
        self.shown.bottom_right = (red, *self.shown.bottom_right[1:])


class Cruising(Behaviour):
    """Speed by arrows, of friendly and explorer."""

    cruise = 0

    def __init__(self) -> None:
        super().__init__()
        self.speed = self.cruise

    def tick(self, senses: Senses) -> Shown:
        if "forward" in senses.touched:
            self.speed = min(self.speed + 50, 500)
        if "backward" in senses.touched:
            self.speed = max(self.speed - 50, -300)
        return super().tick(senses)


class Friendly(Cruising):
    cruise = 300
    has_own_sounds = True

    def __init__(self) -> None:
        super().__init__()
        self.rainbow = Rainbow()
        self.friend = 0
        self.flag = False
        self.was_seen = self.was_friend = False
        self.s, self.s_step = 0, 1

    def perceive(self, senses: Senses) -> None:
        if senses.frame is not None:
            self.hear(*senses.frame)

    def act(self, senses: Senses) -> None:
        if self.friend and not self.was_friend:
            self.shown.sounds.append(7)
        self.was_friend = self.friend > 0
        front = senses.p[:5]
        nearest = max(front)
        turn = (2 - front.index(nearest)) * quotient(self.speed, 2)
        forward = self.forward(nearest)
        sees = nearest > 500
        if sees and not self.was_seen:
            self.shown.sounds.append(6)
        self.was_seen = sees
        if turn != 0 or nearest < 500:
            self.flag = False
        elif forward == 0 and sees and not self.flag:
            self.flag = True
            self.shown.sounds.append(7)
        if nearest >= 500:
            self.drive(forward - turn, forward + turn)
        elif self.friend:
            self.drive(self.speed, self.speed)
        else:
            self.drive(0, 0)
        self.colors()
        self.ground_safety(senses)
        self.friend = max(0, self.friend - 1)

    def forward(self, nearest: int) -> int:
        result = 0
        if nearest > 3500:
            result = quotient(3500 - nearest, 2)
        if nearest > 4000:
            result = -self.speed
        if nearest < 3000:
            result = 300 - quotient(nearest - 1000, 7)
        if nearest < 2000:
            result = self.speed
        return limited(result, abs(self.speed))

    def hear(self, intensities: tuple[int, ...], rx: int) -> None:
        self.friend = 0
        strongest = max(intensities)
        k = intensities.index(strongest)
        if strongest > 3000:
            self.shown.tx = k
            if rx in (1, 2, 3) and k == 2:
                self.friend = 6

    def colors(self) -> None:
        level = self.pulse.next()
        self.s += self.s_step
        if self.s in (0, 31):
            self.s_step = -self.s_step
        shown, s = self.shown, self.s
        if self.friend and self.flag:
            shown.top, shown.bottom_left, shown.bottom_right = self.rainbow.next()
        else:
            shown.top = shown.bottom_left = shown.bottom_right = light(0, level, 0)
        around = (0, s // 16, s // 8, s, FULL, s, s // 8, s // 16)
        shown.circle = around if self.friend else only(3, 4, 5)


class Explorer(Cruising):
    cruise = 150

    def __init__(self) -> None:
        super().__init__()
        self.c = 0

    def act(self, senses: Senses) -> None:
        p, speed = senses.p, self.speed
        if speed >= 0:
            a = p[0] + 2 * p[1] + 3 * p[2] + 2 * p[3] + p[4]
            b = -4 * p[0] - 3 * p[1] + 3 * p[3] + 4 * p[4]
            left = speed - quotient((a + b) * speed, 2000)
            right = speed - quotient((a - b) * speed, 2000)
            self.drive(limited(left, 600), limited(right, 600))
        else:
            self.drive(speed - quotient(p[6] * speed, 300), speed - quotient(p[5] * speed, 300))
        level = self.pulse.next()
        self.shown.top = light(level, level, 0)
        self.c = (self.c + 2) % 256
        main, rest = divmod(self.c, 32)
        circle = [0] * 8
        circle[main] = FULL
        circle[main - 1] = FULL - rest
        circle[(main + 1) % 8] = rest
        self.shown.circle = tuple(circle)
        self.ground_safety(senses)


class Fearful(Behaviour):
    has_own_sounds = True

    def __init__(self) -> None:
        super().__init__()
        self.a = 32
        self.falling_ticks = 0
        self.is_crying = False

    def perceive(self, senses: Senses) -> None:
        if senses.sound_finished and self.is_crying:
            self.shown.sounds.append(4)

    def act(self, senses: Senses) -> None:
        p, (g0, g1) = senses.p, senses.g
        level = self.pulse.next()
        self.a = (3 * self.a + sum(map(abs, senses.acc))) // 4
        top = light(level, 0, 0)
        if self.a < 14:
            top = RED3 if self.falling_ticks % 10 >= 5 else DARK3
            self.falling_ticks += 1
        elif self.falling_ticks:
            top = (15, 0, 0)
            self.falling_ticks = 0
        if senses.tap:
            self.shown.sounds.append(5)
        rear = p[5] > 1000 or p[6] > 1000
        trapped = min(p[1:4]) > 1000 and rear and g0 > 130 and g1 > 130
        left = right = 0
        if trapped:
            pass
        elif max(p[:5]) > 1000:
            t = p[0] // 5 + p[1] // 4 + p[2] // 4 + p[3] // 4 + p[4] // 5
            u = p[0] // 6 + p[1] // 5 - p[3] // 5 - p[4] // 6
            left, right = -(t + u), u - t
        elif rear:
            left, right = p[5] // 4, p[6] // 4
        self.drive(limited(left, 600), limited(right, 600))
        self.shown.top = top
        self.shown.bottom_left = self.shown.bottom_right = light(level, 0, 0)
        self.ground_safety(senses)
        self.cry(self.falling_ticks > 0 or trapped)

    def cry(self, has_reason: bool) -> None:
        if has_reason != self.is_crying:
            self.shown.sounds.append(4 if has_reason else STOP)
        self.is_crying = has_reason


class Investigator(Behaviour):
    def __init__(self) -> None:
        super().__init__()
        self.black, self.white = 400, 450
        self.is_black = [True, True]
        self.last_turn = ""

    def act(self, senses: Senses) -> None:
        level = self.pulse.next()
        self.shown.top = light(0, level, level)
        mean = (senses.g[0] + senses.g[1]) // 2
        if {"backward", "forward"} <= senses.buttons:
            self.black = mean + 150
        elif {"left", "right"} <= senses.buttons:
            self.white = (mean if mean >= 150 else 200) - 150
        else:
            for side in (0, 1):
                if senses.g[side] < self.black:
                    self.is_black[side] = True
                elif senses.g[side] > self.white:
                    self.is_black[side] = False
            self.follow()
            return
        self.drive(0, 0)
        self.shown.circle = DARK8

    def follow(self) -> None:
        match self.is_black:
            case [True, True]:
                self.drive(300, 300)
                self.shown.circle = only(0, 4)
            case [False, True]:
                self.last_turn = "right"
                self.drive(300, 0)
                self.shown.circle = only(1, 3)
            case [True, False]:
                self.last_turn = "left"
                self.drive(0, 300)
                self.shown.circle = only(5, 7)
            case _ if self.last_turn == "left":
                self.drive(-300, 300)
                self.shown.circle = only(6)
            case _:
                self.drive(300, -300)
                if self.last_turn:
                    self.shown.circle = only(2)
                self.last_turn = "right"


KEYS = {
    "forward": (2, 80, 32),
    "backward": (8, 81, 33),
    "left": (4, 85, 17, 77),
    "right": (6, 86, 16, 78),
    "stop": (5, 87, 13),
}
"""Codes of the remote control, section 7."""


class Obedient(Behaviour):
    def __init__(self) -> None:
        super().__init__()
        self.l = self.t = 0

    def act(self, senses: Senses) -> None:
        for button in ("left", "right", "forward", "backward"):
            if button in senses.touched:
                self.obey(button)
        if {"forward", "backward"} <= senses.buttons:
            self.l = 0
        if {"left", "right"} <= senses.buttons:
            self.t = 0
        for key, codes in KEYS.items():
            if senses.order in codes:
                self.obey(key)
        self.l, self.t = limited(self.l, 600), limited(self.t, 600)
        self.drive(self.l + self.t, self.l - self.t)
        level = self.pulse.next()
        self.shown.top = light(level, 0, level)

    def obey(self, word: str) -> None:
        if word in ("left", "right"):
            self.t = -150 if word == "left" else 150
        elif word == "stop":
            self.l = self.t = 0
        elif self.t != 0:
            self.t = 0
        else:
            self.l += 150 if word == "forward" else -150


class Attentive(Behaviour):
    has_own_sounds = True

    def __init__(self) -> None:
        super().__init__()
        self.rainbow = Rainbow()
        self.shown.threshold = 246
        self.time, self.count, self.claptime = 100, 0, 0
        self.state = "stopped"
        self.disco = 0

    def perceive(self, senses: Senses) -> None:
        if senses.clap:
            self.hear()

    def act(self, senses: Senses) -> None:
        self.time = min(100, self.time + 1)
        if self.time > 50:
            self.count = 0
            self.shown.circle = DARK8
        self.obey()
        level = self.pulse.next()
        if self.disco:
            self.disco -= 1
            self.shown.top, self.shown.bottom_left, self.shown.bottom_right = self.rainbow.next()
        else:
            self.shown.top = light(0, 0, level)
            self.shown.bottom_left = self.shown.bottom_right = DARK3
        self.ground_safety(senses)

    def hear(self) -> None:
        if self.count == 0:
            self.time, self.count = 0, 1
            self.shown.circle = only(0)
        elif self.count == 1 and 2 < self.time < 30:
            self.count, self.claptime = 2, self.time + 1
            self.shown.circle = only(0, 1, 7)
        elif self.count == 2 and self.claptime < self.time < 40:
            self.count, self.disco = 3, 0
            self.shown.circle = only(0, 1, 2, 6, 7)
            self.shown.sounds.append(7)

    def obey(self) -> None:
        match (self.time, self.count, self.state):
            case (5, 1, "running"):
                self.state = "spinning"
                self.drive(80, -80)
            case (5, 1, "spinning") | (30, 2, "stopped"):
                self.state = "running"
                self.drive(80, 80)
            case (30, 2, _):
                self.state = "stopped"
                self.drive(0, 0)
            case (40, 3, _):
                self.state = "running"
                self.drive(80, 0)
                self.disco = 126


ORACLES: dict[str, type[Behaviour]] = {
    "friendly": Friendly,
    "explorer": Explorer,
    "fearful": Fearful,
    "investigator": Investigator,
    "obedient": Obedient,
    "attentive": Attentive,
}
