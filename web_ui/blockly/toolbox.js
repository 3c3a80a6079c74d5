// The toolboxes of both looks: categories with new blocks, whose inputs have their first values as shadows.

import { ACTUATORS } from "./blocks/actuators.js";
import { EVENTS } from "./blocks/events.js";
import { BLOCKS } from "./blocks/index.js";
import { LED_BLOCKS } from "./blocks/leds.js";
import { SENSORS } from "./blocks/sensors.js";
import { CALL, DEFINITIONS, subroutineName } from "./blocks/variables.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./state.js").Socket} Socket */
/** @typedef {"blockly" | "scratch"} Look */
/** @typedef {{ name: string, style: string, types: readonly string[], custom?: boolean }} Category */

/** Callback of the button that creates a variable. */
export const NEW_VARIABLE = "new-variable";

/** @param {readonly { type: string }[]} specs */
const types = (specs) => specs.map(({ type }) => type);

const VARIABLES = {
  name: "variables",
  style: "variable_category",
  custom: true,
  types: ["variables_set", "variables_get", "thymio_declare_array", "thymio_set_array", "thymio_get_array"],
};
const SUBROUTINES = {
  name: "subroutines",
  style: "procedure_category",
  custom: true,
  types: [...DEFINITIONS.slice(1), CALL],
};

/** @param {readonly string[]} names */
const thymio = (...names) => names.map((name) => `thymio_${name}`);

/** @type {Record<Look, readonly Category[]>} */
export const CATEGORIES = {
  blockly: [
    { name: "events", style: "event_category", types: types(EVENTS) },
    { name: "actuators", style: "actuator_category", types: types(ACTUATORS) },
    { name: "leds", style: "led_category", types: types(LED_BLOCKS) },
    { name: "sensors", style: "sensor_category", types: types(SENSORS) },
    {
      name: "logic",
      style: "logic_category",
      types: ["controls_if", "thymio_when", "thymio_compare", "logic_operation", "logic_negate", "logic_boolean"],
    },
    { name: "loops", style: "loop_category", types: ["controls_repeat", "controls_whileUntil", "thymio_for"] },
    {
      name: "math",
      style: "math_category",
      types: ["math_number", "thymio_arithmetic", "thymio_unary", "thymio_binary"],
    },
    VARIABLES,
    SUBROUTINES,
  ],
  scratch: [
    {
      name: "motion",
      style: "motion_category",
      types: thymio(
        ...["setMotor", "stopMotors", "move", "moveWithSpeed", "moveWithTime", "turn", "turnWithSpeed", "turnWithTime"],
        ...["arc", "setOdomoter", "odometer"],
      ),
    },
    {
      name: "looks",
      style: "looks_category",
      types: thymio(
        ...["leds", "setLeds", "changeLeds", "clearLeds", "nextDial", "ledsCircle", "ledsProxH", "ledsProxV"],
        ...["ledsButtons", "ledsTemperature", "ledsRc", "ledsSound"],
      ),
    },
    {
      name: "sound",
      style: "sound_category",
      types: thymio("soundSystem", "soundFreq", "soundPlaySd", "soundRecord", "stopSoundRecord", "soundReplay"),
    },
    {
      name: "events",
      style: "scratch_event_category",
      types: [
        "event_whenflagclicked",
        ...thymio("whenButton", "touching", "notouching", "touchingThreshold", "bump", "soundDetected"),
        ...["event_whenbroadcastreceived", "event_broadcast", "event_broadcastandwait"],
      ],
    },
    {
      name: "control",
      style: "control_category",
      types: [
        ...["control_wait", "control_repeat", "control_forever", "controls_if", "control_wait_until"],
        ...["control_repeat_until", "control_stop"],
      ],
    },
    {
      name: "sensing",
      style: "sensing_category",
      types: thymio("valButton", "proximity", "ground", "micIntensity", "motor"),
    },
    {
      name: "operators",
      style: "operator_category",
      types: ["math_number", "thymio_arithmetic", "thymio_compare", "logic_operation", "logic_negate", "thymio_unary"],
    },
    { ...VARIABLES, types: [...VARIABLES.types, "data_changevariableby"] },
  ],
};

