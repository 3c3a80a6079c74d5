"""Kernels: loops over many robots that are compiled where that is possible (docs/performance.md)."""
