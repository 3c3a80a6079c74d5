// Entry point: creates the objects of the page and connects them. Each has one concern:
//
//   Store            state of the page
//   Client           connection to the bridge
//   Actions          what the user does to the simulator
//   SceneView        3D view
//   DragController   moving robots and objects in the view
//   Speaker          sound
//   PageLanguage     language and texts
//   PanelHost, EditorHost, CreatorHost, TourHost    parts of the page

import { exposeForTests } from "./browser/test_access.js";
import { resolveToken, tokenIn } from "./browser/access_token.js";
import { watchDrops } from "./browser/file_drop.js";
import { localStore, tabStore } from "./browser/local_storage.js";
import { ThumbnailCache } from "./gallery/thumbnail_cache.js";
import { CreatorHost } from "./hosts/creator_host.js";
import { EditorHost } from "./hosts/editor_host.js";
import { PanelHost } from "./hosts/panel_host.js";
import { TourHost } from "./hosts/tour_host.js";
import { PageLanguage } from "./i18n/page_language.js";
import { Actions, isProgram } from "./input/actions.js";
import { watchKeyboard } from "./input/keyboard.js";
import { DragController } from "./move/drag_controller.js";
import { GraphicsNotice } from "./panels/graphics_notice.js";
import { MUTED_KEY } from "./panels/sound.js";
import { fetchShapes } from "./playground/declarations.js";
import { registerShapes } from "./playground/kinds/index.js";
import { bridgeAddress } from "./protocol/bridge_address.js";
import { Client } from "./protocol/client.js";
import { SceneView } from "./scene/index.js";
import { Speaker } from "./sound/speaker.js";
import { isWatched, PARAMETERS, subscriptionKey } from "./state/names.js";
import { Store } from "./state/store.js";

/** @param {string} selector @returns {HTMLElement} */
function element(selector) {
  const found = document.querySelector(selector);
  if (found === null) throw new Error(`index.html has no ${selector}`);
  return /** @type {HTMLElement} */ (found);
}

/** @param {string} selector */
function canvasElement(selector) {
  return /** @type {HTMLCanvasElement} */ (element(selector));
}

/** Write to the live region for screen readers. @param {string} text */
function announce(text) {
  element("#live").textContent = text;
}

/** The access token of this visit; it is removed from the address that the browser shows. */
function readToken() {
  // Browsers do not reload a page if only the fragment with the token changes.
  window.addEventListener("hashchange", () => {
    if (tokenIn(location.href) !== null) location.reload();
  });
  return resolveToken(tabStore, location.href, (shown) => history.replaceState(null, "", shown));
}

/** Update the subscriptions when the state wants other topics. @param {Store} store @param {Client} client */
function watchSubscriptions(store, client) {
  let subscribed = "";
  store.subscribe(() => {
    const wanted = subscriptionKey(store.state);
    if (wanted === subscribed) return;
    subscribed = wanted;
    client.refresh();
  });
}

async function main() {
  const token = readToken();
  const [address, shapes] = await Promise.all([bridgeAddress(), fetchShapes()]);
  if (shapes !== null) registerShapes(shapes); // before the first playground is read
  const store = new Store();
  const pageLanguage = new PageLanguage(navigator.languages);
  const { t } = pageLanguage;
  const redraw = () => scene.invalidate();

  const editor = new EditorHost({
    slot: element('[data-slot="editor"]'),
    client: () => client,
    changed: () => {
      if (editor.isOpen) creator.close();
      redraw();
    },
  });
  const creator = new CreatorHost({
    slot: (name) => element(`[data-slot="${name}"]`),
    scene: () => scene,
  });
  const tour = new TourHost();
  const panels = new PanelHost(element);
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
  const actions = new Actions({ client, store, t, language: () => pageLanguage.language });
  const speaker = new Speaker({
    createContext: "AudioContext" in window ? () => new AudioContext() : null,
    muted: localStore.getItem(MUTED_KEY) === "true",
    changed: redraw,
  });
  const dragController = new DragController({
    state: () => store.state,
    place: (name, pose) => actions.place(name, pose),
    changed: redraw,
    report: (key, values) => announce(t(key, values)),
  });
  const graphics = new GraphicsNotice(element("#trouble"), t);
  const scene = new SceneView({
    canvas: canvasElement("#view"),
    flatCanvas: canvasElement("#flat"),
    labels: element("#labels"),
    state: () => creator.world ?? store.state,
    sketch: () => creator.sketch,
    beforeDraw: () => {
      creator.render();
      tour.render();
      panels.render(store.state);
    },
    press: ({ robot, button }, pressed) => {
      store.dispatch({ type: "select", robot });
      actions.press(robot, button, pressed);
    },
    dragController,
    robotTitle: (name) => name || t("app.robot"),
    select: (robot) => store.dispatch({ type: "select", robot }),
    contextLost: (trouble) => graphics.set(trouble),
  });
  const thumbnails = new ThumbnailCache((world) => scene.photograph(world));

  /** Create all texts in the current language. */
  const build = () => {
    const { language, translate } = pageLanguage;
    const parts = { actions, store, scene, dragController, speaker, editor, creator, tour, thumbnails };
    const context = { t: translate, language, setLanguage, address, announce, ...parts };
    panels.build(context);
    for (const host of [editor, creator, tour]) host.setContext(context);
    if (scene.renderer === null) graphics.set("gone");
    else graphics.render();
    redraw();
  };
  /** @param {string} language */
  const setLanguage = (language) => {
    pageLanguage.choose(language);
    build();
  };

  build();
  store.subscribe(redraw);
  store.subscribe(() => editor.redraw());
  store.subscribe(() => speaker.update(store.state));
  watchSubscriptions(store, client);
  for (const gesture of ["pointerup", "keydown"]) window.addEventListener(gesture, () => speaker.unlock());
  watchKeyboard(scene.canvas, scene, dragController, (button, pressed) =>
    actions.press(store.state.selected, button, pressed),
  );
  watchDrops(element("#drop"), (file) => {
    if (creator.isOpen && !isProgram(file)) creator.openFile(file);
    else if (editor.isOpen && isProgram(file)) void editor.editor?.commands.open(file);
    else void actions.loadFile(file);
  });
  window.addEventListener("keydown", ({ key }) => {
    if (key === "Escape" && store.state.connection === "connected") void actions.stop();
  });
  client.start();
  tour.start();
  exposeForTests({ store, scene, dragController, creator });
}

void main();
