// Python for CodeMirror: colors, indentation, completion.

import { autocompletion, completeFromList } from "@codemirror/autocomplete";
import { globalCompletion, localCompletionSource, pythonLanguage } from "@codemirror/lang-python";
import { HighlightStyle, indentUnit, LanguageSupport, syntaxHighlighting } from "@codemirror/language";
import { EditorState } from "@codemirror/state";
import { tags } from "@lezer/highlight";

import { completionKeys } from "../editor/completion_keys.js";

/** What nodes use most: methods of a node, and the topics of the robot. */
const NODE_NAMES = [
  "create_publisher", "create_subscription", "create_timer", "create_service", "create_client", "declare_parameter",
  "get_parameter", "get_logger", "get_clock", "destroy_node", "publish", "spin", "init", "shutdown", "linear", "angular",
  "proximity/center", "proximity/left", "proximity/right", "ground/left/reflectance", "ground/right/reflectance", "cmd_vel",
  "buttons/center", "odom", "geometry_msgs.msg", "sensor_msgs.msg", "std_msgs.msg", "rclpy.node", "rclpy.executors",
]; // prettier-ignore

/** Tokens of the design (styles/tokens.css), in both themes. */
const COLORS = HighlightStyle.define([
  { tag: [tags.keyword, tags.definitionKeyword, tags.controlKeyword, tags.operatorKeyword, tags.moduleKeyword], color: "var(--c-key)", fontWeight: "600" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--c-num)" },
  { tag: tags.string, color: "var(--c-ev)" },
  { tag: [tags.function(tags.definition(tags.variableName)), tags.function(tags.variableName), tags.className], color: "var(--c-fn)" },
  { tag: tags.comment, color: "var(--c-com)", fontStyle: "italic" },
  { tag: [tags.variableName, tags.propertyName, tags.self], color: "var(--ink)" },
  { tag: tags.operator, color: "var(--ink-2)" },
]);

export function python() {
  const words = completeFromList(NODE_NAMES.map((label) => ({ label, type: "method" })));
  return [
    new LanguageSupport(pythonLanguage, [syntaxHighlighting(COLORS)]),
    indentUnit.of("    "),
    EditorState.tabSize.of(4),
    autocompletion({ override: [localCompletionSource, globalCompletion, words], icons: false, defaultKeymap: false }),
    completionKeys,
  ];
}
