"""The targets, by the part of the project that reads."""
