# SPDX-License-Identifier: GPL-3.0-or-later
"""Attribute fields, on Qt5 and Qt6 alike."""

from qgis.core import Qgis, QgsField
from qgis.PyQt.QtCore import QMetaType, QVariant


def number_field(name):
    return QgsField(name, QMetaType.Type.Double if _new() else QVariant.Double)


def integer_field(name):
    return QgsField(name, QMetaType.Type.LongLong if _new() else QVariant.LongLong)


def text_field(name):
    return QgsField(name, QMetaType.Type.QString if _new() else QVariant.String)


def add_unique(fields, make, name):
    """Appends a field, numbered where there is one of that name."""
    unique, count = name, 1
    while fields.lookupField(unique) >= 0:
        count += 1
        unique = f"{name}_{count}"
    fields.append(make(unique))


def _new():
    """From 3.38 on fields are made with QMetaType; QVariant's own types are gone in Qt6."""
    return Qgis.QGIS_VERSION_INT >= 33800
