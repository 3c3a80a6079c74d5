// Entry point: creates the objects of the page and connects them. Each has one concern:
//
//   Store            state of the page
//   Client           connection to the bridge
//   Actions          what the user does to the simulator
//   SceneView        3D view
//   DragController   moving robots and objects in the view
//   Speaker          sound
//   PageLanguage     language and texts
//   Theme, MotionSetting    how the page looks and moves
//   Workspace, Frame        the open tab, and the layout of the page
//   PanelHost, ProgramHost, CreatorHost, MissionHost, ShareHost, TourHost, WelcomeHost    parts of the page

import { tokenIn, resolveToken } from "./browser/access_token.js";
import { watchDrops } from "./browser/file_drop.js";
import { isOutdated, keepPage } from "./browser/kept_page.js";
import { localStore, tabStore } from "./browser/local_storage.js";
import { MotionSetting } from "./browser/motion_setting.js";
import { OpenedFile } from "./browser/opened_file.js";
import { PageLanguage } from "./browser/page_language.js";
import { isPython } from "./browser/python_name.js";
import { robotNames } from "./browser/robot_names.js";
import { exposeForTests } from "./browser/test_access.js";
import { Theme } from "./browser/theme.js";
import { visitOptions } from "./browser/visit_options.js";
import { MUTED_KEY } from "./header/sound.js";
import { CreatorHost } from "./hosts/creator_host.js";
import { MissionHost } from "./hosts/mission_host.js";
import { ProgramHost } from "./hosts/program_host.js";
import { ShareHost } from "./hosts/share_host.js";
import { TourHost } from "./hosts/tour_host.js";
import { WelcomeHost } from "./hosts/welcome_host.js";
import { Actions, isProgram, PRIMITIVES } from "./input/actions.js";
import { watchKeyboard } from "./input/keyboard.js";
import { DragController } from "./move/drag_controller.js";
import { fetchShapes } from "./playground/declarations.js";
import { registerShapes } from "./playground/kinds/index.js";
import { ThumbnailCache } from "./playground_tab/thumbnail_cache.js";
import { bridgeAddress, isServed } from "./protocol/bridge_address.js";
import { Client } from "./protocol/client.js";
import { SceneView } from "./scene/index.js";
import { fillBottomBar } from "./shell/bottom_bar.js";
import { Frame } from "./shell/frame.js";
import { watchGrip } from "./shell/grip.js";
import { PanelHost } from "./shell/panel_host.js";
import { fillTabs } from "./shell/tabs.js";
import { fillTexts } from "./shell/texts.js";
import { Workspace } from "./shell/workspace.js";
import { Speaker } from "./sound/speaker.js";
import { GraphicsNotice } from "./stage/graphics_notice.js";
import { useHand } from "./stage/hands/use_hand.js";
import { isWatched, PARAMETERS, subscriptionKey, urgencyOf } from "./state/names.js";
import { Store } from "./state/store.js";
import { h } from "./ui/dom.js";
import { MessageAt } from "./ui/message_at.js";
import { isSomethingOpen } from "./ui/sheet.js";

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

/**
 * What covers the scene at its upper and lower edge. The wall of the 3D view leaves room for the buttons, the 2D view
 * has none.
 *
 * @param {HTMLElement} views
 * @param {HTMLElement} trouble
 */
