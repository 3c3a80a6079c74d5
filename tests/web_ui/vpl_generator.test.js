import assert from "node:assert/strict";
import { test } from "node:test";

import { check } from "../../web_ui/vpl/check.js";
import { MODES } from "../../web_ui/vpl/kinds.js";
import { generate, generateSource, reportedRow, rowOfLine } from "../../web_ui/vpl/generator.js";
import { VERSIONS } from "../../web_ui/vpl/versions.js";
import { goldenPrograms, program, randomNumbers, randomProgram } from "./vpl_programs.js";

/** @typedef {import("./vpl_programs.js").Short} Short */

/**
 * The handlers of a program: its text after the reset of the outputs.
 *
 * @param {import("../../web_ui/vpl/program.js").Program} program
 */
function handlers(program) {
  const text = generate(program).source?.text ?? "";
  return text.slice(text.search(/\n\nonevent (?!sound)/) + 2).trimEnd();
}

/** @param {Short} event @param {Short} action @param {number[]} [state] */
const advancedRow = (event, action, state) => program("advanced", [event, [action], state]);
/** @type {Short} */ const STOP = ["move", 0, 0];

test("the golden programs are refused where VPL refuses them", () => {
  for (const { id, program, refused } of goldenPrograms()) {
    const { source, refusal } = generate(program);
    assert.equal(source === null, refused !== undefined, id);
    if (refused === undefined || refusal === null) continue;
    const answer = { error: refusal.kind, row: refusal.row, other_row: refusal.other ?? -1 };
    assert.deepEqual(answer, refused, id);
  }
});

test("a whole text, byte for byte", () => {
  const { source } = generate(
    program(
      "advanced",
      [["clap"], [["sound", 257, 517, 261, 516, 517, 517]], [1, 0, 2, 0]],
      [
        ["timeout"],
        [
          ["setstate", 0, 1, 2, 0],
          ["colorbottom", 1, 2, 3],
        ],
      ],
    ),
  );
  assert.equal(
    source?.text,
    `# variables for state
var state[4] = [0,0,0,0]
var new_state[4] = [0,0,0,0]

# variables for notes
var notes[6]
var durations[6]
var note_index = 6
var note_count = 6
var wave[142]
var i
var wave_phase
var wave_intensity

# compute a sinus wave for sound
for i in 0:141 do
	wave_phase = (i-70)*468
	call math.cos(wave_intensity, wave_phase)
	wave[i] = wave_intensity/256
end
call sound.wave(wave)
# stop timer 0
timer.period[0] = 0
# setup threshold for detecting claps
mic.threshold = 250
# reset outputs
call sound.system(-1)
call leds.top(0,0,0)
call leds.bottom.left(0,0,0)
call leds.bottom.right(0,0,0)
call leds.circle(0,0,0,0,0,0,0,0)

# subroutine to display the current state
sub display_state
	call leds.circle(0,state[1]*32,0,state[3]*32,0,state[2]*32,0,state[0]*32)

# when a note is finished, play the next note
onevent sound.finished
	if note_index != note_count then
		call sound.freq(notes[note_index], durations[note_index])
		note_index += 1
	end

onevent mic
	if state[0] == 1 and state[2] == 0 then
		call math.copy(notes[0:2], [311, 0, 524])
		call math.copy(durations[0:2], [7, 21, 14])
		note_index = 1
		note_count = 3
		call sound.freq(notes[0], durations[0])
		emit pair_run 0
	end


onevent timer0
	timer.period[0] = 0
	new_state[1] = 1
	new_state[2] = 0
	call leds.bottom.left(1,2,3)
	call leds.bottom.right(1,2,3)
	emit pair_run 1

	call math.copy(state, new_state)
	callsub display_state

`,
  );
});

test("an empty program has no text", () => {
  assert.deepEqual(generate(program("basic")).source, { text: "", rows: [null] });
  assert.deepEqual(generate(program("advanced")).source, { text: "", rows: [null] });
});

