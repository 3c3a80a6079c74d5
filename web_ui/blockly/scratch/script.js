// Scripts in the manner of Scratch: statements one after the other, some of which take time, several scripts at once.
//
// Aseba has no threads. Each script becomes a state machine: its statements are cut into states where it may wait, and
// a timer calls all machines every 10 ms. The states stand in order as `if at == 1 … end if at == 2 … end`. A jump
// forward therefore acts at once, a jump backward with the next call: as in Scratch, a loop does one round per step.

import { BLOCKS, bodies } from "../blocks/index.js";
import { indented, plain } from "../lines.js";
import { MULTIPLY } from "../precedence.js";
import { following, isDisabled, plugged } from "../state.js";
import { LIBRARY } from "./library.js";

/** @typedef {import("../state.js").BlockState} BlockState */
/** @typedef {import("../blocks/spec.js").Line} Line */
/** @typedef {{ state: State | null }} Label  the place where a script goes on; no state until it is placed */
/**
 * @typedef {object} Exit
 * @property {BlockState} block
 * @property {Label | null} [target]     where the script goes on; null: it ends
 * @property {string} [condition]        only if this is true, else in the next state
 * @property {(next: string) => string[]} [stay]  the statements of a state that goes on with `next` at some time
 */
/** @typedef {{ lines: Line[], exit: Exit | null, reached: boolean }} State  without an exit the next state follows */

/** Calls of a script per second. */
export const STEPS_PER_SECOND = 100;
const TIMER = { event: "timer0", period: "timer.period[0]", ms: 1000 / STEPS_PER_SECOND };

export class Script {
  /**
   * @param {ScriptRunner} runner
   * @param {BlockState} top  its hat, or its first statement
   * @param {string} at  the variable with the number of its state, 0 if it does not run
   */
  constructor(runner, top, at) {
    this.runner = runner;
    this.g = runner.g;
    this.top = top;
    this.at = at;
    /** @type {State[]} */ this.states = [];
    /** The variable with the steps that it still waits, once it has one. @type {string | null} */ this.left = null;
    this.current = this.#open(true);
  }

  /** Whether a statement takes time, or one that follows or is inside. @param {BlockState | undefined} first */
  static takesTime(first) {
    for (let block = first; block !== undefined; block = following(block)) {
      const spec = BLOCKS.get(block.type);
      if (isDisabled(block) || spec === undefined) continue;
      if (spec.step !== undefined && spec.statement === undefined) return true;
      const inner = bodies(spec);
      const inside = Object.keys(block.inputs ?? {}).filter((name) => inner.includes(name) || /^DO\d*$/.test(name));
      if (inside.some((name) => Script.takesTime(plugged(/** @type {BlockState} */ (block), name)))) return true;
    }
    return false;
  }

  /** @returns {Label} */
  label() {
    return { state: null };
  }

  /** The next statement is where a label leads. @param {Label} label */
  place(label) {
    if (this.current.lines.length > 0) this.current = this.#open(true);
    this.current.reached = true;
    label.state = this.current;
  }

  /** A line of the current state. @param {BlockState} block @param {string} text */
  line(block, text) {
    this.current.lines.push(this.g.line(block, text));
  }

  /** Go on at a label. @param {BlockState} block @param {Label} target */
  jump(block, target) {
    this.current.exit = { block, target };
    this.current = this.#open(false);
  }

  /**
   * Go on at a label if a condition is true, else here.
   *
   * @param {BlockState} block
   * @param {string} condition
   * @param {Label} target
   */
  jumpIf(block, condition, target) {
    this.current.exit = { block, target, condition };
    this.current = this.#open(true);
  }

  /** End the script. @param {BlockState} block */
  stop(block) {
    this.current.exit = { block, target: null };
    this.current = this.#open(false);
  }

  /** Statements one after the other. @param {BlockState | undefined} first */
  chain(first) {
    for (let block = first; block !== undefined; block = following(block)) {
      const spec = this.g.spec(block);
      const alone = { ...block, next: undefined };
      if (!isDisabled(block) && spec?.step !== undefined && (spec.waits || Script.takesTime(alone))) {
        this.current.lines.push(...this.g.comments(block));
        spec.step(this, block);
      } else this.current.lines.push(...this.g.one(block));
    }
  }

  /** The statements in an input. @param {BlockState} block @param {string} input */
  statements(block, input) {
    this.chain(plugged(block, input));
  }

  /**
   * Repeat until a condition is true, one round per step.
   *
   * @param {BlockState} block
   * @param {string | null} until
   * @param {() => void} inner
   */
  loop(block, until, inner) {
    const [top, end] = [this.label(), this.label()];
    this.place(top);
    if (until !== null) this.jumpIf(block, until, end);
    inner();
    this.jump(block, top);
    this.place(end);
  }

  /**
   * Repeat a number of times, one round per step.
   *
   * @param {BlockState} block
   * @param {string} times
   * @param {() => void} inner
   */
  repeat(block, times, inner) {
    const left = this.g.fresh("rounds");
    this.line(block, `${left} = ${times}`);
    this.loop(block, `${left} <= 0`, () => {
      this.line(block, `${left} -= 1`);
      inner();
    });
  }

  /** Wait until a condition is true. @param {BlockState} block @param {string} until */
  waitUntil(block, until) {
    this.#stay(block, (next) => [`if ${until} then`, `\t${next}`, "end"]);
  }

  /** Seconds in an input as a number of steps. @param {BlockState} block @param {string} input */
  steps(block, input) {
    const seconds = this.g.constant(block, input);
    if (seconds !== null) return String(Math.round(seconds * STEPS_PER_SECOND));
    return `${this.g.number(block, input, MULTIPLY)} * ${STEPS_PER_SECOND}`;
  }

