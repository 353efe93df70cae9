# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume to raster: a hidden volume as rasters, as a mesh, and as its largest hiding places; an error volume as rasters."""

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
    QgsProcessingParameterRasterDestination,
    QgsWkbTypes,
)

from .. import parameters as blocks
from ..errors import bad_input, core_errors
from ..feedback import Progress
from ..fields import integer_field, number_field
from ..hidden_outputs import FOG, RASTERS, TOP, add_outputs, write_outputs
from ..rasters import creation_options
from ..styling import style_when_loaded
from ..text import tr
from ..values import given
from .volume_base import VolumeAlgorithm

PLACES = "OUTPUT_PLACES"
# of error volumes: output, label, argument of write, style
SURFACES = (
    ("OUTPUT_LOWER", "Lowest place of the error volume (m)", "lower", "surface"),
    ("OUTPUT_UPPER", "Highest place of the error volume (m)", "upper", "surface"),
    ("OUTPUT_THICKNESS", "", "thickness", "sigma"),
)
HIDDEN_ONLY = [TOP, FOG, PLACES, *(row[0] for row in RASTERS if row[0] != "OUTPUT_THICKNESS")]
COLUMNS = (("area_m2", "area_m2"), ("volume_m3", "volume_m3"), ("depth_m", "depth"))


class VolumeToRaster(VolumeAlgorithm):
    NAME = "volumetoraster"
    TITLE = "Volume to raster"
    SUMMARY = "Maps of a hidden volume: how deep it is, what it hides. Or of an error volume: its lower and upper surface."
    TAGS = ("volume", "vdb", "hidden", "raster", "thickness", "mesh", "fog", "hiding places", "visibility")

    def initAlgorithm(self, configuration=None):
        sure = QgsProcessingParameterBoolean("SURE", tr("Only places that surely hide"), False, True)
        most = blocks.number("MOST_PLACES", tr("How many hiding places at most"), 20, 1, None, integer=True)
        for parameter in [
            blocks.vdb("INPUT", tr("Hidden volume or error volume (.vdb)")),
            blocks.hide_height_parameter(),
            blocks.confidence_parameter(),
            blocks.advanced(sure),
            blocks.advanced(most),
            *blocks.run_block(),
        ]:
            self.add(parameter)
        add_outputs(self)
        for name, label, *_ in SURFACES[:2]:
            self.add(QgsProcessingParameterRasterDestination(name, tr(label)), True)
        table = QgsProcessingParameterFeatureSink(
            PLACES, tr("Largest hiding places"), QgsProcessing.SourceType.TypeVectorPoint
        )
        self.add(table, optional=True, by_default=False)

    def read_input(self, parameters, context, feedback):
        self.path = self.read_path(parameters, "INPUT", context)
        self.options = creation_options(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        hidden = self._open(sightbound, feedback)
        if not isinstance(hidden, sightbound.HiddenVolume):
            return self._write_surfaces(hidden, parameters, context, feedback)
        self._pass_over(SURFACES[:2], tr("a hidden volume"), parameters, feedback)
        results = write_outputs(self, hidden, parameters, context, feedback, 50.0)
        if given(parameters, PLACES):
            results[PLACES] = self._write_places(hidden, parameters, context)
        return results

    def contradiction(self, parameters, context):
        return self.bad_confidence(parameters, context)

    def _open(self, sightbound, feedback):
        """The volume of either kind; a file that is neither is called no hidden volume."""
        feedback.setProgressText(tr("Reading"))
        with core_errors("INPUT"):
            try:
                return sightbound.HiddenVolume.open(self.path, progress=Progress(feedback, 0.0, 50.0))
            except ValueError as not_hidden:
                try:
                    return sightbound.ErrorVolume.open(self.path, progress=Progress(feedback, 0.0, 50.0))
                except ValueError:
                    raise not_hidden from None

    def _write_surfaces(self, volume, parameters, context, feedback):
        wanted = [row for row in SURFACES if given(parameters, row[0])]
        if not wanted:
            sentence = tr("the file is an error volume, not a hidden volume; it has OUTPUT_LOWER, OUTPUT_UPPER, OUTPUT_THICKNESS.")
            raise bad_input("INPUT", sentence)
        self._pass_over([(name,) for name in HIDDEN_ONLY], tr("an error volume"), parameters, feedback)
        paths = {row[0]: self.parameterAsOutputLayer(parameters, row[0], context) for row in wanted}
        with core_errors("CONFIDENCE", paths={path: name for name, path in paths.items()}):
            volume.write(
                **{row[2]: paths[row[0]] for row in wanted},
                confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
                creation_options=self.options,
                threads=self.threads(parameters, context),
                progress=Progress(feedback, 50.0, 100.0),
            )
        for name, _, _, style in wanted:
            style_when_loaded(context, paths[name], style, 0.98)
        return paths

    def _pass_over(self, rows, kind, parameters, feedback):
        """Says which outputs the volume does not have: the dialog asks for all of them."""
        names = ", ".join(row[0] for row in rows if given(parameters, row[0]))
        if names:
            feedback.pushInfo(tr("INPUT is {}; it has no {}.").format(kind, names))

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
