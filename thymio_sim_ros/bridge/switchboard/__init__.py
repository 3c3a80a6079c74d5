"""The switchboard: state and decisions of the bridge, without sockets, clocks or threads.

switchboard           connected clients and their roles; dispatch of messages and commands
subscriptions         channels of the data source and their subscribers
retained_messages     last messages of channels, for new subscribers
client_channels       channels on which clients publish
services, parameters  what the data source offers, and requests for it
graph_subscriptions   the connection graph and its subscribers
client_state          the state of one client, with its pending requests
events, outcome       inputs and outputs: events, commands, deliveries
"""
