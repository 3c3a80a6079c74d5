"""Programs under test on an installed ROS 2: its waits and discovery, which are replaced or waited for.

The embedded graph needs none of this: its waits are those of Python, its clocks those of the test, and its endpoints
match at once (`lockstep/graph_link.py`).
"""
