"""The packages of messages and services: their definitions, classes, serialized form and type hashes."""
