// What every part of the page gets, and what a panel is.

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../i18n/page_texts.js").TextFile} TextFile */
/**
 * @typedef {object} Context
 * @property {(file: TextFile) => Translate} text   the texts of one file of languages/ in the current language
 * @property {string} language
 * @property {(language: string) => void} setLanguage
 * @property {import("../input/actions.js").Actions} actions
 * @property {import("../state/store.js").Store} store
 * @property {import("../scene/index.js").SceneView} scene
 * @property {import("../move/drag_controller.js").DragController} dragController
 * @property {import("../sound/speaker.js").Speaker} speaker
 * @property {import("./workspace.js").Workspace} workspace   the open tab, its width
 * @property {import("./frame.js").Frame} frame   the layout of the page
 * @property {import("../browser/theme.js").Theme} theme
 * @property {import("../browser/motion_setting.js").MotionSetting} motion
 * @property {import("../browser/visit_options.js").VisitOptions} visit
 * @property {import("../hosts/program_host.js").ProgramHost} program
 * @property {import("../hosts/creator_host.js").CreatorHost} creator
 * @property {import("../hosts/mission_host.js").MissionHost} mission
 * @property {import("../hosts/share_host.js").ShareHost} share
 * @property {import("../hosts/tour_host.js").TourHost} tour
 * @property {import("../hosts/welcome_host.js").WelcomeHost} welcome
 * @property {import("../playground_tab/thumbnail_cache.js").ThumbnailCache} thumbnails   shipped playgrounds with their thumbnails
 * @property {import("../browser/opened_file.js").OpenedFile} opened   the file that was opened last, and where it was dropped
 * @property {import("../ui/message_at.js").MessageAt} messageAt   a message at a place of the window
 * @property {string} address   address of the simulator, for display
 * @property {(text: string) => void} announce   writes to the live region for screen readers
 */
/**
 * The places of index.html: elements with `data-slot`. The first four are the tabs of the workspace.
 *
 * @typedef {"robot" | "program" | "playground" | "class" | "header" | "tab-end" | "views" | "messages" | "welcome"
 *   | "tray" | "time"} Slot
 */
/**
 * @typedef {object} Panel
 * @property {Slot} slot
 * @property {HTMLElement} element
 * @property {(state: State) => void} [render]   once per frame while its tab is shown
 * @property {(state: State) => void} [watch]    once per frame, also while its tab is hidden: for what it announces
 */
/** @typedef {(context: Context) => Panel} CreatePanel */

export {};
