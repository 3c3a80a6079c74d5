// A hand before the front sensors: where it is, and how near. It stays there until it is taken away.

import { h, setAttribute } from "../../ui/dom.js";
import { handCounts, PLACES } from "./hand_counts.js";
import { HandSettings } from "./settings.js";
import { sheetHand } from "./sheet_hand.js";
import { slider } from "./slider.js";

const START = { place: /** @type {import("./hand_counts.js").Place | null} */ (null), near: 70 };

/** @param {import("../../shell/context.js").Context} context @returns {import("./index.js").Hand} */
export function frontHand({ text, actions, store }) {
  const t = text("stage");
  const settings = new HandSettings(store, START);
  const send = () => {
    const { place, near } = settings.now;
    actions.operate("_press/proximity", "std_msgs/msg/Int16MultiArray", { data: handCounts(place, near / 100) });
  };
  const near = slider({ name: "near", label: t("hand.hand.near"), low: 0, high: 100, step: 5, unit: "%" }, (value) => {
    settings.change({ near: value });
    if (settings.now.place !== null) send();
  });
  /** @param {import("./hand_counts.js").Place | null} place */
  const hold = (place) => {
    settings.change({ place });
    send();
    refresh();
  };
  const places = PLACES.map((place) => ({
    place,
    button: h(
      "button",
      {
        type: "button",
        class: `btn line ${place}`,
        "data-place": place,
        onclick: () => hold(settings.now.place === place ? null : place),
      },
      t(`hand.hand.${place}`),
    ),
  }));
  const away = h(
    "button",
    { type: "button", class: "btn line", "data-place": "none", onclick: () => hold(null) },
    t("hand.hand.away"),
  );
  const refresh = () => {
    const { place: now, near: percent } = settings.now;
    for (const { place, button } of places) setAttribute(button, "aria-pressed", String(place === now));
    near.show(percent);
  };
  return sheetHand({
    name: "hand",
    drawing: "hand",
    t,
    content: [
      h("p", { class: "small muted" }, t("hand.hand.help")),
      h(
        "div",
        { class: "hand-places", role: "group", "aria-label": t("hand.hand.where") },
        ...places.map(({ button }) => button),
      ),
      near.element,
      away,
    ],
    isHeld: () => settings.now.place !== null,
    refresh,
  });
}
