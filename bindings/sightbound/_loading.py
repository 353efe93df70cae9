# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the compiled core, and refuses it where it would crash: two versions of GDAL cannot live in one process."""

from __future__ import annotations

import importlib
import os
import sys
from types import ModuleType



def _load(name: str) -> ModuleType:
    """Imports a compiled module. GDAL and OpenVDB bring a hundred libraries: binding their functions when first called
    saves a tenth of the time."""
    flags = sys.getdlopenflags() if hasattr(os, "RTLD_LAZY") else None
    try:
        if flags is not None:
            sys.setdlopenflags(os.RTLD_LAZY)
        return importlib.import_module(f"{__package__}.{name}")
    except ImportError as error:
        raise ImportError(
            f"The compiled part {name} of sightbound cannot be loaded by Python {sys.version.split()[0]} ({error}). "
            f"Install the library that is missing, or build sightbound with the interpreter that is to use it: cmake -DPython_EXECUTABLE={sys.executable or 'python3'}"
        ) from error
    finally:
        if flags is not None:
            sys.setdlopenflags(flags)


TYPE_CHECKING = False
if TYPE_CHECKING:
    from . import _core as core
else:
    core = _load("_core")


def volume_core() -> ModuleType:
    """The compiled part that knows OpenVDB, loaded when first asked for: it takes as long as all the rest."""
    return sys.modules.get(f"{__package__}._volume") or _load("_volume")


def _release(version: str) -> list[str]:
    """GDAL keeps its binary interface within these two numbers."""
    return version.split(".")[:2]


def _refuse_other_gdal() -> None:
    compiled, loaded = core.gdal_versions()
    if _release(compiled) != _release(loaded):
        raise ImportError(
            f"sightbound was built for GDAL {compiled}, but this process uses GDAL {loaded}. "
            "Build sightbound again with the GDAL that is installed."
        )
    gdal = sys.modules.get("osgeo.gdal")  # looked at, not imported: who has not loaded it cannot clash with it
    other = getattr(gdal, "__version__", loaded)
    if other != loaded:
        raise ImportError(
            f"sightbound uses GDAL {loaded}, but the module osgeo.gdal in this process uses GDAL {other}. "
            "Install both from one source (the same package manager), so that they share one GDAL library."
        )


_refuse_other_gdal()

__all__ = ["core", "volume_core"]
