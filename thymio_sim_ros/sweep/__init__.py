"""Sweeps: every program in every playground with every value of the parameters and every seed (docs/sweeps.md).

`description.py` is what a file says, `grid.py` the runs that it means, `run.py` one of them as a pure function,
`measures.py` what it measures, `table.py` the rows in a file. Nothing here starts a process.
"""
