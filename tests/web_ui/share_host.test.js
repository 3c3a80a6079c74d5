import assert from "node:assert/strict";
import { test } from "node:test";

import { sharedAddress, withoutShared } from "../../web_ui/hosts/share_host.js";

test("a link leads to the folder of the page without token and query; in a class to the choice of a name", () => {
  assert.equal(sharedAddress("http://a:1/?tour=off#token=x", false), "http://a:1/");
  assert.equal(sharedAddress("https://a/lab/thymio/index.html#share=1", false), "https://a/lab/thymio/");
  assert.equal(sharedAddress("http://a/p/ada/?x=/#token=x", true), "http://a/");
  assert.equal(sharedAddress("https://a/school/p/ada/", true), "https://a/school/");
});

test("what the address shares is removed from it, and nothing else", () => {
  assert.equal(withoutShared("http://a/?b=c#share=1.2.ab"), "http://a/?b=c");
  assert.equal(withoutShared("http://a/#token=x&share=1.2.ab"), "http://a/#token=x");
  assert.equal(withoutShared("http://a/"), "http://a/");
});