/** @type {[string, Short, string][]} */
const EVENTS = [
  ["buttons", ["button", 1, 0, 0, 0, 1], "when button.forward == 1 and button.center == 1 do"],
  [
    "distances",
    ["prox", 3, 0, 0, 0, 0, 1, 2, 900, 3000],
    "when prox.horizontal[0] >= 900 and prox.horizontal[0] <= 3000 and prox.horizontal[5] >= 3000" +
      " and prox.horizontal[6] <= 900 do",
  ],
  ["the ground", ["proxground", 2, 1, 400, 450], "when prox.ground.delta[0] <= 400 and prox.ground.delta[1] >= 450 do"],
  ["an upper bound", ["acc", 2, -6], "when angle < -15019 do"],
  ["a lower bound", ["acc", 1, -6], "when angle >= 15019 do"],
  ["both bounds", ["acc", 1, 1], "when angle >= -4095 and angle < -1365 do"],
  ["no tilt", ["acc", 2, 0], "when angle >= -1365 and angle < 1365 do"],
  [
    "an arrow of the remote control",
    ["button", 0, 0, 0, 0, 0, 1, 1],
    "if rc5.command == 85 or rc5.command == 17 or rc5.command == 77 then",
  ],
  [
    "the center of the remote control",
    ["button", 0, 0, 0, 0, 0, 1, 4],
    "if rc5.command == 87 or rc5.command == 13 then",
  ],
  ["the last key of the keypad", ["button", 0, 0, 0, 0, 0, 2, 11], "if rc5.command == 16 then"],
];
for (const [what, event, test_] of EVENTS) {
  test(`the condition of ${what}`, () => {
    const lines = handlers(advancedRow(event, STOP)).split("\n");
    assert.ok(lines.includes(`\t${test_}`), lines.join("\n"));
    assert.equal(lines.at(-1), "\tend");
  });
}

/** @type {[string, Short, string[]][]} */
const ACTIONS = [
  ["motors", ["move", -500, 50], ["motor.left.target = -500", "motor.right.target = 50"]],
  ["the top", ["colortop", 0, 16, 32], ["call leds.top(0,16,32)"]],
  ["the bottom", ["colorbottom", 1, 2, 3], ["call leds.bottom.left(1,2,3)", "call leds.bottom.right(1,2,3)"]],
  ["silence", ["sound", 517, 261, 517, 517, 517, 517], ["# zero notes in sound block"]],
  ["the timer", ["timer", 439], ["timer.period[0] = 439"]],
  ["states", ["setstate", 1, 0, 0, 2], ["new_state[0] = 1", "new_state[3] = 0"]],
  ["no state", ["setstate", 0, 0, 0, 0], []],
];
for (const [what, action, statements] of ACTIONS) {
  test(`the statements of ${what}`, () => {
    const lines = handlers(advancedRow(["clap"], action)).split("\n");
    const expected = ["onevent mic", ...statements.map((each) => `\t${each}`), "\temit pair_run 0"];
    assert.deepEqual(lines.slice(0, expected.length), expected);
  });
}

test("only silence needs no wave", () => {
  const { source } = generate(program("basic", [["clap"], [["sound", 517, 517, 517, 517, 517, 517]]]));
  assert.doesNotMatch(source?.text ?? "", /wave/);
});

test("the state is tested inside the event, so that the edge is used up", () => {
  assert.equal(
    handlers(advancedRow(["button", 1], STOP, [0, 2, 0, 0])),
    "onevent buttons\n\twhen button.forward == 1 do\n\t\tif state[1] == 0 then\n\t\t\tmotor.left.target = 0\n" +
      "\t\t\tmotor.right.target = 0\n\t\t\temit pair_run 0\n\t\tend\n\tend",
  );
});

test("a row of the remote control has the blank of the original", () => {
  const text = handlers(advancedRow(["button", 0, 0, 0, 0, 0, 2, 0], STOP));
  assert.equal(text.split("\n")[2], " \t\tmotor.left.target = 0");
});

