// The panels of the stage, in the order of the focus; of the messages the first that has something to say is shown. To
// add one: a file, and a line here.

import { arrivalPanel } from "./arrival.js";
import { bannerPanel } from "./banner.js";
import { fallenPanel } from "./fallen.js";
import { moveHintPanel } from "./move_hint.js";
import { noticesPanel } from "./notices.js";
import { teacherNotePanel } from "./teacher_note.js";
import { timePanel } from "./time_bar.js";
import { trayPanel } from "./tray.js";
import { viewsPanel } from "./views.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const STAGE = [
  viewsPanel,
  arrivalPanel,
  bannerPanel,
  teacherNotePanel,
  noticesPanel,
  fallenPanel,
  moveHintPanel,
  trayPanel,
  timePanel,
];
