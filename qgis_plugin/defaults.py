# SPDX-License-Identifier: GPL-3.0-or-later
"""The defaults of the core, as the build wrote them to defaults.json: parameters can be listed without the core."""

import json
from functools import lru_cache
from pathlib import Path


@lru_cache(maxsize=None)
def _values():
    return json.loads((Path(__file__).parent / "defaults.json").read_text(encoding="utf-8"))


def default(name):
    """The default of one of the core's arguments, under the name it has in Python."""
    return _values()[name]
