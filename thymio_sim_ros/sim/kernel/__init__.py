"""Kernels: loops over the robots of a batch, compiled to WebAssembly if wasmtime is installed (docs/performance.md)."""
