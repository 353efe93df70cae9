# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the Processing provider, with a window or without one."""

from qgis.core import QgsApplication

from .provider import SightboundProvider


class SightboundPlugin:
    def __init__(self, iface):
        self.iface = iface
        self.provider = None

    def initProcessing(self):
        """qgis_process calls only this."""
        if self.provider is None:
            self.provider = SightboundProvider()
            QgsApplication.processingRegistry().addProvider(self.provider)
            # A model finds the algorithms it is made of only when their provider is registered.
            self.provider.refreshAlgorithms()

    def initGui(self):
        self.initProcessing()

    def unload(self):
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
