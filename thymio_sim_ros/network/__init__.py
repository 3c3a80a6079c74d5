"""Servers by which other programs reach the robots, independent of ROS: one thread with one event loop.

hub            networks of nodes and their clients, which exchange Aseba messages
aseba_server   the Aseba protocol on TCP ports
announcement   service announcements by mDNS
thread         the thread of the event loop, and what it serves
settings       what is served, and where

Source: docs/spec/aseba-protocol.md.
"""
