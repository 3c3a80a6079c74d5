// What several blocks of a script share: Aseba text that is added to a program that uses it.
//
// Lengths are mm, speeds mm/s; 3.2 of the robot's units are 1 mm/s. A wheel travels 0.785 mm per degree of a turn on
// the spot, that is, the wheels are 90 mm apart.

/**
 * @typedef {object} Part
 * @property {Record<string, number>} variables  size by name, 0 for a single number
 * @property {readonly string[]} [everyStep]       statements in each step
 * @property {readonly string[]} subroutine
 */

/** Half the distance of the wheels, in mm. */
export const HALF_TRACK = 45;
/** Colors on the wheel of `setLeds`: 33 between two of red, yellow, green, cyan, blue and magenta. */
export const COLORS = 198;
/** The color lights, in the order of the bits of color.lights. */
export const COLOR_LIGHTS = ["leds.top", "leds.bottom.left", "leds.bottom.right"];

/** @type {Record<string, Part>} */
export const LIBRARY = {
  // Starts a move. Before: travel of both wheels, and either move.speed, the speed of the faster wheel, or, at speed 0,
  // move.steps, its time. After: the targets of the motors, move.steps.
  "move.start": {
    variables: { "move.left": 0, "move.right": 0, "move.speed": 0, "move.steps": 0, "move.longest": 0 },
    subroutine: [
      "sub move.start",
      "\tcall math.max(move.longest, abs move.left, abs move.right)",
      "\tif move.longest == 0 then",
      "\t\tmove.steps = 0",
      "\telse",
      "\t\tif move.speed == 0 then",
      "\t\t\tcall math.max(move.steps, move.steps, 1)",
      "\t\t\tcall math.muldiv(move.speed, move.longest, 100, move.steps)",
      "\t\telse",
      "\t\t\tcall math.muldiv(move.steps, move.longest, 100, move.speed)",
      "\t\tend",
      "\t\tcall math.clamp(move.speed, move.speed, 1, 156)",
      "\t\tcall math.muldiv(motor.left.target, move.left, move.speed * 16 / 5, move.longest)",
      "\t\tcall math.muldiv(motor.right.target, move.right, move.speed * 16 / 5, move.longest)",
      "\tend",
    ],
  },
  // Direction in degrees, clockwise, 0 along y; odo.heading is the same as an angle of math.sin. A step of 10 ms moves
  // the robot by the sum of both targets / 640 mm, and turns it by their difference * 0.3622.
  odometer: {
    variables: {
      "odo.x": 0,
      "odo.y": 0,
      "odo.direction": 0,
      "odo.heading": 0,
      "odo.rest": 3,
      "odo.step": 2,
      "odo.moved": 2,
    },
    everyStep: ["callsub odo.update"],
    subroutine: [
      "sub odo.update",
      "\todo.rest[0] = odo.rest[0] + motor.left.target - motor.right.target",
      "\tcall math.muldiv(odo.step[0], odo.rest[0], 3622, 10000)",
      "\todo.heading = odo.heading + odo.step[0]",
      "\tcall math.muldiv(odo.step[1], odo.step[0], 10000, 3622)",
      "\todo.rest[0] = odo.rest[0] - odo.step[1]",
      "\tcall math.muldiv(odo.direction, odo.heading, 180, 32767)",
      "\tcall math.sin(odo.step[0], odo.heading)",
      "\tcall math.cos(odo.step[1], odo.heading)",
      "\tcall math.fill(odo.moved, motor.left.target + motor.right.target)",
      "\tcall math.muldiv(odo.step, odo.moved, odo.step, [32767, 32767])",
      "\todo.rest[1] = odo.rest[1] + odo.step[0]",
      "\todo.rest[2] = odo.rest[2] + odo.step[1]",
      "\todo.x = odo.x + odo.rest[1] / 640",
      "\todo.y = odo.y + odo.rest[2] / 640",
      "\todo.rest[1] = odo.rest[1] % 640",
      "\todo.rest[2] = odo.rest[2] % 640",
    ],
  },
  // Shows color.number, for each color light a place on the wheel, on the lights of the bits of color.lights: 1 top,
  // 2 bottom left, 4 bottom right.
  "color.show": {
    variables: { "color.number": 3, "color.lights": 0, "color.light": 0, "color.part": 0, "color.rgb": 3 },
    subroutine: [
      "sub color.show",
      "\tcolor.light = 0",
      "\twhile color.lights != 0 do",
      `\t\tcolor.number[color.light] = (color.number[color.light] % ${COLORS} + ${COLORS}) % ${COLORS}`,
      "\t\tcolor.part = 0",
      "\t\twhile color.part < 3 do",
      "\t\t\tcolor.rgb[color.part] = abs((color.number[color.light] + 198 - color.part * 66) % 198 - 99) - 33",
      "\t\t\tcolor.part = color.part + 1",
      "\t\tend",
      "\t\tcall math.clamp(color.rgb, color.rgb, [0, 0, 0], [32, 32, 32])",
      "\t\tif color.lights & 1 != 0 then",
      ...COLOR_LIGHTS.flatMap((native, index) => [
        `\t\t\t${index === 0 ? "if" : "elseif"} color.light == ${index} then`,
        `\t\t\t\tcall ${native}(color.rgb[0],color.rgb[1],color.rgb[2])`,
      ]),
      "\t\t\tend",
      "\t\tend",
      "\t\tcolor.lights = color.lights >> 1",
      "\t\tcolor.light = color.light + 1",
      "\tend",
    ],
  },
  // Shows one light of the circle, number dial.
  "dial.show": {
    variables: { "dial.number": 0, "dial.leds": 8 },
    subroutine: [
      "sub dial.show",
      "\tdial.number = dial.number & 7",
      "\tcall math.fill(dial.leds, 0)",
      "\tdial.leds[dial.number] = 32",
      `\tcall leds.circle(${Array.from({ length: 8 }, (_, index) => `dial.leds[${index}]`).join(",")})`,
    ],
  },
};

/** Names that the library uses. */
export const LIBRARY_NAMES = Object.entries(LIBRARY).flatMap(([name, { variables }]) => [
  name,
  ...Object.keys(variables),
]);
