"""The sandbox of a submission: a process beside the grader with limits and as much isolation as the platform gives.

`launcher.py` is the process that the grader starts. It enters the isolation (`namespaces.py`), and
supervises test processes (`supervisor.py`), which have no rights (`confinement.py`, `landlock.py`). Linux only.
"""
