// The panels of the header, in the order of the focus. To add one: a file, and a line here.

import { connectionPanel } from "./connection.js";
import { helpMenuPanel } from "./help_menu.js";
import { missionsPanel } from "./missions.js";
import { pupilPanel } from "./pupil.js";
import { robotChooserPanel } from "./robot_chooser.js";
import { settingsPanel } from "./settings.js";
import { stopPanel } from "./stop.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const HEADER = [pupilPanel, missionsPanel, robotChooserPanel, connectionPanel, settingsPanel, helpMenuPanel, stopPanel];
