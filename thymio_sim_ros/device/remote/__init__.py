"""A robot behind an Aseba network in place of a simulated device: a real Thymio, a playground, a server of ours."""
