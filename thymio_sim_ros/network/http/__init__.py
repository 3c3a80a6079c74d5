"""HTTP access to Aseba nodes, with the routes and forms of the program asebahttp (docs/networks.md).

requests    path and body -> action
programs    the text of a file -> programs for nodes
replies     values -> JSON forms
gateway     actions and messages of nodes -> replies and events; without input and output
cors        headers for pages of other origins
server      aiohttp (imported only by the thread of the networks: that takes a third of a second)
"""
