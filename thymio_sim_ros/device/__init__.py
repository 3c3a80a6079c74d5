"""An Aseba Thymio: firmware layout, bindings to sensors and actuators, timers, behaviours. No ROS, no world."""