function coveredEdges(views, trouble) {
  const scene = /** @type {HTMLElement} */ (trouble.parentElement).getBoundingClientRect();
  const edges = { top: 0, bottom: 0 };
  for (const covering of [views, trouble]) {
    const { top, bottom, height } = covering.getBoundingClientRect();
    if (height === 0) continue;
    if (top - scene.top < scene.bottom - bottom) edges.top = Math.max(edges.top, bottom - scene.top);
    else edges.bottom = Math.max(edges.bottom, scene.bottom - top);
  }
  return edges;
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

/** The objects of the page. Each exists once, as long as the page; texts are created anew in each language. */
class Page {
  #showTabs = () => {};
  #showBar = () => {};

  /** @param {{ token: string | undefined, address: string }} bridge */
  constructor({ token, address }) {
    const root = document.documentElement;
    const systemIsDark = matchMedia("(prefers-color-scheme: dark)");
    const systemIsCalm = matchMedia("(prefers-reduced-motion: reduce)");
    this.address = address;
    this.visit = visitOptions(location.search);
    this.store = new Store();
    this.pageLanguage = new PageLanguage(navigator.languages);
    this.theme = new Theme({ storage: localStore, systemIsDark, root });
    this.motion = new MotionSetting({ storage: localStore, systemIsCalm, root });
    this.workspace = new Workspace(localStore);
    this.frame = new Frame({ element, workspace: this.workspace });
    this.opened = new OpenedFile();
    this.messageAt = new MessageAt(document.body);
    this.graphics = new GraphicsNotice(element("#trouble"), (key) => this.#pageText(key), this.redraw);

    this.program = new ProgramHost({ slot: element("#panel-program"), client: () => this.client, token });
    this.creator = new CreatorHost({ element, scene: () => this.scene });
    this.mission = new MissionHost(element('[data-slot="mission"]'));
    this.share = new ShareHost({ token: token ?? "" });
    this.tour = new TourHost();
    this.welcome = new WelcomeHost(element('[data-slot="welcome"]'));
    this.panels = new PanelHost(element, this.workspace);

    this.client = this.#createClient(address, token);
    this.actions = new Actions({
      client: this.client,
      store: this.store,
      t: (key, values) => this.#pageText(key, values),
      language: () => this.pageLanguage.language,
    });
    this.speaker = new Speaker({
      createContext: "AudioContext" in window ? () => new AudioContext() : null,
      muted: localStore.getItem(MUTED_KEY) === "true",
      changed: this.redraw,
    });
    this.dragController = new DragController({
      state: () => this.store.state,
      place: (name, pose) => this.actions.place(name, pose),
      changed: this.redraw,
      report: (key, values) => announce(this.#pageText(key, values)),
    });
    this.scene = this.#createScene();
    const offered = this.store.until(({ services }) => services.includes(PRIMITIVES));
    this.thumbnails = new ThumbnailCache(
      (world) => this.scene.photographer.request(world),
      (items) => offered.then(() => this.actions.learnParts(items)),
    );
  }

  start() {
    this.#followSettings();
    if (!this.visit.scene) document.body.dataset.scene = "off";
    this.#build();
    watchGrip(element("#grip"), this.workspace, this.frame);
    this.frame.subscribe(this.#followWorkspace);
    this.#followStore();
    this.#watchInput();
    this.client.start();
    this.#followWorkspace();
    this.tour.start();
    this.share.start();
    const { store, scene, dragController, creator } = this;
    exposeForTests({ store, scene, dragController, creator });
  }

  redraw = () => this.scene.invalidate();

  /** @param {string} language */
  setLanguage = (language) => {
    this.pageLanguage.choose(language);
    this.#build();
  };

  /** @type {import("./i18n/index.js").Translate} */
  #pageText = (key, values) => this.pageLanguage.text("page")(key, values);

  /** @param {string} address @param {string | undefined} token */
  #createClient(address, token) {
    const { store, program } = this;
    return new Client({
      address,
      token,
      emit: (event) => {
        store.dispatch(event.type === "message" ? { ...event, nowMs: performance.now() } : event);
        program.receive(event, store.state.selected);
        if (event.type === "connected") void isOutdated().then((is) => is && store.dispatch({ type: "outdated" }));
      },
      wants: (topic) => isWatched(store.state, topic) || program.wants(topic),
      urgency: (topic) => urgencyOf(store.state, topic),
      parameters: [
        PARAMETERS.playground,
        PARAMETERS.factor,
        PARAMETERS.notice,
        PARAMETERS.noticeLink,
        PARAMETERS.pupil,
        PARAMETERS.pausedByTeacher,
        PARAMETERS.raisedHand,
        PARAMETERS.handouts,
      ],
      isServed,
    });
  }

  #createScene() {
    const { store, creator, mission, tour, welcome, panels, actions, graphics } = this;
    return new SceneView({
      canvas: canvasElement("#view"),
      flatCanvas: canvasElement("#flat"),
      labels: element("#labels"),
      state: () => creator.world ?? store.state,
      sketch: () => creator.sketch,
      beforeDraw: () => {
        creator.render();
        tour.render();
        welcome.render(store.state);
        mission.render(store.state);
        panels.render(store.state);
      },
      press: ({ robot, button }, pressed) => {
        store.dispatch({ type: "select", robot });
        actions.press(robot, button, pressed);
      },
      dragController: this.dragController,
      robotTitle: (name) => robotNames.title(name) || this.#pageText("app.robot"),
      select: (robot) => store.dispatch({ type: "select", robot }),
      contextLost: (trouble) => graphics.set(trouble),
      flatInsets: () => coveredEdges(element(".views"), element("#trouble")),
    });
  }

  /** Create all texts in the current language. */
  #build() {
    const { pageLanguage, program, creator, mission, share, tour, welcome, scene, graphics } = this;
    const context = {
      text: pageLanguage.text,
      language: pageLanguage.language,
      setLanguage: this.setLanguage,
      address: this.address,
      announce,
      visit: this.visit,
      actions: this.actions,
      store: this.store,
      scene,
      dragController: this.dragController,
      speaker: this.speaker,
      workspace: this.workspace,
      frame: this.frame,
      theme: this.theme,
      motion: this.motion,
      program,
      creator,
      mission,
      share,
      tour,
      welcome,
      thumbnails: this.thumbnails,
      opened: this.opened,
      messageAt: this.messageAt,
    };
    fillTexts(element, context);
    this.#showTabs = fillTabs(element("#tabs"), context);
    this.#showBar = fillBottomBar(element("#bar"), context);
    this.panels.build(context);
    for (const host of [program, creator, mission, share, tour, welcome]) host.setContext(context);
    if (!scene.painter.has3d) graphics.set("gone");
    else graphics.render();
    this.redraw();
  }

  /** Follow the workspace: hosts work only while their tab is shown. */
  #followWorkspace = () => {
    const { tab } = this.workspace;
    this.#showTabs();
    this.#showBar();
    void this.program.setVisible(tab === "program");
    this.creator.setVisible(tab === "playground");
    this.redraw();
  };

  #followSettings() {
    const { theme, motion, scene } = this;
    const followTheme = () => scene.setTheme(theme.isDark ? "dark" : "light");
    const followMotion = () => scene.setCalm(motion.isCalm);
    theme.subscribe(followTheme);
    motion.subscribe(followMotion);
    followTheme();
    followMotion();
  }

  #followStore() {
    const { store, program, speaker, redraw } = this;
    this.theme.subscribe(redraw);
    this.motion.subscribe(redraw);
    store.subscribe(redraw);
    store.subscribe(() => program.redraw());
    store.subscribe(() => speaker.update(store.state));
    watchSubscriptions(store, this.client);
  }

  #watchInput() {
    const { scene, dragController, actions, speaker, store } = this;
    for (const gesture of ["pointerup", "keydown"]) window.addEventListener(gesture, () => speaker.unlock());
    watchKeyboard(scene.canvas, scene, dragController, (button, pressed) => actions.pressPad(button, pressed), {
      useHand,
      pause: () => element("#pause").click(),
    });
    watchDrops(element("#drop"), (file, place) => this.#open(file, place));
    window.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape" || isSomethingOpen()) return; // it closes what is open first
      if (dragController.mode) dragController.setMode(false);
      else if (store.state.connection === "connected") void actions.stop();
    });
  }

  /** Open a file that was dropped. @param {File} file @param {import("./browser/opened_file.js").Place} place */
  #open(file, place) {
    const { program, creator, mission, actions, messageAt } = this;
    /** @param {string} words */
    const refuse = (words) => messageAt.show(place, [h("p", {}, words)], this.#pageText("notice.dismiss"));
    messageAt.hide();
    this.opened.note(file, place);
    if (isPython(file.name)) void program.openFile(file);
    else if (creator.isOpen && !isProgram(file)) creator.openFile(file, place);
    else if (program.isOpen && isProgram(file)) void program.openFile(file);
    else {
      void program
        .openOther(file)
        .then((isOpened) => isOpened || mission.openOther(file))
        .then((isOpened) => (isOpened ? undefined : actions.loadFile(file, refuse)));
    }
  }
}

async function main() {
  const token = readToken();
  const [address, shapes] = await Promise.all([bridgeAddress(), fetchShapes()]);
  if (shapes !== null) registerShapes(shapes); // before the first playground is read
  new Page({ token, address }).start();
  void keepPage();
}

void main();
