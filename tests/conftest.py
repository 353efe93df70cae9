# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the built package and the oracles importable. SIGHTBOUND_BUILD names another build folder than `build`."""
import importlib.util
import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("SIGHTBOUND_BUILD", "build")

sys.path.insert(0, str(ROOT / "tests" / "reference"))
sys.path.insert(0, str(BUILD / "python"))


def pytest_configure(config):
    only_oracles = config.args and all("tests/reference" in str(Path(a).resolve()) for a in config.args)
    if not only_oracles and importlib.util.find_spec("sightbound") is None:
        raise pytest.UsageError(f"the package is not built: {BUILD / 'python' / 'sightbound'} is missing. "
                                "Run scripts/build.sh, or name another build folder in SIGHTBOUND_BUILD.")
