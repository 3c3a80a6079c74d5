// The WebSocket server that this page talks to.

/** The address of the bridge: that of the page, with its path, or another port of its host that the page's server names. */
export async function bridgeAddress() {
  const answer = await fetch("config.json").catch(() => null);
  const config = answer?.ok ? await answer.json().catch(() => ({})) : {};
  return addressBeside(location.href, config.foxglove_port);
}

/**
 * @param {string} page   the URL of the page
 * @param {number | undefined} port   the port of a bridge that is not on the page's own
 */
export function addressBeside(page, port) {
  const address = new URL(port === undefined ? "." : "/", page);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  if (port !== undefined) address.port = String(port);
  return address.href;
}

/** Whether the server of the page answers. */
export async function isServed() {
  try {
    return (await fetch("config.json", { cache: "no-store" })).ok;
  } catch {
    return false;
  }
}
