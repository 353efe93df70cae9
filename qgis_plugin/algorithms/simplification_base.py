# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms of the group Simplification have in common."""

from ..text import tr
from .base import SightboundAlgorithm


class SimplificationAlgorithm(SightboundAlgorithm):
    def group(self):
        return tr("Simplification")

    def groupId(self):
        return "simplification"
