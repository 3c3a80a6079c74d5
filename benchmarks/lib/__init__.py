"""What several benchmarks use; modules in this folder are no benchmarks."""