  /** Wait for a number of steps. @param {BlockState} block @param {string} steps */
  wait(block, steps) {
    this.left ??= this.g.fresh("wait");
    const left = this.left;
    this.line(block, `${left} = ${steps}`);
    this.#stay(block, (next) => [`if ${left} > 0 then`, `\t${left} -= 1`, "else", `\t${next}`, "end"]);
  }

  /** The machine as a subroutine. @param {string} name @returns {Line[]} */
  lines(name) {
    const states = this.states.filter(({ reached }) => reached);
    const last = states[states.length - 1];
    if (last.lines.length === 0 && last.exit === null) states.pop(); // the end of the script
    /** @param {number} index */
    const numberOf = (index) => (index >= 0 && index < states.length ? index + 1 : 0);
    const parts = states.map(({ lines, exit }, index) => {
      const target = exit?.target?.state ?? null;
      const to = `${this.at} = ${target === null ? 0 : numberOf(states.indexOf(target))}`;
      const next = `${this.at} = ${numberOf(index + 1)}`;
      /** @param {string} text */
      const line = (text) => (exit === null ? plain(text) : this.g.line(exit.block, text));
      const texts = exit === null ? [next] : textsOf(exit, to, next);
      return [plain(`if ${this.at} == ${index + 1} then`), ...indented([...lines, ...texts.map(line)]), plain("end")];
    });
    return [this.g.line(this.top, `sub ${name}`), ...indented(parts.flat())];
  }

  /** A state that is left later. @param {BlockState} block @param {NonNullable<Exit["stay"]>} stay */
  #stay(block, stay) {
    this.place(this.label());
    this.current.exit = { block, stay };
    this.current = this.#open(true);
  }

  /** A new state after the others. @param {boolean} reached  whether the state before leads to it @returns {State} */
  #open(reached) {
    const state = { lines: [], exit: null, reached };
    this.states.push(state);
    return state;
  }
}

/** The statements at the end of a state. @param {Exit} exit @param {string} to @param {string} next */
function textsOf({ condition, stay }, to, next) {
  if (stay !== undefined) return stay(next);
  return condition === undefined ? [to] : [`if ${condition} then`, `\t${to}`, "else", `\t${next}`, "end"];
}

/** All scripts of a program, the timer that runs them, and the subroutines that they share. */
export class ScriptRunner {
  /** @param {import("../generator.js").Generator} g */
  constructor(g) {
    this.g = g;
    /** @type {Script[]} */ this.scripts = [];
    /** Hats of scripts that take no time: their statements need no machine. @type {BlockState[]} */ this.direct = [];
    /** Names of parts of the library. @type {Set<string>} */ this.used = new Set();
    /** Statements at the start of the program. @type {Line[]} */ this.starts = [];
  }

  /** A stack of a script: below a hat, or without one, to run at the start. @param {BlockState} top */
  add(top) {
    const needsMachine = top.type === "event_whenbroadcastreceived" || Script.takesTime(top);
    if (needsMachine) this.scripts.push(new Script(this, top, this.g.fresh("script")));
    else this.direct.push(top);
  }

  /** Make a part of the library available. @param {string} name */
  use(name) {
    this.used.add(name);
  }

  /** The variables of the scripts that a message starts. @param {string} message */
  startedBy(message) {
    const receivers = this.scripts.filter(({ top }) => top.type === "event_whenbroadcastreceived");
    return receivers.filter(({ top }) => this.g.field(top, "MESSAGE") === message).map(({ at }) => at);
  }

  /** Generate all scripts. */
  finish() {
    const { g } = this;
    for (const script of this.scripts) {
      script.chain(g.spec(script.top)?.trigger === undefined ? script.top : following(script.top));
      this.#trigger(script.top, this.#start(script));
    }
    for (const top of this.direct) this.#trigger(top, g.chain(following(top)));
    const names = this.scripts.map((script) => {
      const name = g.names.fresh(`${script.at}.step`);
      g.subroutines.add(script.lines(name));
      return name;
    });
    const everyStep = this.#addLibrary();
    if (names.length + everyStep.length > 0) {
      if (g.handlers.has(TIMER.event)) g.report("error", "timerInUse", this.scripts[0]?.top ?? this.direct[0]);
      g.start.unshift([plain(`${TIMER.period} = ${TIMER.ms}`)]);
      g.handle(TIMER.event, [...everyStep, ...names.map((name) => plain(`callsub ${name}`))]);
    }
    if (this.starts.length > 0) g.start.push(this.starts);
  }

  /** Add what is used of the library; returns the statements of each step. */
  #addLibrary() {
    const parts = [...this.used].map((name) => LIBRARY[name]);
    for (const { variables, subroutine } of parts) {
      for (const [name, size] of Object.entries(variables)) this.g.declared.set(name, size);
      this.g.subroutines.add(subroutine.map(plain));
    }
    return parts.flatMap(({ everyStep = [] }) => everyStep.map(plain));
  }

  /** Run lines when a hat says so. @param {BlockState} top @param {Line[]} lines */
  #trigger(top, lines) {
    const trigger = this.g.spec(top)?.trigger;
    if (trigger === undefined) this.starts.push(...lines);
    else trigger(this, top, lines);
  }

  /** The statements that start a script: a sensor does not start one again that still runs. @param {Script} script */
  #start({ top, at }) {
    const isSensor = this.g.spec(top)?.trigger !== undefined && !top.type.startsWith("event_");
    const texts = isSensor ? [`if ${at} == 0 then`, `\t${at} = 1`, "end"] : [`${at} = 1`];
    return texts.map((text) => this.g.line(top, text));
  }
}
