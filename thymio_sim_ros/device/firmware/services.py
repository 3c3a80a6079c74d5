"""Services of the firmware: card, settings, radio, sound recording, power switch.

They exist as long as the device. A reset of the program closes files; a restart also drops unsaved settings.
"""

from __future__ import annotations

from collections.abc import Callable

from thymio_sim_ros.device.firmware.sd_card import SdCard
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.firmware.sound_recorder import SoundRecorder
from thymio_sim_ros.sim.audio.synthesis import SYSTEM_SOUNDS
from thymio_sim_ros.sim.commands import (
    Command,
    PlaySamples,
    PlaySystemSound,
    SetVolume,
    StopSound,
)

__all__ = ["RESTART", "SWITCH_OFF", "FirmwareServices"]

RESTART, SWITCH_OFF = "restart", "off"
"""Requests of a program for the whole robot."""

Send = Callable[[Command], None]
Notify = Callable[[str], None]


class FirmwareServices:
    """The services of one robot.

    `send` receives commands for actuators, `notify` messages for the user; `recalibrate` is called when the
    calibration of the motors may have changed.
    """

    def __init__(
        self,
        node_id: int,
        *,
        card: SdCard | None,
        settings: Settings,
        send: Send,
        notify: Notify,
        recalibrate: Callable[[], None],
    ) -> None:
        self._first_id = node_id
        self.node_id = node_id
        self.network = (0, 0)
        """Channel and network of the radio: robots receive events of their own network only."""
        self.card = card
        self.settings = settings
        self.requested = ""
        """RESTART or SWITCH_OFF until the device has executed the request, else empty."""
        self.notify = notify
        self._send = send
        self._recalibrate = recalibrate
        self._recorder: SoundRecorder | None = None
        self._now_ns = 0

    @property
    def is_recording(self) -> bool:
        """Whether sound is recorded."""
        return self._recorder is not None

    def reset(self) -> None:
        """Reset the services when the program restarts."""
        self.stop_recording()
        if self.card is not None:
            self.card.close()
        self._send(SetVolume(self.settings.volume_shift))

    def reinitialize(self) -> None:
        """Return to the state of a new robot: drop unsaved settings and those of the radio."""
        self.settings.reload()
        self.node_id, self.network = self._first_id, (0, 0)

    def advance(self, now_ns: int, intensity: int) -> None:
        """Advance simulated time; `intensity` is the current reading of the microphone."""
        self._now_ns = now_ns
        if self._recorder is not None:
            self._recorder.record_until(now_ns, intensity)

    def change_setting(self, address: int, value: int) -> None:
        """Change a word of the settings; it takes effect at once."""
        self.settings[address] = value
        self._send(SetVolume(self.settings.volume_shift))
        self._recalibrate()

    def flash_settings(self) -> None:
        """Keep the settings for the next restart."""
        problem = self.settings.flash()
        if problem:
            self.notify(problem)

    def play_system_sound(self, number: int) -> int:
        """Play a system sound, or a sound of the card for an unknown number; −1 stops. Returns the bytes read."""
        if number == -1:
            self._send(StopSound())
            return 0
        found = None if 0 <= number < len(SYSTEM_SOUNDS) else self._play_file(f"s{number}")
        if found is None:
            self._send(PlaySystemSound(number))
        return found or 0

    def play(self, name: str, number: int) -> int:
        """Play a sound of the card, by the letter of its kind and its number; −1 or a missing sound stops.

        Returns the bytes read.
        """
        found = None if number == -1 else self._play_file(f"{name}{number}")
        if found is None:
            self._send(StopSound())
        if found is None and number != -1:
            self.notify(f"there is no {name}{number}.wav on the card" if self.card else f"no card: {name}{number}.wav")
        return found or 0

    def record(self, number: int) -> int:
        """Start recording; −1 stops and stores. Returns the bytes written."""
        written = self.stop_recording()
        if number >= 0 and self.card is not None:
            self._recorder = SoundRecorder(number, self._now_ns)
        return written

    def stop_recording(self) -> int:
        """Stop and store the current recording, if any; return the bytes written."""
        recorder, self._recorder = self._recorder, None
        if recorder is None or self.card is None:
            return 0
        samples = recorder.samples
        if not self.card.write_sound(f"r{recorder.number}", samples):
            self.notify(f"r{recorder.number}.wav cannot be stored on the card")
            self.notify_card_full()
        return len(samples)

    def notify_card_full(self) -> None:
        """Notify the user if the last operation failed because the card is full."""
        if self.card is not None and self.card.refusal:
            self.notify(self.card.refusal)

    def recorded_bytes(self, number: int) -> int:
        """Number of samples of a recording, one byte each; 0 if there is none."""
        return 0 if self.card is None else self.card.sound_bytes(f"r{number}")

    def _play_file(self, name: str) -> int | None:
        """Play a sound of the card; return the number of bytes read, or None if there is none."""
        found = self.card.read_sound(name) if self.card is not None else None
        if found is None:
            return None
        samples, problem = found
        if problem:
            self.notify(problem)
        self._send(PlaySamples(samples))
        return len(samples)
