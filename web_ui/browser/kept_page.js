// The page as an application that the browser keeps: its service worker, and whether the server has another page.

/** Let the browser keep the page. Without https, browsers do so for servers on their own computer only. */
export async function keepPage() {
  if (!("serviceWorker" in navigator)) return;
  const isFirst = navigator.serviceWorker.controller === null;
  try {
    await navigator.serviceWorker.register("service_worker.js");
  } catch (error) {
    return console.info(`The browser does not keep this page: ${error}`);
  }
  if (!isFirst) return;
  // What was loaded before the worker: it gets these files now, most of them from the browser's cache.
  navigator.serviceWorker.addEventListener(
    "controllerchange",
    () => {
      const loaded = performance.getEntriesByType("resource").map(({ name }) => name);
      for (const address of [".", ...loaded.filter((each) => each.includes("/assets/"))]) {
        fetch(address).catch(() => {}); // the server has ended: the next visit is a first one again
      }
    },
    { once: true },
  );
}

/** Whether the server has another build of the page than the one that is open; false if it does not answer. */
export async function isOutdated() {
  const own = document.querySelector('script[type="module"]')?.getAttribute("src");
  const answer = await fetch(".", { cache: "no-cache" }).catch(() => null);
  if (own == null || !answer?.ok) return false;
  return !(await answer.text()).includes(`"${own}"`);
}
