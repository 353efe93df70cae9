# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the compiled core, and refuses it where it would crash: two versions of GDAL cannot live in one process."""

from __future__ import annotations

import os
import sys

# GDAL brings a hundred libraries. Binding their functions when first called saves a tenth of the time to import.
_flags = sys.getdlopenflags() if hasattr(os, "RTLD_LAZY") else None
try:
    if _flags is not None:
        sys.setdlopenflags(os.RTLD_LAZY)
    from . import _core as core
except ImportError as error:
    raise ImportError(
        f"The compiled part of sightbound cannot be loaded by Python {sys.version.split()[0]} ({error}). "
        f"Build it with the interpreter that is to use it: cmake -DPython_EXECUTABLE={sys.executable or 'python3'}"
    ) from error
finally:
    if _flags is not None:
        sys.setdlopenflags(_flags)


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

__all__ = ["core"]
