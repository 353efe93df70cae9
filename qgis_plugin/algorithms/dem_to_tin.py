# SPDX-License-Identifier: GPL-3.0-or-later
"""DEM to TIN: few triangles that stay within the terrain's error, or within a tolerance, at every place."""

from qgis.core import QgsProcessing, QgsProcessingParameterBoolean

from .. import parameters as blocks
from ..error_block import check_error_block, read_error_block
from ..feedback import Progress
from ..observers import HEIGHTS, read_points
from ..places_on_dem import distances_from, lines_in, places, read_places, samples_in
from ..rasters import open_dem, read_extent, read_raster
from ..text import tr
from ..values import given, number_or_none, word
from .simplification_base import TinMaker


class DemToTin(TinMaker):
    NAME = "demtotin"
    TITLE = "DEM to TIN"
    SUMMARY = "How few triangles can carry this terrain without leaving its error, or a tolerance, anywhere?"
    TAGS = ("tin", "mesh", "triangulation", "simplify", "decimate", "tolerance", "error", "dem", "raster", "terrain")
    NUMBERS = (
        ("TRIANGLES_BEFORE", "Triangles of the elevation model", "faces_before"),
        ("TRIANGLES", "Triangles of the TIN", "faces_after"),
        ("LARGEST_DEVIATION", "Largest deviation anywhere (m)", "largest_deviation"),
        ("LARGEST_RATIO", "Largest share of the tolerance that is used", "largest_ratio"),
    )

    def initAlgorithm(self, configuration=None):
        border = QgsProcessingParameterBoolean(
            "KEEP_BORDER", tr("Keep all samples of the outline (tiles that fit)"), False, True
        )
        lines = places("BREAK_LINES", tr("Break lines: edges of the TIN"), QgsProcessing.SourceType.TypeVectorLine)
        stray = blocks.metres("BREAK_LINE_TOLERANCE", tr("How far edges may stray from break lines (m; empty: a cell)"))
        outline = blocks.metres("BORDER_TOLERANCE", tr("How far the outline may move in plan (m; empty: not at all)"))
        for parameter in (
            blocks.dem_block()
            + [
                blocks.metres("TOLERANCE", tr("Tolerance in metres (empty: the error below)")),
                blocks.advanced(blocks.raster("TOLERANCE_RASTER", tr("Tolerance as a raster (metres)"), True)),
                blocks.confidence_parameter(),
            ]
            + blocks.error_block()
            + self.focus_parameters()
            + [
                blocks.advanced(places("KEEP", tr("Places to keep at full resolution"))),
                blocks.advanced(lines),
                blocks.advanced(stray),
                blocks.advanced(blocks.points("OBSERVERS", tr("Observers whose view must stay"), optional=True)),
            ]
            + [blocks.advanced(height) for height in blocks.height_block()]
            + [blocks.advanced(border), blocks.advanced(outline)]
            + self.target_parameters()
            + [
                blocks.vertical_unit_parameter(),
                blocks.extent_parameter(),
                blocks.threads_parameter(),
            ]
        ):
            self.add(parameter)
        self.add_outputs()

    def contradiction(self, parameters, context):
        errors = ("VERTICAL_ACCURACY", "ERROR_RASTER", "ERROR_MODEL")
        views = given(parameters, "OBSERVERS")
        if views and (not given(parameters, "TOLERANCE") or given(parameters, "FOCUS")):
            return tr("TOLERANCE: give metres where the OBSERVERS see nothing, and no FOCUS.")
        said = [name for name in ("TOLERANCE", "TOLERANCE_RASTER") if given(parameters, name)]
        if len(said) == 2:
            return tr("TOLERANCE_RASTER: TOLERANCE says the same thing; give only one of them.")
        if said and not views and any(given(parameters, name) for name in errors):
            return tr("{}: the accuracy of the heights says the same thing; give only one of them.").format(said[0])
        if not said and not any(given(parameters, name) for name in errors):
            return tr("TOLERANCE: say how far the TIN may be from the elevation model, here or as VERTICAL_ACCURACY.")
        if given(parameters, "BREAK_LINE_TOLERANCE") and not given(parameters, "BREAK_LINES"):
            return tr("BREAK_LINE_TOLERANCE: give the BREAK_LINES too.")
        moves = given(parameters, "BORDER_TOLERANCE") and number_or_none(self, parameters, "BORDER_TOLERANCE", context)
        if moves and self.parameterAsBoolean(parameters, "KEEP_BORDER", context):
            return tr("BORDER_TOLERANCE: KEEP_BORDER keeps the outline where it is; give only one of them.")
        bad = self.bad_target(parameters) or self.bad_focus(parameters) or self.bad_confidence(parameters, context)
        return bad or check_error_block(self, parameters, context)

    def read_input(self, parameters, context, feedback):
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        raster = read_raster(self, parameters, "TOLERANCE_RASTER", context, feedback)
        self.tolerance = raster.path if raster else number_or_none(self, parameters, "TOLERANCE", context)
        self.error = read_error_block(self, parameters, context, feedback, self.dem)
        self.extent = read_extent(self, parameters, context, self.dem)
        self.keep, self.focus, self.break_lines = (
            read_places(self, parameters, name, context, feedback, self.dem) for name in ("KEEP", "FOCUS", "BREAK_LINES")
        )
        self.observers = []
        if given(parameters, "OBSERVERS"):
            self.observers, _ = read_points(
                self, parameters, "OBSERVERS", context, feedback, self.dem, HEIGHTS, {}, None
            )

    def compute(self, sightbound, parameters, context, feedback):
        dem = open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        tin = sightbound.dem_to_tin(
            dem,
            tolerance=self._tolerance(sightbound, dem, parameters, context, feedback),
            error_model=self.error.model(sightbound) if self.tolerance is None else None,
            confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
            extent=self.extent,
            keep=samples_in(self.keep, self.dem),
            keep_border=self.parameterAsBoolean(parameters, "KEEP_BORDER", context),
            border_tolerance=number_or_none(self, parameters, "BORDER_TOLERANCE", context) or 0.0,
            break_lines=lines_in(self.break_lines),
            break_line_tolerance=number_or_none(self, parameters, "BREAK_LINE_TOLERANCE", context),
            **self.target(parameters, context),
            threads=self.threads(parameters, context),
            progress=Progress(feedback, 30.0 if self.observers else 0.0, 90.0),
        )
        results = self.told(tin.report, feedback)
        return {**results, **self.write_outputs(tin, parameters, context, feedback)}

    def _tolerance(self, sightbound, dem, parameters, context, feedback):
        if self.focus:
            return self.grown(distances_from(self.focus, self.dem, "FOCUS"), parameters, context)
        if not self.observers:
            return self.tolerance
        tolerance, report = sightbound.visibility_tolerance(
            dem,
            [(place.x, place.y) for place in self.observers],
            self.tolerance,
            observer_height=[place.values["OBSERVER_HEIGHT"] for place in self.observers],
            target_height=[place.values["TARGET_HEIGHT"] for place in self.observers],
            error_model=self.error.model(sightbound),
            confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
            threads=self.threads(parameters, context),
            progress=Progress(feedback, 0.0, 30.0),
        )
        for warning in report["warnings"]:
            feedback.pushWarning(warning)
        feedback.pushInfo(tr("Samples free to move by the whole tolerance: {:.1%}").format(report["free_share"]))
        return tolerance
