"""The suite on another computer: `make windows-test`, `make arm64-test` (docs/platforms.md)."""
