# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the core's defaults as JSON: write_defaults.py <file>. The plugin ships the file, so that it can list its
parameters where the core is not installed."""

import json
import sys
from pathlib import Path

import sightbound

text = json.dumps(sightbound.defaults(), indent=2, sort_keys=True, allow_nan=False) + "\n"
Path(sys.argv[1]).write_text(text, encoding="utf-8")
