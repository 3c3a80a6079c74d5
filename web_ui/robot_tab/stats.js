// Four values beside the picture: tilt, sound, warmth, remote control.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

const UNKNOWN = "–";

/** @param {import("../i18n/index.js").Translate} t  texts of the robot */
export function robotStats(t) {
  const tilt = stat("tilt", "tilt", t("stat.tilt"), "°");
  const sound = stat("sound", "microphone", t("stat.sound"), t("stat.of255"));
  const warmth = stat("warmth", "warmth", t("stat.warmth"), "°C");
  const remote = stat("remote", "remote", t("stat.remote"), "");
  const bubble = h("i", {});
  const level = h("span", { class: "meter level", "aria-hidden": "true" }, bubble);
  const volume = h("span", { class: "meter", "aria-hidden": "true" });
  const plays = h("span", { class: "plays tiny" });
  tilt.element.append(level);
  sound.element.append(volume, plays);
  return {
    element: h("div", { class: "stats" }, ...[tilt, sound, warmth, remote].map(({ element }) => element)),
    /** @param {import("./picture_values.js").PictureValues} values */
    show(values) {
      tilt.show(values.tilt.degrees);
      setAttribute(level, "style", `--share: ${values.tilt.share}`);
      sound.show(values.sound.count);
      setAttribute(volume, "style", `--share: ${values.sound.share.toFixed(2)}`);
      setText(plays, values.sound.plays > 0 ? t("stat.plays", { frequency: values.sound.plays }) : "");
      warmth.show(values.warmth);
      remote.show(values.remote ?? t("stat.none"));
    },
  };
}

/** @param {string} name @param {import("../ui/icons.js").IconName} symbol @param {string} title @param {string} unit */
function stat(name, symbol, title, unit) {
  const number = h("span", {}, UNKNOWN);
  const element = h(
    "div",
    { class: "stat", "data-stat": name },
    h("span", { class: "row" }, icon(symbol, { small: true }), h("span", { class: "small" }, title)),
    h("b", {}, number, ...(unit === "" ? [] : [h("small", {}, ` ${unit}`)])),
  );
  return {
    element,
    /** @param {number | string | null} value */
    show(value) {
      setText(number, value === null ? UNKNOWN : String(value));
    },
  };
}
