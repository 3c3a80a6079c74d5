"""The folder for PYTHONPATH; see `course_packages`."""
