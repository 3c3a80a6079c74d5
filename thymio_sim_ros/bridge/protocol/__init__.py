"""The Foxglove WebSocket protocol (docs/spec/foxglove.md): constants, messages as values, and their encoding."""
