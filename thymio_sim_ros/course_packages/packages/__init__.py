"""Packages with the names and the content of others; see `course_packages`."""
