"""The Foxglove WebSocket protocol: its constants, its messages as values, and their encoding (docs/spec/foxglove.md)."""
