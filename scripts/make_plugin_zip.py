# SPDX-License-Identifier: GPL-3.0-or-later
"""Zip the staged plugin as the QGIS plugin repository takes it: make_plugin_zip.py <staged plugin folder> <out folder>.

One top folder, pure Python: no byte code, no hidden files, no binaries, no link to the core. Same bytes for the same files.
"""

import configparser
import sys
import zipfile
from pathlib import Path

REFUSED = {".bat", ".cmd", ".dll", ".dylib", ".exe", ".ps1", ".pyd", ".sh", ".so"}  # by the repository's rules
EPOCH = (2020, 1, 1, 0, 0, 0)


def wanted(stage):
    for path in sorted(stage.rglob("*")):
        relative = path.relative_to(stage)
        linked = any((stage / parent).is_symlink() for parent in (relative, *relative.parents))
        if path.is_dir() or linked or "__pycache__" in relative.parts or path.suffix == ".pyc":
            continue
        if path.suffix in REFUSED or path.name.startswith("."):
            raise SystemExit(f"{relative} may not be in a plugin zip: no hidden files, none of {sorted(REFUSED)}")
        yield path


def main():
    stage, out = Path(sys.argv[1]), Path(sys.argv[2])
    metadata = configparser.ConfigParser(interpolation=None)
    metadata.read(stage / "metadata.txt", encoding="utf-8")
    files = list(wanted(stage))
    out.mkdir(parents=True, exist_ok=True)
    target = out / f"{stage.name}-{metadata['general']['version']}.zip"
    part = target.with_suffix(".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in files:
            entry = zipfile.ZipInfo(f"{stage.name}/{path.relative_to(stage).as_posix()}", EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, path.read_bytes())
    part.replace(target)
    print(target)


if __name__ == "__main__":
    main()
