import assert from "node:assert/strict";
import { test } from "node:test";

import { folderOf, followLocalStore, nameHere, scopedTo, storageOrMap } from "../../web_ui/browser/local_storage.js";

/** A storage of a browser, which all pages of an origin share. */
function sharedStorage() {
  return storageOrMap(() => {
    throw new Error("forbidden");
  });
}

for (const [path, folder] of [
  ["/", "/"],
  ["/index.html", "/"],
  ["/p/anna/", "/p/anna/"],
  ["/p/anna/index.html", "/p/anna/"],
]) {
  test(`the page ${path} is in the folder ${folder}`, () => assert.equal(folderOf(path), folder));
}

test("pupils of one origin do not see what the others have stored", () => {
  const shared = sharedStorage();
  const [anna, ben, root] = ["/p/anna/", "/p/ben/", "/"].map((folder) => scopedTo(shared, folder));
  anna.setItem("token", "secret");
  assert.equal(ben.getItem("token"), null);
  assert.equal(root.getItem("token"), null);
  ben.setItem("token", "other");
  ben.removeItem("token");
  assert.equal(anna.getItem("token"), "secret");
});

test("a page at the root keeps its keys of earlier versions", () => {
  const shared = sharedStorage();
  shared.setItem("theme", "dark");
  assert.equal(scopedTo(shared, "/").getItem("theme"), "dark");
});

test("a page follows changes of its own folder only", () => {
  /** @type {Record<string, (string | null)[]>} */ const changed = { "/": [], "/p/anna/": [] };
  const target = new EventTarget();
  for (const folder of Object.keys(changed)) followLocalStore((key) => changed[folder].push(key), target, folder);
  for (const key of ["theme", "/p/anna/theme", "/p/ben/theme", null]) {
    target.dispatchEvent(Object.assign(new Event("storage"), { key }));
  }
  assert.deepEqual(changed, { "/": ["theme", null], "/p/anna/": ["theme", null] });
});

test("channels have a name for each folder", () => {
  assert.equal(nameHere("editor", "/"), "editor");
  assert.notEqual(nameHere("editor", "/p/anna/"), nameHere("editor", "/p/ben/"));
});
