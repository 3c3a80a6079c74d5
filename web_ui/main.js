// Entry point: connects protocol, state, scene and panels.

import { Actions, isProgram } from "./input/actions.js";
import { CreatorHost } from "./hosts/creator_host.js";
import { fetchShapes } from "./playground/declarations.js";
import { registerShapes } from "./playground/kinds/index.js";
import { watchDrops } from "./browser/file_drop.js";
import { EditorHost } from "./hosts/editor_host.js";
import { ThumbnailCache } from "./gallery/thumbnail_cache.js";
import { chooseLanguage, translator } from "./i18n/index.js";
import { watchKeyboard } from "./input/keyboard.js";
import { localStore, trySetItem, tabStore } from "./browser/local_storage.js";
import { PANELS } from "./panels/index.js";
import { DragController } from "./move/drag_controller.js";
import { MUTED_KEY } from "./panels/sound.js";
import { Client } from "./protocol/client.js";
import { SceneView } from "./scene/index.js";
import { Speaker } from "./sound/speaker.js";
import { snapshot } from "./state/index.js";
import { isWatched, PARAMETERS, subscriptionKey } from "./state/names.js";
import { Store } from "./state/store.js";
import { resolveToken, tokenIn } from "./browser/access_token.js";
import { TourHost } from "./hosts/tour_host.js";

const DEFAULT_PORT = 8765;
const LANGUAGE_KEY = "language";

/** @param {string} selector @returns {HTMLElement} */
function element(selector) {
  const found = document.querySelector(selector);
  if (found === null) throw new Error(`index.html has no ${selector}`);
  return /** @type {HTMLElement} */ (found);
}

/** The WebSocket address of the bridge: the port comes from the page's server, the host from the page's address. */
async function bridgeAddress() {
  const answer = await fetch("config.json").catch(() => null);
  const config = answer?.ok ? await answer.json().catch(() => ({})) : {};
  return `ws://${location.hostname || "localhost"}:${config.foxglove_port ?? DEFAULT_PORT}`;
}

