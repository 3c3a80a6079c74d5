"""Grading of a class: every submission is tested in a sandbox of its own (docs/grading-a-class.md).

`submissions.py` finds the submissions, `assignment.py` reads tests, files and limits, `grader.py` runs the sandboxes,
`sandbox/` is the only code beside a submission, `reports/` writes the results.
"""
