// Other tabs of this browser in which this page is open: they share its storage.

import { nameHere } from "./local_storage.js";

const CHANNEL = "thymio-editor";

/**
 * Call `met` when there is another tab, now or later; it is called in both.
 *
 * @param {() => void} met
 * @param {(name: string) => Pick<BroadcastChannel, "postMessage" | "onmessage">} [open]
 */
export function meetOtherTabs(met, open = (name) => new BroadcastChannel(name)) {
  const channel = open(nameHere(CHANNEL));
  channel.onmessage = ({ data }) => {
    if (data === "opened") channel.postMessage("here");
    met();
  };
  channel.postMessage("opened");
}

/**
 * @typedef {object} OpenPages   the pages of this browser that are open
 * @property {(page: string) => void} join   this page is open under this name until it is closed or crashes
 * @property {(page: string, act: () => void) => void} whenClosed   call `act` once the page of this name is not open
 */

/**
 * A page holds a lock with its name for as long as it is open: only the browser notices a crash. Browsers have no locks
 * where the page comes from another computer without TLS; then every other page counts as closed.
 *
 * @param {Pick<LockManager, "request"> | undefined} locks   `navigator.locks`
 * @returns {OpenPages}
 */
export function openPages(locks) {
  if (locks === undefined) return { join() {}, whenClosed: (_page, act) => act() };
  /** @param {string} page */
  const nameOf = (page) => `thymio-page.${page}`;
  return {
    join: (page) => void locks.request(nameOf(page), () => new Promise(() => {})).catch(() => {}),
    // Granted when the page lets go of its lock; shared, because several pages may wait. It fails without storage.
    whenClosed: (page, act) => void locks.request(nameOf(page), { mode: "shared" }, () => {}).then(act, act),
  };
}
