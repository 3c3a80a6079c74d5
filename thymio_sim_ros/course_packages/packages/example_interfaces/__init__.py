"""Replaces the package `example_interfaces` where it is not installed: its types can be imported, but not used."""
