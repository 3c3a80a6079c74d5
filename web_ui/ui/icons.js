// Icons of the page: one family on a 24 px grid, strokes of 2 px with round ends, at most one filled part (class "f").
// The color is that of the text around it. The control that contains an icon has the name.

const DRAWINGS = /** @type {const} */ ({
  add: '<path d="M12 5v14M5 12h14"/>',
  back: '<path d="m14.5 6-6 6 6 6"/>',
  backward: '<path class="f" d="M12 17 6.5 8.5h11z"/>',
  beams: '<path d="M4 9.5v5M8 12h3M8.5 8.5l2.5-2M8.5 15.5l2.5 2M14.5 12h6M14 7.5l5.5-3.5M14 16.5l5.5 3.5"/>',
  blocks:
    '<path d="M4 5.5A1.5 1.5 0 0 1 5.5 4h2.2l1.3 1.5h2L12.3 4h6.2A1.5 1.5 0 0 1 20 5.5V10H4ZM4 10v8.5A1.5 1.5 0 0 0 5.5 20h8a1.5 1.5 0 0 0 1.5-1.5V10"/>',
  box: '<path d="M12 3.5 20 8v8.5l-8 4.5-8-4.5V8Z"/><path d="M4 8l8 4.5L20 8M12 12.5V21"/>',
  camera:
    '<path d="M3.5 8A1.5 1.5 0 0 1 5 6.5h9A1.5 1.5 0 0 1 15.5 8v8a1.5 1.5 0 0 1-1.5 1.5H5A1.5 1.5 0 0 1 3.5 16Z"/><path d="m15.5 11 5-3v8l-5-3"/>',
  caretDown: '<path d="m7 10 5 5 5-5"/>',
  caretUp: '<path d="m7 14 5-5 5 5"/>',
  center: '<circle class="f" cx="12" cy="12" r="4.5"/>',
  check: '<path d="m5 12.5 4.7 4.7L19.5 7.5"/>',
  clap:
    '<path d="M8.2 20.5 4.5 16.8a3 3 0 0 1 0-4.2l4.7-4.7a1.5 1.5 0 0 1 2.1 2.1l4.2-4.2a1.5 1.5 0 0 1 2.1 2.1l1.4 1.3a1.5 1.5 0 0 1 .2 2.1l-6.7 8"/><path d="M8.5 3v1.8M4.3 4.8l1.2 1.4M13 2.5l-.6 1.7"/>',
  class:
    '<circle cx="8.5" cy="8.5" r="3"/><circle cx="16.5" cy="9.5" r="2.5"/><path d="M3 19.5c0-3.2 2.3-5.5 5.5-5.5s5.5 2.3 5.5 5.5M16 14.5c2.9-.3 5 1.8 5 4.5"/>',
  close: '<path d="m6 6 12 12M18 6 6 18"/>',
  copy:
    '<rect x="8.5" y="8.5" width="11.5" height="11.5" rx="2.5"/><path d="M15.5 5.5A1.5 1.5 0 0 0 14 4H5.5A1.5 1.5 0 0 0 4 5.5V14a1.5 1.5 0 0 0 1.5 1.5"/>',
  door: '<path d="M3 20.5h18M6.5 20.5v-16h11v16"/><circle class="f" cx="14.3" cy="12.5" r="1.4"/>',
  eye:
    '<path d="M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12Z"/><circle cx="12" cy="12" r="2.8"/>',
  file:
    '<path d="M6 3.5h8l4.5 4.5v11a1.5 1.5 0 0 1-1.5 1.5H6A1.5 1.5 0 0 1 4.5 19V5A1.5 1.5 0 0 1 6 3.5Z"/><path d="M13.5 3.8V8.5h4.7"/>',
  flag: '<path d="M6 21V4M6 4.5c4-2.5 7.5 2.5 12 0V13c-4.5 2.5-8-2.5-12 0"/>',
  fold: '<path d="M5 6h14M7.5 11l4.5 4.5L16.5 11"/>',
  follow: '<circle cx="12" cy="12" r="3.2"/><path d="M12 3v3M12 18v3M3 12h3M18 12h3"/>',
  forward: '<path class="f" d="M12 7 17.5 15.5h-11z"/>',
  give: '<path d="M12 19.5V8.5M7.5 12.5 12 8l4.5 4.5M4.5 4.5h15"/>',
  globe: '<circle cx="12" cy="12" r="9"/><path d="M3 12h18M12 3c3 3.2 3 14.8 0 18M12 3c-3 3.2-3 14.8 0 18"/>',
  goOn: '<path d="M4 5.5v13M8.5 6.5v11l9.5-5.5z"/>',
  grid: '<rect x="4" y="4" width="16" height="16" rx="2"/><path d="M4 9.3h16M4 14.7h16M9.3 4v16M14.7 4v16"/>',
  halt: '<path d="M8 3.5h8l4.5 4.5v8L16 20.5H8L3.5 16V8Z"/><path d="M9.8 9v6M14.2 9v6"/>',
  hand:
    '<path d="M8 12.5V6.3a1.4 1.4 0 0 1 2.8 0v5V4.7a1.4 1.4 0 0 1 2.8 0v6.6V5.9a1.4 1.4 0 0 1 2.8 0V14c0 4-2.2 6.5-5.3 6.5-2.4 0-3.9-1.1-5.1-3.3L4.3 13.7a1.4 1.4 0 0 1 2.4-1.4L8 14"/>',
  help:
    '<circle cx="12" cy="12" r="9"/><path d="M9.6 9.5a2.5 2.5 0 1 1 3.6 2.2c-.8.4-1.2.9-1.2 1.8"/><circle class="f" cx="12" cy="16.8" r="1.2"/>',
  home: '<path d="M3.5 17.5 8 8h12.5L16 17.5Z"/><path d="M12 4.5 4.5 4.5M4.5 4.5v3"/>',
  idea: '<path d="M9 17.5h6M10 20.5h4M8.3 14.5a6 6 0 1 1 7.4 0c-.5.4-.7 1-.7 1.5v1.5H9V16c0-.6-.2-1.1-.7-1.5Z"/>',
  image:
    '<rect x="3.5" y="4.5" width="17" height="15" rx="2"/><path d="m4 17 5-5.5 4 4 2.5-2.5 5 5"/><circle class="f" cx="15.5" cy="9" r="1.6"/>',
  keys:
    '<rect x="2.5" y="6" width="19" height="12" rx="2.5"/><path d="M6.5 10h.1M10 10h.1M13.5 10h.1M17 10h.1M8 14h8"/>',
  left: '<path class="f" d="M7 12 15.5 6.5v11z"/>',
  lift:
    '<path d="M4 20.5h16M7.5 16.5v-3.2A3.3 3.3 0 0 1 10.8 10h2.4a3.3 3.3 0 0 1 3.3 3.3v3.2Z"/><path d="M12 7V2.5M12 2.5 9.5 5M12 2.5 14.5 5"/>',
  link:
    '<path d="M10 14a4 4 0 0 0 5.7 0l3-3A4 4 0 0 0 13 5.3l-1.2 1.2M14 10a4 4 0 0 0-5.7 0l-3 3a4 4 0 0 0 5.7 5.7l1.2-1.2"/>',
  list:
    '<path d="M9 6h11M9 12h11M9 18h11"/><circle class="f" cx="4.8" cy="6" r="1.4"/><circle class="f" cx="4.8" cy="12" r="1.4"/><circle class="f" cx="4.8" cy="18" r="1.4"/>',
  message: '<path d="M4 5.5h16v11H10.5l-4 3.500v-3.500H4Z"/>',
  microphone: '<rect x="9" y="3.5" width="6" height="10.5" rx="3"/><path d="M5.5 11.5a6.5 6.5 0 0 0 13 0M12 18v3"/>',
  moon: '<path d="M19.5 14.5A8 8 0 0 1 9.5 4.5a8 8 0 1 0 10 10Z"/>',
  more:
    '<circle class="f" cx="5.5" cy="12" r="1.8"/><circle class="f" cx="12" cy="12" r="1.8"/><circle class="f" cx="18.5" cy="12" r="1.8"/>',
  move:
    '<path d="M12 3.5v17M3.5 12h17M12 3.5 9.8 5.7M12 3.5l2.2 2.2M12 20.5l-2.2-2.2M12 20.5l2.2-2.2M3.5 12l2.2-2.2M3.5 12l2.2 2.2M20.5 12l-2.2-2.2M20.5 12l-2.2 2.2"/>',
  muted: '<path d="M4 9.5v5h3.5l4.5 4v-13l-4.5 4Z"/><path d="m16 9.5 5 5M21 9.5l-5 5"/>',
  nextLine: '<path d="M4 6.5h9a4 4 0 0 1 4 4V17M13.5 13.8 17 17.3l3.5-3.5"/><path d="M4 12h5M4 17.5h5"/>',
  octagon: '<path d="M8.3 3.5h7.4l4.8 4.8v7.4l-4.8 4.8H8.3l-4.8-4.8V8.3Z"/>',
  open:
    '<path d="M3.5 18.5v-12A1.5 1.5 0 0 1 5 5h4.5l2 2.5H18a1.5 1.5 0 0 1 1.5 1.5v1.5"/><path d="M3.5 18.5 6 10.5h15l-2.5 8Z"/>',
  pad:
    '<rect x="9" y="3" width="6" height="6" rx="1.5"/><rect x="9" y="15" width="6" height="6" rx="1.5"/><rect x="3" y="9" width="6" height="6" rx="1.5"/><rect x="15" y="9" width="6" height="6" rx="1.5"/>',
  pause: '<path d="M9 6v12M15 6v12" stroke-width="3"/>',
  pen:
    '<path d="m4 20 1.2-4.5L16 4.7a1.8 1.8 0 0 1 2.6 0l.7.7a1.8 1.8 0 0 1 0 2.6L8.5 18.8Z"/><path d="m13.8 7 3.2 3.2"/>',
  picture:
    '<path d="M4 8.5A1.5 1.5 0 0 1 5.5 7H8l1.5-2.5h5L16 7h2.5A1.5 1.5 0 0 1 20 8.5v9a1.5 1.5 0 0 1-1.5 1.5h-13A1.5 1.5 0 0 1 4 17.5Z"/><circle cx="12" cy="13" r="3.3"/>',
  pin: '<path d="M9 3.5h6l-.8 6 3.3 3.5h-11l3.3-3.5ZM12 13v7.5"/>',
  plate: '<path d="M3 19.5h18M6 16h12"/><path d="M12 3.5v8M9 8.8l3 3 3-3"/>',
  playground:
    '<path d="M3 16.5 8.5 5h12L15 16.5Z"/><path d="M3 16.5V19h12v-2.5M15 19l5.5-11V5"/><path d="M8.7 13.2c1.2-2.7 3-1.8 4-2.7s.6-2.3 2.3-2.4"/>',
  plug: '<path d="M9 3.5v4M15 3.5v4M6.5 7.5h11v3.2a5.5 5.5 0 0 1-11 0ZM12 16.2V20.5"/>',
  plugin:
    '<path d="M9 5.5V4a2 2 0 0 1 4 0v1.5h4.500A1.5 1.5 0 0 1 19 7v4h1a2 2 0 0 1 0 4h-1v3.5a1.5 1.5 0 0 1-1.5 1.5h-11A1.5 1.5 0 0 1 5 18.5V7a1.5 1.5 0 0 1 1.5-1.5Z"/>',
  post: '<ellipse cx="12" cy="6" rx="7" ry="2.7"/><path d="M5 6v12c0 1.5 3.1 2.7 7 2.7s7-1.2 7-2.7V6"/>',
  program:
    '<rect x="3" y="4" width="11" height="6.5" rx="2"/><rect x="8" y="13.5" width="13" height="6.5" rx="2"/><path d="M17.5 7.2h1.2A2.3 2.3 0 0 1 21 9.5v.7M3 13.5v1.5a2 2 0 0 0 2 2"/>',
  rectangle: '<rect x="3.5" y="6" width="17" height="12" rx="1.5"/>',
  redo: '<path d="m15.5 5 4 4-4 4"/><path d="M19.5 9H10a5.5 5.5 0 0 0 0 11h3.5"/>',
  remote:
    '<rect x="7.5" y="8" width="9" height="13.5" rx="2.5"/><circle class="f" cx="12" cy="12.3" r="1.5"/><path d="M10.5 17h3M8.8 4.8a4.6 4.6 0 0 1 6.4 0M6.6 2.8a7.7 7.7 0 0 1 10.8 0"/>',
  remove: '<path d="M4.5 7h15M9.5 7V4.5h5V7M6.5 7l1 12a1.5 1.5 0 0 0 1.5 1.5h6a1.5 1.5 0 0 0 1.5-1.5l1-12"/>',
  reset: '<path d="M4.5 12a7.5 7.5 0 1 0 2.4-5.5M4 4.5v4.2h4.2"/>',
  right: '<path class="f" d="M17 12 8.5 6.5v11z"/>',
  robot:
    '<path d="M5 20V10.5C5 6.4 8 4 12 4s7 2.4 7 6.5V20a1 1 0 0 1-1 1H6a1 1 0 0 1-1-1Z"/><path class="f" d="M12 6.2l1.7 2.3h-3.4zM12 15.8l1.7-2.3h-3.4zM7.8 11l2.1-1.6v3.2zM16.2 11l-2.1-1.6v3.2z"/><path d="M9.5 18h5"/>',
  run: '<path class="f" d="M8 5.6v12.8a1 1 0 0 0 1.54.84l9.8-6.4a1 1 0 0 0 0-1.68l-9.8-6.4A1 1 0 0 0 8 5.6Z"/>',
  save: '<path d="M12 4v11M7.5 11l4.5 4.5 4.5-4.5M4.5 19.5h15"/>',
  screen: '<rect x="3" y="4.5" width="18" height="12" rx="1.5"/><path d="M12 16.5v3.500M8 20h8"/>',
  search: '<circle cx="10.5" cy="10.5" r="6.5"/><path d="m15.5 15.5 5 5"/>',
  select: '<path d="m5 4 5.5 15 2.3-6.2L19 10.5Z"/>',
  share:
    '<circle cx="6.5" cy="12" r="2.5"/><circle cx="17" cy="6" r="2.5"/><circle cx="17" cy="18" r="2.5"/><path d="m8.7 10.8 6.1-3.5M8.7 13.2l6.1 3.5"/>',
  sliders:
    '<path d="M4 7h8M16.5 7H20M4 17h3.5M12 17h8"/><circle cx="14.2" cy="7" r="2.2"/><circle cx="9.8" cy="17" r="2.2"/>',
  sound:
    '<path d="M4 9.5v5h3.5L12 18.5v-13L7.5 9.5Z"/><path d="M15.5 9a4.2 4.2 0 0 1 0 6M18 6.5a7.8 7.8 0 0 1 0 11"/>',
  star: '<path class="f" d="m12 3.500 2.600 5.400 5.900.8-4.300 4.100 1.100 5.900-5.300-2.900-5.300 2.900 1.100-5.900-4.300-4.100 5.900-.8Z"/>',
  starEmpty: '<path d="m12 3.500 2.600 5.400 5.900.8-4.300 4.100 1.100 5.900-5.300-2.900-5.300 2.900 1.100-5.900-4.300-4.100 5.900-.8Z"/>',
  starOff: '<path d="m12 4 2.4 5 5.6.7-4.100 3.800 1.100 5.500-5-2.800-5 2.800 1.100-5.500L4 9.7 9.600 9Z"/>',
  step: '<path d="M6 6.5v11l8-5.5zM18 6v12"/>',
  stop: '<rect class="f" x="6" y="6" width="12" height="12" rx="2.5"/>',
  sun:
    '<circle cx="12" cy="12" r="4"/><path d="M12 2.5v2.5M12 19v2.5M2.5 12H5M19 12h2.5M5.3 5.3 7 7M17 17l1.7 1.7M18.7 5.3 17 7M7 17l-1.7 1.7"/>',
  tap:
    '<path d="M10 20.5 7 16a1.6 1.6 0 0 1 2.5-1.9l1 1V8.5a1.5 1.5 0 0 1 3 0v4.3l3.8.9a2 2 0 0 1 1.5 2.3l-.8 4.5"/><path d="M7.5 8a4.5 4.5 0 0 1 9 0M12 1.8v.4"/>',
  text: '<path d="M4 6h16M4 11h10M4 16h13M4 21h7"/>',
  tilt:
    '<path d="M3 19.5h18"/><path d="m5.2 15.8 1.7-6.3a2.5 2.5 0 0 1 3.1-1.8l5.3 1.4a2.5 2.5 0 0 1 1.8 3.1l-1 3.6"/><path d="M18.5 9.5a8 8 0 0 0-4-5M14 7.2l.4-2.8 2.8.5"/>',
  top: '<rect x="4" y="4" width="16" height="16" rx="3"/><circle class="f" cx="12" cy="12" r="2.2"/>',
  track: '<path d="M4 19c0-9 5-3 8-7s1-8 8-7.5" stroke-width="3.5"/>',
  turn: '<path d="M19.5 12A7.5 7.5 0 1 1 15 5.1M15.5 2.5V6H12"/>',
  uShape: '<path d="M5 4.5v15h14v-15h-4.5v10h-5v-10Z"/>',
  undo: '<path d="M8.5 5 4.5 9l4 4"/><path d="M4.5 9H14a5.5 5.5 0 0 1 0 11h-3.5"/>',
  vpl:
    '<rect x="3" y="7" width="7" height="10" rx="2"/><rect x="14" y="7" width="7" height="10" rx="2"/><path d="M10 12h4"/>',
  wall: '<rect x="3" y="6" width="18" height="12" rx="1.5"/><path d="M3 12h18M9 6v6M15 6v6M6 12v6M12 12v6M18 12v6"/>',
  warmth: '<path d="M10 14.2V5.5a2 2 0 0 1 4 0v8.7a4 4 0 1 1-4 0Z"/><path d="M12 10v6"/>',
  warning: '<path d="M12 4 2.8 19.5h18.4Z"/><path d="M12 10v4.5"/><circle class="f" cx="12" cy="17" r="1.1"/>',
});

/** @typedef {keyof typeof DRAWINGS} IconName */

/**
 * @param {IconName} name
 * @param {{ small?: boolean }} [how]  small: 20 px, as on the stage
 * @returns {SVGSVGElement}
 */
export function icon(name, { small = false } = {}) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  svg.setAttribute("class", small ? "ic s" : "ic");
  svg.innerHTML = DRAWINGS[name];
  return svg;
}
