// Uses every method of the JavaScript client that our tests check, and prints what happens, one JSON text per line.
// TDM_URL is the address of the device manager; DOUBLE is a program that answers the event "double".
import { createClient, NodeStatus } from "@mobsya-association/thymio-api";

const say = (...what) => console.log("#" + JSON.stringify(what));
const until = async (condition) => {
  for (let tries = 0; !condition() && tries < 500; tries++) await new Promise((resolve) => setTimeout(resolve, 20));
};

const client = createClient(process.env.TDM_URL);
let isStarted = false;

client.onNodesChanged = async (nodes) => {
  if (isStarted || nodes.length < 2) return;
  isStarted = true;
  try {
    await run(nodes[0], nodes[1]);
  } catch (error) {
    say("error", String(error), error?.stack);
  }
  process.exit(0);
};

async function run(node, other) {
  const seen = {};
  say("node", node.name, node.typeAsString, node.statusAsString, node.group !== other.group);
  await node.lock();
  say("locked", node.statusAsString, node.status === NodeStatus.ready);
  node.onEvents = (events) => events.forEach((value, name) => (seen["event " + name] = value));
  node.onVariablesChanged = (values) => values.forEach((value, name) => (seen[name] = value));
  node.onSharedVariablesChanged = (values) => values.forEach((value, name) => (seen["shared " + name] = value));
  node.onEventsDescriptionsChanged = (events) => (seen.events = events.map((event) => event.name));
  await node.watchSharedVariablesAndEvents(true);
  await node.group.setEventsDescriptions([
    { name: "double", fixed_size: 1 },
    { name: "doubled", fixed_size: 1 },
  ]);
  await node.sendAsebaProgram("var a = b\n").catch((error) => say("rejected", String(error)));
  await node.sendAsebaProgram(process.env.DOUBLE);
  await node.runProgram();
  await node.emitEvents({ double: 21 });
  await until(() => seen["event doubled"]);
  say("event", seen["event doubled"]);
  await node.setVariables(new Map([["motor.left.target", [-300]]]));
  await until(() => seen["motor.left.target"] === -300);
  await until(() => seen.total === 42);
  say("variables", seen["motor.left.target"], seen.total, seen.acc);
  await node.group.setVariables(new Map([["SPEED", 5]]));
  await until(() => seen["shared SPEED"]);
  say("shared", seen["shared SPEED"], seen.events);
  await node.setScratchPad("var text", 1);
  await node.rename("mine");
  say("renamed", node.name);
  await node.flashProgram();
  await node.unlock();
  say("unlocked", node.statusAsString);
}
