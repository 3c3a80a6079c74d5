"""One line of help for each variable, native and local event of the Thymio, in one table per language.

Other languages are `help_<language>.py`; what they lack is given in English (facts: docs/spec/thymio-robot.md sections
4 to 6).
"""

from __future__ import annotations

from collections.abc import Mapping

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.editor.help_de import GERMAN
from thymio_sim_ros.device.editor.help_fr import FRENCH
from thymio_sim_ros.device.editor.help_it import ITALIAN
from thymio_sim_ros.device.editor.help_table import HelpTable

__all__ = ["ENGLISH", "TABLES", "HelpTable", "help_of"]

_VARIABLES = {
    "_id": "number of the robot on its network",
    "event.source": "number of the robot that sent the event being handled",
    "event.args": "values of the event being handled",
    "_fwversion": "version of the robot's firmware",
    "_productId": "kind of robot: 8 is a Thymio II",
    "buttons._raw": "raw readings of the five buttons: backward, left, center, forward, right",
    "button.backward": "1 while the backward button is pressed, else 0",
    "button.left": "1 while the left button is pressed, else 0",
    "button.center": "1 while the center button is pressed, else 0",
    "button.forward": "1 while the forward button is pressed, else 0",
    "button.right": "1 while the right button is pressed, else 0",
    "buttons._mean": "mean of the raw readings of the buttons",
    "buttons._noise": "noise of the raw readings of the buttons",
    "prox.horizontal": "distance: five in front from left to right, two behind; 0 is nothing, about 4500 very near",
    "prox.comm.rx._payloads": "values received by infrared, one for each distance sensor",
    "prox.comm.rx._intensities": "strength of what was received, one for each distance sensor",
    "prox.comm.rx": "value received by infrared last",
    "prox.comm.tx": "value to send by infrared, -1024 to 1023",
    "prox.ground.ambiant": "ground sensors, left and right: light around",
    "prox.ground.reflected": "ground sensors, left and right: light while the sensor's own is on",
    "prox.ground.delta": "ground sensors, left and right: how much the ground reflects; black is low, white is high",
    "motor.left.target": "wanted speed of the left wheel, -500 to 500",
    "motor.right.target": "wanted speed of the right wheel, -500 to 500",
    "_vbat": "two readings of the battery; their sum tells the voltage",
    "_imot": "current of the motors",
    "motor.left.speed": "measured speed of the left wheel",
    "motor.right.speed": "measured speed of the right wheel",
    "motor.left.pwm": "drive of the left motor",
    "motor.right.pwm": "drive of the right motor",
    "_integrator": "memory of the motors' control loop",
    "acc": "accelerometer: positive with the left side down, with the rear down, upright; 23 is the earth's attraction",
    "leds.top": "color on top: red, green, blue, 0 to 32",
    "leds.bottom.left": "color below on the left: red, green, blue, 0 to 32",
    "leds.bottom.right": "color below on the right: red, green, blue, 0 to 32",
    "leds.circle": "ring of eight lights around the buttons, clockwise from the front, 0 to 32",
    "temperature": "temperature in tenths of a degree Celsius",
    "rc5.address": "address of the remote control heard last",
    "rc5.command": "key of the remote control heard last",
    "mic.intensity": "how loud it is, 0 to 255",
    "mic.threshold": "the event mic comes above this loudness; 0 is never",
    "mic._mean": "mean of the microphone",
    "timer.period": "periods of the timers 0 and 1 in milliseconds; 0 stops the timer",
    "acc._tap": "how the last tap was felt",
    "sd.present": "1 while a memory card is in the robot, else 0",
}

