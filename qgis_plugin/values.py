# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads single parameter values: what was given, what was left empty, and numbers that vary by feature."""

from qgis.core import QgsFeature, QgsProcessingFeatureSourceDefinition, QgsProperty
from qgis.PyQt.QtCore import QVariant

from .errors import bad_input
from .text import tr


def is_null(value):
    return value is None or (isinstance(value, QVariant) and value.isNull())


def given(parameters, name):
    """Was anything said for this parameter? The dialog, models and scripts say nothing in different ways."""
    value = parameters.get(name)
    if isinstance(value, QgsProcessingFeatureSourceDefinition):
        value = value.source
    if isinstance(value, QgsProperty) and not is_varying(value):
        value = value.staticValue()
    return not is_null(value) and value != ""


def is_varying(value):
    """Does a field or an expression give this parameter?"""
    return isinstance(value, QgsProperty) and value.propertyType() != QgsProperty.Type.StaticProperty


def number_or_none(algorithm, parameters, name, context):
    return algorithm.parameterAsDouble(parameters, name, context) if given(parameters, name) else None


def word(algorithm, parameters, name, context):
    """The chosen word of an enum; its default when left empty."""
    if not given(parameters, name):
        return algorithm.parameterDefinition(name).defaultValue()
    return algorithm.parameterAsEnumString(parameters, name, context)


class Varying:
    """A number that is the same for all features, or given by a field or an expression.

    `field` is the name of a field that stands in where no expression can be given (qgis_process). NULL, and values
    outside the parameter's limits, are errors that name the feature.
    """

    def __init__(self, algorithm, parameters, name, context, expressions, field=""):
        self.name = name
        self._definition = algorithm.parameterDefinition(name)
        self._expressions = expressions
        self._property = parameters.get(name) if is_varying(parameters.get(name)) else None
        self._constant = None
        if field:
            if self._property is not None:
                raise bad_input(name, tr("is given by an expression and by a field; give one of them."))
            self._property = QgsProperty.fromField(field)
        elif self._property is None:
            self._constant = algorithm.parameterAsDouble(parameters, name, context)
            if not given(parameters, name) and self._definition.defaultValue() is None:
                self._constant = None
        if self._property is not None:
            self._property.prepare(expressions)

    @property
    def varies(self):
        return self._property is not None

    def value(self, feature, label):
        """The number for `feature`, which messages call `label`."""
        if self._property is None:
            return self._constant
        self._expressions.setFeature(feature if feature is not None else QgsFeature())
        found, ok = self._property.value(self._expressions)
        if not ok or is_null(found):
            remedy = tr("fill it in, select other features, or give one number for all.")
            raise bad_input(self.name, tr("is NULL for {}; {}").format(label, remedy))
        try:
            found = float(found)
        except (TypeError, ValueError):
            raise bad_input(self.name, tr("is no number for {}: {!r}.").format(label, found)) from None
        low, high = self._definition.minimum(), self._definition.maximum()
        if not low <= found <= high:
            raise bad_input(
                self.name, tr("is {:g} for {}, allowed is {:g} to {:g}.").format(found, label, low, high)
            )
        return found
