"""Servers for programs of the Aseba world."""
