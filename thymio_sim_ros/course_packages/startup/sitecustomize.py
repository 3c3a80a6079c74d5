"""Python imports this module when it starts, if its folder is in PYTHONPATH (`thymio-sim env`).

It adds the folder `packages` as the last place for imports. Then it runs the `sitecustomize` that it hides, if there is
one. It must work in every Python program of a terminal, also where `thymio_sim_ros` is not installed.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import sys


def _main() -> None:
    here = os.path.dirname(os.path.abspath(__file__))
    sys.path.append(os.path.join(os.path.dirname(here), "packages"))
    others = [place for place in sys.path if os.path.abspath(place) != here]
    spec = importlib.machinery.PathFinder.find_spec("sitecustomize", others)
    if spec is not None and spec.loader is not None:
        hidden = importlib.util.module_from_spec(spec)
        sys.modules["sitecustomize"] = hidden
        spec.loader.exec_module(hidden)


_main()
