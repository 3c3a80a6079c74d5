// What things that stand have in common; not a kind of its own.

import { optional, RULES } from "../rules.js";

/** Movable when there is a mass. */
export const PUSHABLE = {
  mass_kg: optional(RULES.mass, null),
  friction: optional(RULES.friction, 0.25),
  restitution: optional(RULES.restitution, 0.1),
};
