# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the compiled core, the Python package `sightbound`, and refuses one that does not fit.

It is looked for in the plugin's own folder, then among the installed packages, and always imported under the one
name `sightbound`, so that a process never holds two copies. The core must have the plugin's version (the first two
numbers) and use the same GDAL as QGIS: two GDALs in one process crash it.
"""

import configparser
import importlib
import importlib.util
import re
import sys
from pathlib import Path

from .text import tr

_FOLDER = Path(__file__).parent


class CoreUnavailable(Exception):
    """The core is missing or does not fit; the message says what to do."""


def load():
    """The module `sightbound`; raises CoreUnavailable."""
    module = sys.modules.get("sightbound") or _import()
    _compare_versions(module)
    return module


def problem():
    """Why the algorithms cannot run, or '' if they can."""
    try:
        load()
    except CoreUnavailable as error:
        return str(error)
    return ""


def plugin_version():
    metadata = configparser.ConfigParser(interpolation=None)
    metadata.read(_FOLDER / "metadata.txt", encoding="utf-8")
    return metadata.get("general", "version")


def _import():
    own = _FOLDER / "sightbound" / "__init__.py"
    try:
        if not own.is_file():
            return importlib.import_module("sightbound")
        spec = importlib.util.spec_from_file_location(
            "sightbound", own, submodule_search_locations=[str(own.parent)]
        )
        module = importlib.util.module_from_spec(spec)
        sys.modules["sightbound"] = module
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules["sightbound"]
            raise
        return module
    except ImportError as error:
        raise CoreUnavailable(
            _advice(tr("The Sightbound core is not installed ({}).").format(error))
        ) from error


def _compare_versions(module):
    wanted, found = plugin_version(), module.__version__
    if _first_two(wanted) != _first_two(found):
        raise CoreUnavailable(
            _advice(tr("The Sightbound core is version {}, this plugin needs {}.").format(found, wanted))
        )
    from osgeo import gdal

    own, theirs = module.gdal_version(), gdal.VersionInfo("RELEASE_NAME")
    if _first_two(own) != _first_two(theirs):
        raise CoreUnavailable(
            _advice(tr("The Sightbound core was built for GDAL {}, QGIS uses GDAL {}.").format(own, theirs))
        )


def _first_two(version):
    return re.findall(r"\d+", version)[:2]


def _advice(what):
    how = tr(
        "Install it with: sudo apt install ./sightbound-core_*.deb (or, from a build: cmake --install build)."
    )
    return f"{what} {how} " + tr("Then restart QGIS.")
