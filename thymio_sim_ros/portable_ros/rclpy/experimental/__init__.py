"""The events executor."""
