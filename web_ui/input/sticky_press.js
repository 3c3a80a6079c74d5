// What a mouse clicks while Shift is down stays held, as several fingers would hold it.

/**
 * Call once when Shift is let go, or the page is left.
 *
 * @param {() => void} free
 */
export function onShiftRelease(free) {
  const ending = new AbortController();
  const { signal } = ending;
  const end = () => {
    ending.abort();
    free();
  };
  window.addEventListener("keyup", ({ key }) => key === "Shift" && end(), { signal });
  window.addEventListener("blur", end, { signal });
}
