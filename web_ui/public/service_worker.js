// Keeps the files of the page, so that it opens while its server is away and can say so.
//
// The page itself always comes from its server while that answers, so that it is never older than the server. Files with
// a hash of their content in their names never change; they are kept until the server has another page. A page under
// another path has a worker and a store of its own.

const SCOPE = self.registration.scope;
const STORE = `thymio-sim ${SCOPE}`;
const UNCHANGING = /^assets\/.+-[\w-]{8}\.\w+$/;

self.addEventListener("install", () => void self.skipWaiting());
self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));
self.addEventListener("fetch", (event) => {
  const { method, url } = event.request;
  const address = url.replace(/[?#].*/, "");
  if (method !== "GET" || !address.startsWith(SCOPE)) return;
  const path = address.slice(SCOPE.length);
  if (path === "") event.respondWith(currentPage(event));
  else if (UNCHANGING.test(path)) event.respondWith(unchangingFile(event.request));
});

/** The page: from the server, otherwise from the store. A proxy answers for a server that is away, too. */
async function currentPage(event) {
  const answer = await fetch(event.request).catch(() => null);
  if (answer?.ok) event.waitUntil(keepPage(answer.clone()));
  else if (answer === null || answer.status >= 500) {
    const known = await (await caches.open(STORE)).match(SCOPE);
    return known ?? answer ?? Response.error();
  }
  return answer;
}

/** Keep the page, without its query, which may have a token; forget the files of another one. */
async function keepPage(answer) {
  const known = await (await caches.open(STORE)).match(SCOPE);
  const text = await answer.clone().text();
  if (known !== undefined && (await known.text()) !== text) await caches.delete(STORE);
  await (await caches.open(STORE)).put(SCOPE, answer);
}

async function unchangingFile(request) {
  const store = await caches.open(STORE);
  const known = await store.match(request);
  if (known !== undefined) return known;
  const answer = await fetch(request);
  if (answer.ok) await store.put(request, answer.clone());
  return answer;
}
