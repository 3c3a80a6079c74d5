// The generated parser.js, for the type checker.

import type { LRParser } from "@lezer/lr";

export const parser: LRParser;