_NATIVES = {
    "_system.reboot": "restart the robot",
    "_system.settings.read": "read a setting of the robot into value",
    "_system.settings.write": "change a setting of the robot until it is switched off",
    "_system.settings.flash": "keep the settings when the robot is switched off",
    "math.copy": "copy src to dest",
    "math.fill": "set every element of dest to value",
    "math.addscalar": "add scalar to every element of src",
    "math.add": "add src1 and src2, element by element",
    "math.sub": "subtract src2 from src1, element by element",
    "math.mul": "multiply src1 by src2, element by element",
    "math.div": "divide src1 by src2, element by element; division by zero is an error",
    "math.min": "the smaller of src1 and src2, element by element",
    "math.max": "the larger of src1 and src2, element by element",
    "math.clamp": "src limited to low and high, element by element",
    "math.dot": "scalar product of src1 and src2, divided by 2 to the power of shift",
    "math.stat": "smallest, largest and mean value of src",
    "math.argbounds": "indexes of the smallest and the largest value of src",
    "math.sort": "sort the array, smallest first",
    "math.muldiv": "a times b divided by c in 32 bits, element by element",
    "math.atan2": "angle of the direction (x, y); 32767 is half a turn",
    "math.sin": "sine of x times 32767; 32767 is half a turn",
    "math.cos": "cosine of x times 32767; 32767 is half a turn",
    "math.rot2": "turn the vector v by the angle a; 32767 is half a turn",
    "math.sqrt": "square root; that of a negative number is an error",
    "math.rand": "random numbers, -32768 to 32767",
    "deque.size": "number of elements of the deque",
    "deque.get": "read elements from index on into dest",
    "deque.set": "overwrite elements from index on by src",
    "deque.insert": "insert src before index",
    "deque.erase": "remove len elements from index on",
    "deque.push_front": "add src in front",
    "deque.push_back": "add src at the end",
    "deque.pop_front": "take elements from the front into dest",
    "deque.pop_back": "take elements from the end into dest",
    "_leds.set": "set one light by its number, 0 to 32",
    "sound.record": "record a sound as number N on the card; -1 stops",
    "sound.play": "play sound number N of the card; -1 stops",
    "sound.replay": "play the recorded sound number N; -1 stops",
    "sound.system": "play a sound of the robot, 0 to 7; -1 stops",
    "leds.circle": "ring of eight lights around the buttons, clockwise from the front, 0 to 32",
    "leds.top": "color on top, 0 to 32",
    "leds.bottom.left": "color below on the left, 0 to 32",
    "leds.bottom.right": "color below on the right, 0 to 32",
    "sound.freq": "play a tone of so many hertz for so many sixtieths of a second; 0 plays on, -1 stops",
    "leds.buttons": "lights of the buttons: forward, right, backward, left, 0 to 32",
    "leds.prox.h": "lights of the distance sensors: six in front, two behind, 0 to 32",
    "leds.prox.v": "lights of the ground sensors, left and right, 0 to 32",
    "leds.rc": "light of the remote control, 0 to 32",
    "leds.sound": "light of the microphone, 0 to 32",
    "leds.temperature": "lights of the thermometer, red and blue, 0 to 32",
    "sound.wave": "form of the tones of sound.freq, 142 values of -128 to 127",
    "prox.comm.enable": "1 switches infrared communication on, 0 off",
    "sd.open": "open file number of the card; -1 closes it; status is 0, or -1 if it failed",
    "sd.write": "write data to the open file; how many values were written",
    "sd.read": "read from the open file into data; how many values were read",
    "sd.seek": "go to a position of the open file; status is 0, or -1 if it failed",
    "_rf.nodeid": "change the robot's number on its network",
    "_rf.setup": "change channel and network of the robot's radio",
    "sound.duration": "length of recorded sound number N in tenths of a second",
    "_poweroff": "switch the robot off",
}

ENGLISH = HelpTable(_VARIABLES, _NATIVES, {event.name: event.description for event in THYMIO_II.local_events})

TABLES: Mapping[str, HelpTable] = {"en": ENGLISH, "de": GERMAN, "fr": FRENCH, "it": ITALIAN}
"""Language → its table."""


def help_of(kind: str, name: str, language: str = "en", *, other: str = "") -> str:
    """Help for a name of one `kind` (variables, natives, events); `other` where no table knows it, as for plug-ins."""
    for table in (TABLES.get(language, ENGLISH), ENGLISH):
        known: Mapping[str, str] = getattr(table, kind)
        if name in known:
            return known[name]
    return other
