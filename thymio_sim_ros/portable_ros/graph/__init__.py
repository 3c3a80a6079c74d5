"""The graph of the process: which endpoints there are, which of them match, and what waits to be executed."""
