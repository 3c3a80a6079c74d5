// Sticky presses: what is clicked while Shift is down stays pressed, as if held by several fingers.

/**
 * Call back once when Shift is released or the window loses the focus.
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
