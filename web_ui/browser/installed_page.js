// The page as an installed application: its service worker, and whether the server has a newer page.

/** Let the browser keep the page's files. Without https, it does so on this computer only. */
export function keepFiles() {
  if (!("serviceWorker" in navigator)) return;
  navigator.serviceWorker.register("service_worker.js").catch((error) => console.info(`not kept: ${error}`));
}

/** Whether the server has another build of the page than the one that is open; false if it does not answer. */
export async function isOutdated() {
  const own = document.querySelector('script[type="module"]')?.getAttribute("src");
  const answer = await fetch(".", { cache: "no-cache" }).catch(() => null);
  if (own == null || !answer?.ok) return false;
  return !(await answer.text()).includes(`"${own}"`);
}
