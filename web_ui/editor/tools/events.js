// The program's events: send, add, remove, plot; and the log of received events.

import { download } from "../../browser/download.js";
import { h, lock, renew, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { LARGEST_EVENT } from "../aesl.js";
import { eventKey } from "../editor_session.js";
import { csv, parseNumbers } from "../numbers.js";
import { entryForm } from "./entry_form.js";
import { pinButton, showPin } from "./pin.js";

const SHOWN_EVENTS = 100;

/** @param {bigint} timeNs */
const seconds = (timeNs) => (Number(timeNs / 1_000_000n) / 1000).toFixed(3);

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function eventsTool({ t, session, emit, define, announce, redraw }) {
  const body = h("tbody");
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  const log = h("div", { class: "log", role: "log", tabindex: "0", "aria-label": t("events.log") });
  /** @type {import("./index.js").View | null} */ let shown = null;
  let listed = "";
  /** @type {Map<string, HTMLElement>} fields with typed values */ let rows = new Map();
  /** @type {readonly import("../state.js").LoggedEvent[] | null} */ let logged = null;

  const form = entryForm({
    t,
    kind: "event",
    least: 0,
    greatest: LARGEST_EVENT,
    label: t("events.size"),
    add: (name, size) => define("event", name, size),
  });

  /** @param {string} name @param {number} size */
  const rowOf = (name, size) => {
    const input = h("input", {
      type: "text",
      value: Array(size).fill(0).join(" "),
      hidden: size === 0,
      "aria-label": t("events.values", { name, size }),
    });
    const send = () => {
      const { values, problem } = parseNumbers(input.value, size);
      errorText.hidden = values !== null;
      if (values === null) return setText(errorText, `${name}: ${t(problem.key, problem.values)}`);
      emit(name, values);
      announce(t("events.sent", { name }));
    };
    input.addEventListener("keydown", ({ key }) => key === "Enter" && send());
    const plot = pinButton(t("variables.watch", { name }), () => {
      session.toggleWatch(eventKey(name));
      redraw();
    });
    plot.dataset.watch = name;
    return h(
      "tr",
      {},
      h("td", { class: "mark" }, plot),
      h("th", { scope: "row" }, `${name} [${size}]`),
      h(
        "td",
        { class: "send" },
        input,
        h("button", { type: "button", class: "btn line note slim", "data-send": name, onclick: send }, t("events.send")),
      ),
      h(
        "td",
        { class: "mark" },
        h(
          "button",
          {
            type: "button",
            class: "btn icon",
            "aria-label": t("remove", { name }),
            title: t("remove", { name }),
            onclick: () => define("event", name, null),
          },
          icon("close", { small: true }),
        ),
      ),
    );
  };

  const element = h(
    "div",
    { class: "events" },
    h("table", {}, body),
    errorText,
    form,
    h(
      "div",
      { class: "row" },
      h("h3", {}, t("events.log")),
      h("button", { type: "button", class: "btn note slim", onclick: () => session.receive({ type: "forgetLog" }, "") ?? redraw() }, t("clear")),
      h(
        "button",
        {
          type: "button",
          class: "btn note slim",
          onclick: () => {
            const rows = (shown?.log ?? []).map(({ timeNs, robot, name, values }) => [
              seconds(timeNs),
              robot,
              name,
              ...values,
            ]);
            download("events.csv", csv([["seconds", t("robot"), t("name")], ...rows]), "text/csv");
          },
        },
        "CSV",
      ),
    ),
    log,
  );
  return {
    name: "events",
    element,
    render(view) {
      shown = view;
      const events = view.file.events.map(({ name, value }) => ({ name, size: value }));
      const signature = JSON.stringify(events);
      if (signature !== listed) {
        listed = signature;
        const kept = rows;
        rows = new Map(events.map(({ name, size }) => [`${name} ${size}`, kept.get(`${name} ${size}`) ?? rowOf(name, size)]));
        renew(body, [...rows.values()]);
      }
      for (const button of body.querySelectorAll("[data-send]")) {
        lock(/** @type {HTMLButtonElement} */ (button), view.disabledReason);
      }
      for (const pin of body.querySelectorAll("[data-watch]")) {
        showPin(pin, session.watched.has(eventKey(pin.getAttribute("data-watch") ?? "")));
      }
      if (view.log === logged) return;
      logged = view.log;
      const lines = logged.slice(-SHOWN_EVENTS).reverse();
      log.replaceChildren(
        ...lines.map(({ timeNs, robot, name, values }) =>
          h("p", {}, h("time", {}, seconds(timeNs)), ` ${robot === "" ? "" : `${robot}: `}${name} ${values.join(" ")}`),
        ),
      );
    },
  };
}
