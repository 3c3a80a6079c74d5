"""The sandbox of a submission: a process beside the grader with limits and as much isolation as the platform gives.

`launcher.py` is the process that the grader starts. It supervises test processes (`supervisor.py`) in a place
(`place.py`), whose processes it follows (`processes.py`). On Linux (`linux/`) it enters the isolation first, and test
processes have no rights. Other systems have `portable_place.py`, with `tracked_processes.py` or, on Windows,
`job_object.py`.
"""
