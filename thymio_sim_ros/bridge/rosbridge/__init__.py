"""The rosbridge protocol without I/O and without ROS (docs/rosbridge.md).

frames         operations as JSON or CBOR, and what a server sends
bounded_cbor   decoding of untrusted CBOR at a bounded cost
operations     the fields of each operation, and their checks
fragments      messages in several parts
pace           the throttle and the queue of a subscription
"""
