"""Replaces the package `tf2_msgs` where it is not installed."""