test("a row without condition comes before those with one, unless it uses advanced mode", () => {
  /** @param {Short} action */
  const order = (action) => {
    const { source } = generate(
      program("advanced", [["prox", 1], [STOP]], [["prox", 0], [action]], [["proxground", 1], [STOP]]),
    );
    return [...(source?.text ?? "").matchAll(/pair_run (\d)/g)].map(([, row]) => Number(row));
  };
  assert.deepEqual(order(STOP), [1, 0, 2]);
  assert.deepEqual(order(["timer", 250]), [0, 1, 2]);
});

test("rows keep their number when rows above them are empty", () => {
  const { source } = generate(program("basic", [null, []], [["clap"], [STOP]]));
  assert.match(source?.text ?? "", /emit pair_run 1\n/);
});

test("each row knows its lines, and each line its row", () => {
  const { source } = generate(
    program("advanced", [["prox", 1], [STOP]], [["acc", 1, 2], [STOP]], [["prox", 2], [STOP]]),
  );
  assert.ok(source);
  const lines = source.text.split("\n");
  source.rows.forEach((span, row) => {
    if (row === 3) return assert.equal(span, null);
    assert.ok(span);
    const own = lines.slice(span.first - 1, span.last).join("\n");
    assert.match(own, new RegExp(`^\\t(when|call math.atan2)[^]*pair_run ${row}\\n\\tend$`));
    for (let line = span.first; line <= span.last; line++) assert.equal(rowOfLine(source, line), row);
  });
  assert.equal(rowOfLine(source, 1), null);
});

test("further conditions of extended mode are tested inside the event, as the state is", () => {
  const made = program("extended", [
    ["acc", 2, 3],
    [STOP],
    [1, 0, 0, 0],
    [
      ["acc", 1, 0],
      ["posture", 2],
      ["counter", 5, 7],
    ],
  ]);
  assert.match(generate(made).source?.text ?? "", /\nvar angle\n# .*\nvar counter = 0\n/);
  assert.deepEqual(handlers(made).split("\n").slice(1, 7), [
    "\tcall math.atan2(angle, acc[1], acc[2])",
    "\twhen angle >= 6827 and angle < 9557 do",
    "\t\tif state[0] == 1 then",
    "\t\t\tcall math.atan2(angle, acc[0], acc[2])",
    "\t\t\tif angle >= -1365 and angle < 1365 then",
    "\t\t\t\tif -acc[2] / 2 > abs(acc[0]) + abs(acc[1]) then",
  ]);
});

test("rows of the start run after the outputs are reset, and set the state there", () => {
  const made = program(
    "extended",
    [
      ["init"],
      [
        ["setstate", 1],
        ["play", 3],
      ],
    ],
    [["clap"], [["setcounter", 3, 2]]],
  );
  const text = generate(made).source?.text ?? "";
  const start = ["new_state[0] = 1", "call sound.play(3)", "emit pair_run 0", "", "call math.copy(state, new_state)"];
  assert.ok(text.includes(`call leds.circle(0,0,0,0,0,0,0,0)\n${start.join("\n")}\ncall leds.circle(0,state[1]*32,`));
  assert.match(text, /\tcounter = counter - 2\n\tif counter < 0 then\n\t\tcounter = 0\n\tend\n\temit pair_run 1\n/);
});

test("the events of rows name them", () => {
  assert.equal(reportedRow("pair_run", [3]), 3);
  assert.equal(reportedRow("PairExecuted", [0]), 0);
  assert.equal(reportedRow("ping", [3]), null);
});

test("any program has a text or a refusal, in every version", () => {
  const random = randomNumbers(7);
  for (let count = 0; count < 300; count++) {
    const made = randomProgram(random, MODES[count % 3]);
    const { source, refusal } = generate(made);
    assert.equal(source === null, refusal !== null);
    assert.deepEqual(refusal, check(made));
    if (source === null) continue;
    for (const { generator } of VERSIONS) {
      const { text, rows } = generateSource(made, generator);
      assert.doesNotMatch(text, /undefined|NaN|null/);
      assert.equal(rows.length, made.rows.length);
    }
  }
});
