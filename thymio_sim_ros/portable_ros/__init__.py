"""The public API of rclpy and the packages of messages in pure Python, for the nodes of one process.

`rclpy/` has one module for each module of rclpy, `messages/` makes the packages of messages from their definitions,
`graph/` connects the endpoints of the process. `import_hook` serves them under the names that programs import.
"""
