// When the tab of the program takes part in the connection, without a page.

import assert from "node:assert/strict";
import { test } from "node:test";

import { ProgramHost } from "../../web_ui/hosts/program_host.js";

test("a topic of the tab is wanted once its messages are kept, since a retained one comes only once", async () => {
  const host = new ProgramHost({
    slot: /** @type {HTMLElement} */ ({}),
    client: () => /** @type {import("../../web_ui/protocol/client.js").Client} */ ({ refresh() {} }),
  });
  const context = { store: { dispatch() {} }, text: () => () => "" };
  host.setContext(/** @type {import("../../web_ui/shell/context.js").Context} */ (/** @type {unknown} */ (context)));

  const shown = host.setVisible(true);
  assert.equal(host.isOpen, true);
  assert.equal(host.session, null); // the tab is being loaded
  assert.equal(host.wants("/_aseba/target"), false);
  await shown;
  host.session = /** @type {import("../../web_ui/editor/editor_session.js").EditorSession} */ ({});
  assert.equal(host.wants("/_aseba/target"), true);
  assert.equal(host.wants("/odom"), false);
});
