"""Example nodes for courses: short models that students read and change, each complete in one file.

They use topics only and know nothing of the simulator, so they run with a real robot and its driver as well
(docs/course-nodes.md lists them, with the commands that start them).
"""
