"""Many independent tasks on all cores of a machine, or on a cluster of machines (docs/sweeps.md).

`engine.py` needs the extra `sweep`; the rest is without dependencies.
"""
