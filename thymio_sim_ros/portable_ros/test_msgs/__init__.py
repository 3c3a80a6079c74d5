"""The module of Python of the package test_msgs; its messages are made from their definitions."""
