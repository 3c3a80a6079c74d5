// The program's events: send, add, remove, plot; and the log of received events.

import { download } from "../../browser/download.js";
import { h, lock, renew, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { LARGEST_EVENT } from "../aesl.js";
import { eventKey } from "../editor_session.js";
import { csv, parseNumbers } from "../numbers.js";
import { entryForm } from "./entry_form.js";
import { pinButton, showPin } from "./pin.js";

/** @typedef {import("./index.js").ToolContext} ToolContext */
/** @typedef {import("./index.js").View} View */
/** @typedef {readonly import("../state.js").LoggedEvent[]} Log */

const SHOWN_EVENTS = 100;

/** @param {bigint} timeNs */
const seconds = (timeNs) => (Number(timeNs / 1_000_000n) / 1000).toFixed(3);

/** @param {ToolContext} context @returns {import("./index.js").Tool} */
export function eventsTool(context) {
  const { t, define } = context;
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  /** @param {string} problem  empty: there is none */
  const report = (problem) => {
    errorText.hidden = problem === "";
    if (problem !== "") setText(errorText, problem);
  };
  const table = eventTable(context, report);
  const log = eventLog(context);
  const form = entryForm({
    t,
    kind: "event",
    least: 0,
    greatest: LARGEST_EVENT,
    label: t("events.size"),
    add: (name, size) => define("event", name, size),
  });
  return {
    name: "events",
    element: h("div", { class: "events" }, table.element, errorText, form, ...log.elements),
    render(view) {
      table.render(view);
      log.render(view);
    },
  };
}

/** The events of the file, a row each. @param {ToolContext} context @param {(problem: string) => void} report */
function eventTable(context, report) {
  const { session } = context;
  const body = h("tbody");
  let listed = "";
  /** @type {Map<string, HTMLElement>} fields with typed values */ let rows = new Map();
  return {
    element: h("table", {}, body),
    /** @param {View} view */
    render({ file, disabledReason }) {
      const events = file.events.map(({ name, value }) => ({ name, size: value }));
      const signature = JSON.stringify(events);
      if (signature !== listed) {
        listed = signature;
        const kept = rows;
        rows = new Map(
          events.map(({ name, size }) => {
            const key = `${name} ${size}`;
            return [key, kept.get(key) ?? eventRow(context, report, name, size)];
          }),
        );
        renew(body, [...rows.values()]);
      }
      for (const button of body.querySelectorAll("[data-send]")) {
        lock(/** @type {HTMLButtonElement} */ (button), disabledReason);
      }
      for (const pin of body.querySelectorAll("[data-watch]")) {
        showPin(pin, session.watched.has(eventKey(pin.getAttribute("data-watch") ?? "")));
      }
    },
  };
}

/** @param {ToolContext} context @param {(problem: string) => void} report @param {string} name @param {number} size */
function eventRow({ t, session, emit, define, announce, redraw }, report, name, size) {
  const input = h("input", {
    type: "text",
    value: Array(size).fill(0).join(" "),
    hidden: size === 0,
    "aria-label": t("events.values", { name, size }),
  });
  const send = () => {
    const { values, problem } = parseNumbers(input.value, size);
    report(values === null ? `${name}: ${t(problem.key, problem.values)}` : "");
    if (values === null) return;
    emit(name, values);
    announce(t("events.sent", { name }));
  };
  input.addEventListener("keydown", ({ key }) => key === "Enter" && send());
  const plot = pinButton(t("variables.watch", { name }), () => {
    session.toggleWatch(eventKey(name));
    redraw();
  });
  plot.dataset.watch = name;
  const button = { type: "button", class: "btn line note slim", "data-send": name, onclick: send };
  const label = t("remove", { name });
  const remove = () => define("event", name, null);
  return h(
    "tr",
    {},
    h("td", { class: "mark" }, plot),
    h("th", { scope: "row" }, `${name} [${size}]`),
    h("td", { class: "send" }, input, h("button", button, t("events.send"))),
    h(
      "td",
      { class: "mark" },
      h(
        "button",
        { type: "button", class: "btn icon", "aria-label": label, title: label, onclick: remove },
        icon("close", { small: true }),
      ),
    ),
  );
}

/** The received events, the newest first. @param {ToolContext} context */
function eventLog({ t, session, redraw }) {
  /** @type {Log | null} */ let logged = null;
  const list = h("div", { class: "log", role: "log", tabindex: "0", "aria-label": t("events.log") });
  const clear = () => {
    session.receive({ type: "forgetLog" }, "");
    redraw();
  };
  const save = () => {
    const rows = (logged ?? []).map(({ timeNs, robot, name, values }) => [seconds(timeNs), robot, name, ...values]);
    download("events.csv", csv([["seconds", t("robot"), t("name")], ...rows]), "text/csv");
  };
  const head = h(
    "div",
    { class: "row" },
    h("h3", {}, t("events.log")),
    h("button", { type: "button", class: "btn note slim", onclick: clear }, t("clear")),
    h("button", { type: "button", class: "btn note slim", onclick: save }, "CSV"),
  );
  return {
    elements: [head, list],
    /** @param {View} view */
    render({ log }) {
      if (log === logged) return;
      logged = log;
      const lines = logged.slice(-SHOWN_EVENTS).reverse();
      list.replaceChildren(
        ...lines.map(({ timeNs, robot, name, values }) =>
          h("p", {}, h("time", {}, seconds(timeNs)), ` ${robot === "" ? "" : `${robot}: `}${name} ${values.join(" ")}`),
        ),
      );
    },
  };
}
