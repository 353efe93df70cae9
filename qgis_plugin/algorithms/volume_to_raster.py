# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume to raster: a hidden volume as rasters, as a mesh, and as its largest hiding places."""

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsFeatureSink,
    QgsFields,
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFeatureSink,
    QgsWkbTypes,
)

from .. import parameters as blocks
from ..errors import bad_input
from ..fields import integer_field, number_field
from ..hidden_outputs import add_outputs, write_outputs
from ..rasters import creation_options
from ..styling import style_when_loaded
from ..text import tr
from ..values import given
from .volume_base import VolumeAlgorithm

PLACES = "OUTPUT_PLACES"
COLUMNS = (("area_m2", "area_m2"), ("volume_m3", "volume_m3"), ("depth_m", "depth"))


class VolumeToRaster(VolumeAlgorithm):
    NAME = "volumetoraster"
    TITLE = "Hidden volume to raster"
    SUMMARY = "How deep is the hidden layer, from which height on is a thing seen, and where could it hide best?"
    TAGS = ("volume", "vdb", "hidden", "raster", "thickness", "mesh", "fog", "hiding places", "visibility")

    def initAlgorithm(self, configuration=None):
        sure = QgsProcessingParameterBoolean("SURE", tr("Only places that surely hide"), False, True)
        most = blocks.number("MOST_PLACES", tr("How many hiding places at most"), 20, 1, None, integer=True)
        for parameter in [
            blocks.vdb("INPUT", tr("Hidden volume (.vdb)")),
            blocks.hide_height_parameter(),
            blocks.advanced(sure),
            blocks.advanced(most),
            *blocks.run_block(),
        ]:
            self.add(parameter)
        add_outputs(self)
        table = QgsProcessingParameterFeatureSink(
            PLACES, tr("Largest hiding places"), QgsProcessing.SourceType.TypeVectorPoint
        )
        self.add(table, optional=True, by_default=False)

    def read_input(self, parameters, context, feedback):
        self.path = self.read_path(parameters, "INPUT", context)
        self.options = creation_options(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        hidden = self.open_volume(sightbound.HiddenVolume, self.path, "INPUT", feedback, 50.0)
        results = write_outputs(self, hidden, parameters, context, feedback, 50.0)
        if given(parameters, PLACES):
            results[PLACES] = self._write_places(hidden, parameters, context)
        return results

    def _write_places(self, hidden, parameters, context):
        fields = QgsFields()
        fields.append(integer_field("rank"))
        for name, _ in COLUMNS:
            fields.append(number_field(name))
        crs = QgsCoordinateReferenceSystem.fromWkt(hidden.crs_wkt or "")
        sink, path = self.parameterAsSink(parameters, PLACES, context, fields, QgsWkbTypes.Type.Point, crs)
        if sink is None:
            raise bad_input(PLACES, tr("the layer cannot be written."))
        places = hidden.places(
            self.parameterAsDouble(parameters, "HIDE_HEIGHT", context),
            sure=self.parameterAsBoolean(parameters, "SURE", context),
            most=self.parameterAsInt(parameters, "MOST_PLACES", context),
        )
        for rank, place in enumerate(places, 1):
            feature = QgsFeature(fields)
            feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(*place["deepest"])))
            feature.setAttributes([rank, *(place[key] for _, key in COLUMNS)])
            sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert)
        style_when_loaded(context, path, "places")
        return path
