// Which robots the text is for, by the choice of the robot in the header, and what is known about them.

import { ALL } from "./workspace.js";

export class RobotSelection {
  /**
   * @param {object} options
   * @param {import("../state/store.js").Store} options.store
   * @param {import("./editor_session.js").EditorSession} options.session
   * @param {import("./help_texts.js").HelpTexts} options.helpTexts
   */
  constructor({ store, session, helpTexts }) {
    this.store = store;
    this.session = session;
    this.helpTexts = helpTexts;
  }

  /** Names of all robots. */
  get robots() {
    return Object.keys(this.store.state.robots);
  }

  /** The tab of the workspace for the chosen robot: that of all robots if there is only one, or if all are addressed. */
  get wanted() {
    const { selected, toAll } = this.store.state;
    return toAll || this.robots.length < 2 ? ALL : selected;
  }

  /** The robot whose values are shown. */
  get robot() {
    return this.owner ?? this.store.state.selected;
  }

  /** The robot that the tab's program is for; null for all robots. */
  get owner() {
    const { tab } = this.session.workspace;
    return tab === ALL ? null : tab;
  }

  /** Names of the robots that the buttons control. */
  get controlled() {
    return this.owner === null ? this.robots : [this.owner];
  }

  /** Program state of the robot; null if not reported. */
  get status() {
    return this.store.state.programs[this.robot] ?? null;
  }

  /** What a program can use on the robot, with translated help; null if not reported. */
  get target() {
    return this.helpTexts.translate(this.session.state.targets[this.robot] ?? null);
  }

  /** Whether the robot runs exactly the text that is shown. */
  get isTextRunning() {
    const { workspace } = this.session;
    const { nodes } = workspace.file;
    const shown = nodes[workspace.current.node]?.name ?? "";
    const running = this.status?.values.node ?? "";
    const isSameNode = running === "" || running === shown || nodes.length === 1;
    return workspace.isInRobot && this.target?.program?.file === workspace.current.source && isSameNode;
  }
}
