# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's own files: what git would clone, or everything but build output where git is not at hand."""

import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_NOT_OURS = {".git", "build", "demo_output", "__pycache__", ".cache", ".hypothesis", ".pytest_cache", ".ruff_cache"}
_BINARY = {".gpkg", ".png", ".tif"}


def files(*folders, suffixes=None):
    """Paths of the project's files, those under `folders` and with one of `suffixes` if given."""
    for path in _all():
        relative = path.relative_to(ROOT)
        if folders and relative.parts[0] not in folders and str(relative.parent) not in folders:
            continue
        if suffixes is None or path.suffix in suffixes:
            yield path


def texts():
    """(path relative to the root, text) of every text file."""
    for path in files():
        if path.suffix not in _BINARY:
            yield path.relative_to(ROOT), path.read_text(encoding="utf-8")


def _all():
    listed = None
    if (ROOT / ".git").exists() and shutil.which("git"):
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=ROOT, capture_output=True, text=True, check=False)
    if listed is not None and listed.returncode == 0:
        paths = [ROOT / name for name in listed.stdout.split("\0") if name]
    else:
        paths = [p for p in ROOT.rglob("*") if not any(
            part in _NOT_OURS or part.startswith("build-") for part in p.relative_to(ROOT).parts)]
    return sorted(path for path in paths if path.is_file() and not path.name.endswith(".aux.xml"))
