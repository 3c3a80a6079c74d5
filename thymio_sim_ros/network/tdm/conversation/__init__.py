"""What a Thymio Device Manager says to its clients and to the nodes, without I/O."""