/** Blocks that a look offers, and names of its categories. @param {Look} look */
export const offered = (look) => CATEGORIES[look].flatMap(({ name, types: inside }) => [`category:${name}`, ...inside]);

/**
 * The toolbox of a look.
 *
 * @param {Look} look
 * @param {Translate} t
 * @param {ReadonlySet<string>} [hidden]  types of blocks, and `category:<name>`
 */
export function toolbox(look, t, hidden = new Set()) {
  const contents = CATEGORIES[look].flatMap(({ name, style, types: inside, custom = false }) => {
    const shown = inside.filter((type) => !hidden.has(type));
    if (hidden.has(`category:${name}`) || shown.length === 0) return [];
    const category = { kind: "category", toolboxitemid: name, name: t(`category.${name}`), categorystyle: style };
    return [
      custom ? { ...category, custom: name } : { ...category, contents: shown.map((type) => item(newBlock(type))) },
    ];
  });
  return { kind: "categoryToolbox", contents };
}

/**
 * The content of the category of variables and lists.
 *
 * @param {{ name: string, id: string }[]} variables  of the workspace
 * @param {Look} look
 * @param {Translate} t
 * @param {ReadonlySet<string>} [hidden]
 */
export function variableFlyout(variables, look, t, hidden = new Set()) {
  const category = CATEGORIES[look].find(({ name }) => name === VARIABLES.name);
  const shown = (category?.types ?? []).filter((type) => !hidden.has(type));
  const button = { kind: "button", text: t("variable.new"), callbackkey: NEW_VARIABLE };
  const sorted = [...variables].sort((a, b) => a.name.localeCompare(b.name));
  const blocks = shown.flatMap((type) => {
    if (type !== "variables_get") return [item(newBlock(type, sorted[0]))];
    return sorted.map((variable) => item(newBlock(type, variable)));
  });
  return [button, ...blocks];
}

/**
 * The content of the category of subroutines: a definition, and a call for each one in the workspace.
 *
 * @param {readonly string[]} names
 * @param {ReadonlySet<string>} [hidden]
 */
export function subroutineFlyout(names, hidden = new Set()) {
  const definitions = DEFINITIONS.slice(1).filter((type) => !hidden.has(type));
  const calls = hidden.has(CALL) ? [] : names;
  return [
    ...definitions.map((type) => item(newBlock(type))),
    ...calls.map((name) => item({ type: CALL, extraState: { name } })),
  ];
}

/** Names of the subroutines that a workspace defines. @param {Iterable<BlockState>} blocks */
export function subroutineNames(blocks) {
  return [...blocks].filter(({ type }) => DEFINITIONS.includes(type)).map(subroutineName);
}

/**
 * A new block, as a pupil gets it from the toolbox.
 *
 * @param {string} type
 * @param {{ name: string, id: string }} [variable]  for its fields that name a variable
 * @returns {BlockState}
 */
export function newBlock(type, variable) {
  /** @type {Record<string, any>} */ const fields = {};
  /** @type {Record<string, Socket>} */ const inputs = {};
  for (const { kind, name, initial, shadow } of BLOCKS.get(type)?.args ?? []) {
    if (kind === "variable")
      fields[name] = variable === undefined ? { name: initial } : { id: variable.id, name: variable.name };
    else if (kind !== "value" && kind !== "body" && type !== CALL) fields[name] = initial;
    if (shadow !== undefined) inputs[name] = { shadow: { type: "math_number", fields: { NUM: shadow } } };
  }
  /** @type {BlockState} */ const block = { type };
  if (Object.keys(fields).length > 0) block.fields = fields;
  if (Object.keys(inputs).length > 0) block.inputs = inputs;
  return block;
}

/** @param {BlockState} block */
const item = (block) => ({ kind: "block", ...block });
