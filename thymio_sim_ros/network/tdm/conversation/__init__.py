"""The conversation of a Thymio Device Manager with its clients and with the nodes, without I/O."""
