// The breakpoint gutter and the marker of the current line. Both move with edits.

import { RangeSet, StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, gutter, GutterMarker } from "@codemirror/view";

/** @typedef {import("@codemirror/state").EditorState} EditorState */
/** @typedef {{ line: number, fault: boolean } | null} Place  line counted from 1 */

/** @type {import("@codemirror/state").StateEffectType<number[]>} */
const setLines = StateEffect.define();
/** @type {import("@codemirror/state").StateEffectType<Place>} */
const setPlace = StateEffect.define();

class BreakpointMarker extends GutterMarker {
  /** @override */
  toDOM() {
    const mark = document.createElement("span");
    mark.className = "breakpoint";
    return mark;
  }
}
const MARKER = new BreakpointMarker();

/** @type {StateField<RangeSet<GutterMarker>>} */
export const breakpointField = StateField.define({
  create: () => RangeSet.empty,
  toJSON: (_set, state) => breakpointLines(state),
  fromJSON: (lines, { doc }) => markersAt(doc, lines),
  update(set, transaction) {
    let now = set.map(transaction.changes);
    for (const effect of transaction.effects) {
      if (effect.is(setLines)) now = markersAt(transaction.state.doc, effect.value);
    }
    return now;
  },
});

/** @param {import("@codemirror/state").Text} doc @param {readonly number[]} wanted  line numbers from 1 */
function markersAt(doc, wanted) {
  const lines = [...new Set(wanted)].filter((line) => line >= 1 && line <= doc.lines);
  lines.sort((one, other) => one - other);
  return RangeSet.of(lines.map((line) => MARKER.range(doc.line(line).from)));
}

/** @type {StateField<import("@codemirror/view").DecorationSet>} */
const placeField = StateField.define({
  create: () => Decoration.none,
  update(decorations, transaction) {
    let now = decorations.map(transaction.changes);
    for (const effect of transaction.effects) {
      if (!effect.is(setPlace)) continue;
      const { doc } = transaction.state;
      const place = effect.value;
      if (place === null || place.line < 1 || place.line > doc.lines) now = Decoration.none;
      else {
        const line = Decoration.line({ class: place.fault ? "fault-line" : "current-line" });
        now = Decoration.set([line.range(doc.line(place.line).from)]);
      }
    }
    return now;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** @param {(line: number) => void} toggle */
export function breakpointGutter(toggle) {
  return [
    breakpointField,
    placeField,
    gutter({
      class: "breakpoints",
      markers: (view) => view.state.field(breakpointField),
      initialSpacer: () => MARKER,
      domEventHandlers: {
        mousedown(view, line) {
          toggle(view.state.doc.lineAt(line.from).number);
          return true;
        },
      },
    }),
  ];
}

/** Lines with a breakpoint, counted from 1. @param {EditorState} state @returns {number[]} */
export function breakpointLines(state) {
  /** @type {number[]} */ const lines = [];
  state.field(breakpointField).between(0, state.doc.length, (from) => void lines.push(state.doc.lineAt(from).number));
  return [...new Set(lines)];
}

/** @param {EditorView} view @param {number[]} lines */
export function showBreakpoints(view, lines) {
  view.dispatch({ effects: setLines.of(lines) });
}

/**
 * Mark the line at which the program is stopped, and scroll it into view.
 *
 * @param {EditorView} view
 * @param {Place} place
 */
export function showPlace(view, place) {
  const effects = [/** @type {import("@codemirror/state").StateEffect<any>} */ (setPlace.of(place))];
  if (place !== null && place.line >= 1 && place.line <= view.state.doc.lines) {
    effects.push(EditorView.scrollIntoView(view.state.doc.line(place.line).from, { y: "nearest", yMargin: 40 }));
  }
  view.dispatch({ effects });
}
