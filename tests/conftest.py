"""What holds for every test: no test is judged by how long it took."""

from __future__ import annotations

import hypothesis

hypothesis.settings.register_profile("thymio", deadline=None)
hypothesis.settings.load_profile("thymio")
