# SPDX-License-Identifier: GPL-3.0-or-later
"""Sightbound in QGIS: a Processing provider on top of the Python package `sightbound`."""


def classFactory(iface):
    """The entry point QGIS calls; `iface` is None in qgis_process."""
    from .plugin import SightboundPlugin

    return SightboundPlugin(iface)
