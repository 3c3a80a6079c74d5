"""Fuzzing of every reader of bytes that the project did not write itself (docs/reliability.md)."""
