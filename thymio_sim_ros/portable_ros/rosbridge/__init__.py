"""The transport of the graph by which nodes of this process are members of a remote graph: rosbridge (v2)."""
