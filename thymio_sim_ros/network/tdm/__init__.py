"""A Thymio Device Manager: the protocol of Thymio Suite for the nodes of our networks."""
