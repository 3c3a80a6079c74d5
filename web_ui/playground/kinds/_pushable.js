// Fields that pushable objects share; not a kind.

import { optional, RULES } from "../rules.js";

/** An object is movable if it has a mass. */
export const PUSHABLE = {
  mass_kg: optional(RULES.mass, null),
  friction: optional(RULES.friction, 0.25),
  restitution: optional(RULES.restitution, 0.1),
};