async function main() {
  const token = resolveToken(tabStore, location.href, (shown) => history.replaceState(null, "", shown));
  // Browsers do not reload a page if only the fragment with the token changes.
  window.addEventListener("hashchange", () => {
    if (tokenIn(location.href) !== null) location.reload();
  });
  const [address, shapes] = await Promise.all([bridgeAddress(), fetchShapes()]);
  if (shapes !== null) registerShapes(shapes); // before the first playground is read
  const store = new Store();
  let language = chooseLanguage([localStore.getItem(LANGUAGE_KEY) ?? "", ...navigator.languages]);
  let t = translator(language);
  /** @type {import("./panels/index.js").Panel[]} */ let panels = [];

  const editor = new EditorHost({
    slot: element('[data-slot="editor"]'),
    client: () => client,
    changed: () => {
      if (editor.isOpen) creator.close();
      scene.invalidate();
    },
  });
  const creator = new CreatorHost({
    slot: (name) => element(`[data-slot="${name}"]`),
    scene: () => scene,
  });
  const tour = new TourHost();
  const client = new Client({
    address,
    token,
    emit: (event) => {
      store.dispatch(event.type === "message" ? { ...event, nowMs: performance.now() } : event);
      editor.receive(event, store.state.selected);
    },
    wants: (topic) => isWatched(store.state, topic) || editor.wants(topic),
    parameters: [PARAMETERS.playground, PARAMETERS.factor],
  });
  const actions = new Actions({ client, store, t: (key, values) => t(key, values), language: () => language });
  const live = element("#live");
  /** @param {string} text */
  const announce = (text) => {
    live.textContent = text;
  };

  const speaker = new Speaker({
    createContext: "AudioContext" in window ? () => new AudioContext() : null,
    muted: localStore.getItem(MUTED_KEY) === "true",
    changed: () => scene.invalidate(),
  });
  const canvas = /** @type {HTMLCanvasElement} */ (element("#view"));
  const trouble = element("#trouble");
  /** @type {"lost" | "gone" | null} state of the 3D view; null: working */ let graphics = null;
  const showTrouble = () => {
    trouble.hidden = graphics === null;
    trouble.dataset.kind = graphics ?? "";
    trouble.textContent = graphics === null ? "" : t(graphics === "lost" ? "app.contextLost" : "app.noWebgl");
  };

  const dragController = new DragController({
    state: () => store.state,
    place: (name, pose) => actions.place(name, pose),
    changed: () => scene.invalidate(),
    report: (key, values) => announce(t(key, values)),
  });
  const scene = new SceneView({
    canvas,
    flatCanvas: /** @type {HTMLCanvasElement} */ (element("#flat")),
    labels: element("#labels"),
    state: () => creator.world ?? store.state,
    sketch: () => creator.sketch,
    beforeDraw: () => {
      creator.render();
      tour.render();
      panels.forEach((panel) => panel.render?.(store.state));
      for (const driving of document.querySelectorAll("[data-drives]")) {
        driving.toggleAttribute("inert", store.state.readOnly);
      }
    },
    press: ({ robot, button }, pressed) => {
      store.dispatch({ type: "select", robot });
      actions.press(robot, button, pressed);
    },
    dragController,
    robotTitle: (name) => name || t("app.robot"),
    contextLost: (found) => {
      graphics = found;
      showTrouble();
    },
  });

  const thumbnails = new ThumbnailCache((world) => scene.photograph(world));

  const build = () => {
    t = translator(language);
    document.documentElement.lang = language;
    document.title = t("app.title");
    element("#title").textContent = t("app.title");
    element("#drop").textContent = t("app.drop");
    element("aside").setAttribute("aria-label", t("app.panels"));
    canvas.setAttribute("aria-label", t("view.canvas"));
    if (scene.renderer === null) graphics = "gone";
    showTrouble();
    document.querySelectorAll(".banner, .hint").forEach((banner) => banner.remove());
    for (const panel of panels) panel.element.remove();
    const context = { t, language, setLanguage, actions, store, scene, dragController, speaker, editor, creator, tour, thumbnails, address, announce };
    panels = PANELS.map((create) => create(context));
    for (const panel of panels) element(`[data-slot="${panel.slot}"]`).append(panel.element);
    editor.setContext(context);
    creator.setContext(context);
    tour.setContext(context);
    scene.invalidate();
  };
  /** @param {string} chosen */
  const setLanguage = (chosen) => {
    language = chosen;
    trySetItem(localStore, LANGUAGE_KEY, chosen);
    build();
  };

  build();
  store.subscribe(() => scene.invalidate());
  store.subscribe(() => editor.redraw());
  let watched = "";
  store.subscribe(() => {
    const now = subscriptionKey(store.state);
    if (now === watched) return;
    watched = now;
    client.refresh();
  });
  store.subscribe(() => speaker.update(store.state));
  for (const gesture of ["pointerup", "keydown"]) window.addEventListener(gesture, () => speaker.unlock());
  watchKeyboard(canvas, scene, dragController, (button, pressed) => actions.press(store.state.selected, button, pressed));
  watchDrops(element("#drop"), (file) => {
    if (creator.isOpen && !isProgram(file)) creator.openFile(file);
    else if (editor.isOpen && isProgram(file)) editor.editor?.open(file);
    else actions.loadFile(file);
  });
  window.addEventListener("keydown", ({ key }) => {
    if (key === "Escape" && store.state.connection === "connected") actions.stop();
  });
  client.start();
  tour.start();

  // Read-only access for tests: state, drawn frames, and screen positions of parts.
  Object.defineProperty(window, "thymio", {
    value: Object.freeze({
      state: () => snapshot(store.state),
      frames: () => scene.frames,
      screenPosition: (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ z) =>
        scene.screenPosition(x, y, z),
      held: () => dragController.held,
      built: () => creator.snapshot(),
      /** @param {string} part @param {string} [robot] */
      partPosition: (part, robot) => scene.partPosition(part, robot),
      get connected() {
        return store.state.connection === "connected";
      },
    }),
  });
}

main();
