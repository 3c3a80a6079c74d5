"""Messages of the Thymio Device Manager and their encoding, without I/O."""
