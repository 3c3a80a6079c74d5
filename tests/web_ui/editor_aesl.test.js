import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { AeslError, allEvents, newAesl, readAesl, withCode, withEntry } from "../../web_ui/editor/aesl.js";
import { codeOf, opened } from "../../web_ui/editor/documents.js";

const BEHAVIORS = new URL("../../thymio_sim_ros/device/firmware/behaviors/", import.meta.url);
const FILES = readdirSync(BEHAVIORS)
  .filter((name) => name.endsWith(".aesl"))
  .map((name) => /** @type {const} */ ([name, readFileSync(new URL(name, BEHAVIORS), "utf8")]));

const ODD = [
  "<!DOCTYPE aesl-source>",
  "<network><!-- mine -->",
  '<event name="ping" size="1"/>',
  "<constant name='A&amp;B' value='-5' />",
  '<node nodeId="7" name="anna">if a &lt; 1 and b > 2 then<![CDATA[ c = 1 < 2 ]]><toolsPlugins><X>code?</X></toolsPlugins>',
  "end&#x1F600;</node>",
  '<node name="thymio-II" />',
  "</network><!-- end -->",
].join("\r\n");

test("the code of a node is its text and CDATA, without that of its children", () => {
  const [anna, empty] = readAesl(ODD).nodes;
  assert.equal(anna.code, "if a < 1 and b > 2 then c = 1 < 2 \nend😀");
  assert.deepEqual([anna.name, anna.id], ["anna", "7"]);
  assert.equal(empty.code, "");
});

test("events and constants are read with their numbers", () => {
  const { events, constants } = readAesl(ODD);
  assert.deepEqual(
    events.map(({ name, value }) => [name, value]),
    [["ping", 1]],
  );
  assert.deepEqual(
    constants.map(({ name, value }) => [name, value]),
    [["A&B", -5]],
  );
});

test("the same code leaves every byte in place", () => {
  for (const [, text] of [...FILES, ["odd", ODD]]) {
    readAesl(text).nodes.forEach(({ code }, index) => assert.equal(withCode(text, index, code), text));
  }
});

test("only what differs is replaced", () => {
  const [anna] = readAesl(ODD).nodes;
  assert.equal(withCode(ODD, 0, anna.code.replace("a <", "speed <")), ODD.replace("a &lt;", "speed &lt;"));
  assert.equal(withCode(ODD, 0, anna.code.replace("c = 1", "c = 2\n")), ODD.replace("c = 1", "c = 2\r\n"));
  assert.equal(withCode(ODD, 0, anna.code.replace("😀", "")), ODD.replace("&#x1F600;", ""));
});

test("any code is read back unchanged, and the rest of the file stays", () => {
  const codes = ["", "a = 1", "a < b & c > d ]]>\n\t# ä😀\n", "end😁", "x".repeat(40)];
  for (const [, text] of [...FILES, ["odd", ODD]]) {
    readAesl(text).nodes.forEach((_node, index) => {
      for (const first of codes) {
        for (const second of codes) {
          const changed = withCode(withCode(text, index, first), index, second);
          const read = readAesl(changed);
          assert.equal(read.nodes[index].code, second);
          const names = readAesl(text).events.map(({ name }) => name);
          assert.deepEqual(
            read.events.map(({ name }) => name),
            names,
          );
        }
      }
    });
  }
});

test("plug-in data and text after the network are kept by an edit", () => {
  const changed = withCode(ODD, 0, "");
  assert.match(changed, /<toolsPlugins><X>code\?<\/X><\/toolsPlugins>/);
  assert.match(changed, /<!-- mine -->[\s\S]*<!-- end -->$/);
});

test("events and constants are appended, changed in place, and removed with their line", () => {
  const added = withEntry(ODD, "event", "pong", 2);
  assert.deepEqual(
    readAesl(added).events.map(({ name, value }) => [name, value]),
    [
      ["ping", 1],
      ["pong", 2],
    ],
  );
  assert.equal(withEntry(added, "event", "pong", null), ODD);
  assert.equal(withEntry(ODD, "constant", "A&B", 300), ODD.replace("'-5'", "'300'"));
  assert.equal(withEntry(ODD, "constant", "missing", null), ODD);
});

test("code that would form the end of CDATA is rewritten", () => {
  const node = '<node nodeId="1" name="a"><![CDATA[if a[b[1]] > 3 then\nend]]></node>';
  const changed = withCode(`<network>${node}<!-- after --></network>`, 0, "if a[b[1]]>3 then\nend");
  assert.equal(readAesl(changed).nodes[0].code, "if a[b[1]]>3 then\nend");
  assert.match(changed, /<\/node><!-- after --><\/network>$/);
});

test("entries may have a closing tag of their own", () => {
  const text = '<network>\n<event name="a" size="1"></event>\n<node nodeId="1" name="x"></node></network>';
  assert.deepEqual(readAesl(withEntry(text, "event", "a", null)).events, []);
  const added = readAesl(withEntry(text, "event", "b", 2)).events.map(({ name, value }) => [name, value]);
  assert.deepEqual(added, [
    ["a", 1],
    ["b", 2],
  ]);
});

