// The Aseba language for CodeMirror: colors, indentation, folding, comments.

import {
  continuedIndent,
  foldNodeProp,
  HighlightStyle,
  indentNodeProp,
  LanguageSupport,
  LRLanguage,
  syntaxHighlighting,
} from "@codemirror/language";
import { styleTags, tags } from "@lezer/highlight";

import { parser } from "./parser.js";

/** @typedef {import("@lezer/common").SyntaxNode} SyntaxNode */
/** @typedef {import("@codemirror/state").EditorState} EditorState */

/** One level is one tab, as written by `aseba fmt`. */
export const INDENT = "\t";

const WORDS = "if then elseif else end when do while for in step return call callsub emit _emit";

/**
 * The foldable range of a node: from the end of its first line to its last line, without `end`.
 *
 * @param {SyntaxNode} node
 * @param {EditorState} state
 */
function body(node, state) {
  const from = state.doc.lineAt(node.from).to;
  const last = node.lastChild;
  const to = last?.name === "end" ? state.doc.lineAt(last.from).from - 1 : node.to;
  return to > from ? { from, to } : null;
}

/**
 * The indentation of a line behind the last word of the program: it belongs to the section before it.
 *
 * @param {import("@codemirror/language").TreeIndentContext} context
 */
function indentBehind({ node, pos, textAfter, unit }) {
  const before = node.childBefore(pos)?.name;
  const isInSection = before === "Handler" || before === "Subroutine";
  return isInSection && !/^\s*(onevent|sub)\b(?!\.)/.test(textAfter) ? unit : 0;
}

const BLOCK = continuedIndent({ except: /^\s*(end|else|elseif)\b(?!\.)/ });
const SECTION = continuedIndent({ except: /^\s*(onevent|sub)\b(?!\.)/ });

export const asebaLanguage = LRLanguage.define({
  name: "aseba",
  parser: parser.configure({
    props: [
      styleTags({
        [WORDS]: tags.controlKeyword,
        "onevent sub var const": tags.definitionKeyword,
        "and or not abs": tags.operatorKeyword,
        Number: tags.number,
        "Variable/VariableName/Identifier": tags.variableName,
        "VariableDefinitionName/Identifier": tags.definition(tags.variableName),
        "ConstantDefinitionName/Identifier": tags.definition(tags.constant(tags.variableName)),
        "FunctionName/Identifier": tags.function(tags.variableName),
        "SubroutineName/Identifier": tags.function(tags.variableName),
        "EventName/Identifier": tags.className,
        "ArithmeticOp CompareOp AssignOp/... CompoundOp StepOp": tags.operator,
        LineComment: tags.lineComment,
        BlockComment: tags.blockComment,
        "( )": tags.paren,
        "[ ]": tags.squareBracket,
      }),
      indentNodeProp.add({
        "IfStatement WhenStatement WhileStatement ForStatement ElseClause ElseifClause": BLOCK,
        "Handler Subroutine": SECTION,
        Program: indentBehind,
      }),
      foldNodeProp.add({ "IfStatement WhenStatement WhileStatement ForStatement Handler Subroutine": body }),
      foldNodeProp.add({ BlockComment: ({ from, to }) => ({ from: from + 2, to: to - 2 }) }),
    ],
  }),
  languageData: {
    commentTokens: { line: "#", block: { open: "#*", close: "*#" } },
    indentOnInput: /^\s*(end|else|elseif|onevent|sub)$/,
    wordChars: "._",
    closeBrackets: { brackets: ["(", "["] },
  },
});

/** Tokens of the design (styles/tokens.css), in both themes. */
const COLORS = HighlightStyle.define([
  { tag: [tags.controlKeyword, tags.definitionKeyword, tags.operatorKeyword], color: "var(--c-key)", fontWeight: "600" },
  { tag: tags.number, color: "var(--c-num)" },
  { tag: tags.variableName, color: "var(--ink)" },
  { tag: tags.constant(tags.variableName), color: "var(--c-num)" },
  { tag: tags.function(tags.variableName), color: "var(--c-fn)" },
  { tag: tags.className, color: "var(--c-ev)" },
  { tag: tags.operator, color: "var(--ink-2)" },
  { tag: tags.comment, color: "var(--c-com)", fontStyle: "italic" },
]);

export function aseba() {
  return new LanguageSupport(asebaLanguage, [syntaxHighlighting(COLORS)]);
}
