// Finds the WebSocket server that this page talks to.

const DEFAULT_PORT = 8765;

/** The address of the bridge: the port comes from the page's server, the host from the page's address. */
export async function bridgeAddress() {
  const answer = await fetch("config.json").catch(() => null);
  const config = answer?.ok ? await answer.json().catch(() => ({})) : {};
  return `ws://${location.hostname || "localhost"}:${config.foxglove_port ?? DEFAULT_PORT}`;
}