test("a file without a node gets one, however its root is written", () => {
  for (const text of ["<network/>", "<network></network >", "<!-- </network> --><network></network>"]) {
    const document = opened("x", text);
    assert.equal(codeOf(document), "");
    assert.deepEqual(readAesl(withEntry(text, "constant", "K", 3)).constants.map(({ value }) => value), [3]);
  }
});

test("a missing size or value is 0, and can be set", () => {
  const text = '<network><event name="a"/><constant name="N"/><node/></network>';
  const { events, constants } = readAesl(text);
  assert.deepEqual([events[0].value, constants[0].value], [0, 0]);
  const changed = withEntry(withEntry(text, "event", "a", 2), "constant", "N", -3);
  assert.equal(changed, '<network><event size="2" name="a"/><constant value="-3" name="N"/><node/></network>');
});

test("a program of the largest size can be read", () => {
  assert.equal(codeOf(opened("big.aseba", `# ${"x".repeat(900_000)}`)).length, 900_002);
});

test("a name that every object has is no entity", () => {
  assert.throws(() => readAesl('<network><node nodeId="1" name="x">&toString;</node></network>'), AeslError);
});

test("a new file is one that can be read, with the code in it", () => {
  const text = withEntry(withEntry(newAesl("a < 1"), "constant", "SPEED", 100), "event", "go", 0);
  const { nodes, events, constants } = readAesl(text);
  assert.deepEqual([nodes[0].code, events[0].name, constants[0].value], ["a < 1", "go", 100]);
});

for (const [what, text, line, column, message] of /** @type {[string, string, number, number, string][]} */ ([
  ["another root", "<html></html>", 1, 1, "found <html>, expected <network>"],
  ["two roots", "<network/><a/>", 1, 11, "found a second root element <a>, expected one root element"],
  ["a missing closing tag", "<network>\n<node>", 2, 7, "found the end of the file, expected </node>"],
  ["a wrong closing tag", "<network>\n <node></network>", 2, 8, "found </network>, expected </node>"],
  ["a superfluous closing tag", "<network/></a>", 1, 11, "found </a>, expected no closing tag: no element is open"],
  ["text after the root", "<network/>a", 1, 11, "found text outside of <network>, expected a tag or a comment"],
  ["a comment without end", "<network><!-- a", 1, 10, "found a comment without end, expected -->"],
  ["a bare <", "<network>\n<node>< b</node></network>", 2, 7, 'found "< b</node></network>", expected a tag; write \'<\' as &lt;'],
  ["a bare &", "<network>\n<node>a & b</node></network>", 2, 9, "found '&', expected an entity; write '&' as &amp;"],
  ["an unknown entity", "<network><node>&a;</node></network>", 1, 16, "found &a;, expected a known entity; write '&' as &amp;"],
  ["an entity without character", "<network><node>&#0;</node></network>", 1, 16, "found &#0;, expected the code of a character, from 1 to 10FFFF hexadecimal"],
  ["no number", '<network>\n<constant name="a" value="x"/></network>', 2, 27, "<constant> value: found 'x', expected a whole number from -32768 to 32767"],
  ["too large a constant", '<network><constant name="a" value="40000"/></network>', 1, 36, "<constant> value: found '40000', expected a whole number from -32768 to 32767"],
  ["an event without name", '<network><event size="1"/></network>', 1, 10, "<event>: found no attribute name, expected one"],
  ["no content", "", 1, 1, "found the end of the file, expected <network>"],
])) {
  test(`a file with ${what} is rejected with its position`, () => {
    assert.throws(() => readAesl(text), { name: "AeslError", message, line, column });
  });
}

test("a VPL file has the implicit events of VPL", () => {
  const vpl = "<toolsPlugins><ThymioVisualProgramming><vplroot/></ThymioVisualProgramming></toolsPlugins>";
  const added = ["pair_run 1", "debug_log 14"];
  /** @param {string} inside */
  const events = (inside) => allEvents(readAesl(`<network>${inside}</network>`)).map(({ name, value }) => `${name} ${value}`);
  assert.deepEqual(events(`<node>a${vpl}</node>`), added);
  assert.deepEqual(events(`<event size="1" name="pair_run"/><node>a${vpl}</node>`), added);
  assert.deepEqual(events(`<event size="2" name="e"/><node>a${vpl}</node>`), ["e 2", ...added]);
  assert.deepEqual(events("<node>a</node>"), []);
});

test("name and number of a node, and unknown parts, are kept when its code changes", () => {
  const head = `<!DOCTYPE aesl-source>\r\n<network>\r\n<mystery a='1'/><node name="Thymio_4 on PC" nodeId='{5f8a}'>`;
  const tail = "<toolsPlugins><a><b/></a></toolsPlugins></node>\r\n<!-- end --></network>";
  assert.equal(withCode(`${head}var a${tail}`, 0, "var b"), `${head}var b${tail}`);
  for (const opening of ["<node>", "<node name=''>", '<node name="Serielles USB-Gerät">']) {
    assert.equal(withCode(`<network>${opening}a</node></network>`, 0, "b"), `<network>${opening}b</node></network>`);
  }
});
