"""ROS nodes that are written on the page and run by the suite, each in a process of its own (SECURITY.md).

who         which visitors may run nodes, and how isolated
same_user   whether a connection of this computer comes from a program of this user
program     what a page sends
process     a running node, seen from the suite
mount       puts them on the ports of a suite
server      the WebSocket of a page, and what it may do
"""
