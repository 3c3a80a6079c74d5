"""The Aseba side of a robot: memory layout, bindings to sensors and actuators, events, firmware and programs.

It depends neither on ROS nor on the world.
"""
