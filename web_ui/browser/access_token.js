// The token of this page's address. Kept for reloads of this tab, and taken out of the address, which others may see.

/** @typedef {import("./local_storage.js").KeyValueStore} KeyValueStore */

const KEY = "token";

/** The token in an address, after # or ?; null: it has none. @param {string} address */
export function tokenIn(address) {
  const { hash, searchParams } = new URL(address);
  return new URLSearchParams(hash.slice(1)).get(KEY) ?? searchParams.get(KEY);
}

/** The same address without its token. @param {string} address */
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
 * The token to use: that of the address, else the one that is kept; "" is none.
 *
 * @param {KeyValueStore} storage    of this tab
 * @param {string} address
 * @param {(address: string) => void} show   writes another address into the browser's bar
 */
export function resolveToken(storage, address, show) {
  const given = tokenIn(address);
  if (given === null) return storage.getItem(KEY) ?? "";
  try {
    storage.setItem(KEY, given);
    show(withoutToken(address));
  } catch {
    // It cannot be kept, so it stays in the address.
  }
  return given;
}
