// All panels, in display order. To add one: a file, and a line here.

import { connectionPanel } from "./connection.js";
import { creatorSwitchPanel } from "./creator_switch.js";
import { displayPanel } from "./display.js";
import { dpadPanel } from "./dpad.js";
import { editorSwitchPanel } from "./editor_switch.js";
import { fallenPanel } from "./fallen.js";
import { languagePanel } from "./language.js";
import { noticesPanel } from "./notices.js";
import { playgroundPanel } from "./playground.js";
import { programPanel } from "./program.js";
import { robotsPanel } from "./robots.js";
import { sensorsPanel } from "./sensors.js";
import { soundPanel } from "./sound.js";
import { stopPanel } from "./stop.js";
import { stimuliPanel } from "./stimuli.js";
import { timePanel } from "./time.js";
import { tourSwitchPanel } from "./tour_switch.js";
import { viewsPanel } from "./views.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/**
 * @typedef {object} Context
 * @property {Translate} t
 * @property {string} language
 * @property {(language: string) => void} setLanguage
 * @property {import("../input/actions.js").Actions} actions
 * @property {import("../state/store.js").Store} store
 * @property {import("../scene/index.js").SceneView} scene
 * @property {import("../move/drag_controller.js").DragController} dragController
 * @property {import("../sound/speaker.js").Speaker} speaker
 * @property {import("../hosts/editor_host.js").EditorHost} editor
 * @property {import("../hosts/creator_host.js").CreatorHost} creator
 * @property {import("../hosts/tour_host.js").TourHost} tour
 * @property {import("../gallery/thumbnail_cache.js").ThumbnailCache} thumbnails   shipped playgrounds with their thumbnails
 * @property {string} address   address of the simulator, for display
 * @property {(text: string) => void} announce   writes to the live region for screen readers
 */
/**
 * @typedef {object} Panel
 * @property {"header" | "stage" | "main" | "side" | "footer"} slot
 * @property {HTMLElement} element
 * @property {(state: State) => void} [render]
 */

/** @type {((context: Context) => Panel)[]} */
export const PANELS = [
  connectionPanel,
  editorSwitchPanel,
  creatorSwitchPanel,
  languagePanel,
  soundPanel,
  tourSwitchPanel,
  stopPanel,
  noticesPanel,
  viewsPanel,
  dpadPanel,
  fallenPanel,
  robotsPanel,
  programPanel,
  playgroundPanel,
  sensorsPanel,
  stimuliPanel,
  displayPanel,
  timePanel,
];
