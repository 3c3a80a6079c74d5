"""Servers by which other programs reach the robots, and the link to a real robot, independent of ROS.

hub            networks of nodes and their clients, which exchange Aseba messages
aseba_server   the Aseba protocol on TCP ports
announcement   service announcements by mDNS
robot_link     the stream to a real robot, in a thread of its own; robot_target has its address
thread         the thread of the event loop, and what it serves
settings       what is served, and where

Source: docs/spec/aseba-protocol.md.
"""
