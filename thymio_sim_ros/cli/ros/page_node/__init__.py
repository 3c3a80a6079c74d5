"""The processes of a node of the page (`page_nodes/`): `supervisor.py` isolates and limits `program.py`.

Both are started by their names; nothing imports them.
"""
