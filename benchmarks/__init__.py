"""Benchmarks: one module for each, run by `python -m benchmarks` (docs/performance-method.md)."""
