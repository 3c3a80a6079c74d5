// The access token in the page's address. It is kept for reloads of this tab and removed from the visible address.

/** @typedef {import("./local_storage.js").KeyValueStore} KeyValueStore */

const KEY = "token";

/** The token in an address, after # or ?; null if there is none. @param {string} address */
export function tokenIn(address) {
  const { hash, searchParams } = new URL(address);
  return new URLSearchParams(hash.slice(1)).get(KEY) ?? searchParams.get(KEY);
}

/** The address without its token. @param {string} address */
export function withoutToken(address) {
  const url = new URL(address);
  url.searchParams.delete(KEY);
  const rest = new URLSearchParams(url.hash.slice(1));
  if (rest.has(KEY)) {
    rest.delete(KEY);
    url.hash = rest.toString();
  }
  return url.href.replace(/#$/, "");
}

/**
 * The sub-protocol by which a WebSocket passes the token on (thymio_sim_ros/access/visitor.py), none without a token. A
 * browser sets no headers of a WebSocket, and proxies log addresses. It is offered last: jupyter-server-proxy accepts the
 * first sub-protocol, whatever its server accepts.
 *
 * @param {string} token
 */
export function tokenProtocols(token) {
  return token === "" ? [] : [String(new URLSearchParams({ [KEY]: token })).replace("=", ".")];
}

/**
 * The token to use: the one in the address, else the stored one; "" if there is none.
 *
 * @param {KeyValueStore} storage    session storage of this tab
 * @param {string} address
 * @param {(address: string) => void} show   replaces the address in the browser's address bar
 */
export function resolveToken(storage, address, show) {
  const given = tokenIn(address);
  if (given === null) return storage.getItem(KEY) ?? "";
  try {
    storage.setItem(KEY, given);
    show(withoutToken(address));
  } catch {
    // Storage failed, so the token stays in the address.
  }
  return given;
}
