# SPDX-License-Identifier: GPL-3.0-or-later
"""What the viewshed says of each observer: one raster each in a folder, and a table of areas."""

import shutil
from pathlib import Path

from qgis.core import QgsFeature, QgsFeatureSink, QgsFields, QgsWkbTypes

from .errors import bad_input, core_errors
from .feedback import Progress
from .fields import number_field, text_field
from .observers import file_names
from .styling import style_path, style_when_loaded
from .text import tr

# Columns of the table, under the names they have in the core's report of an observer.
_COLUMNS = ("ground_height", "eye_height", "visible_m2", "uncertain_m2", "hidden_m2", "status")


def write_observer_rasters(algorithm, sightbound, dem, job, arguments, parameters, context, feedback):
    """Writes the confidence raster of each observer, cropped to its reach, with its style beside it.

    If it fails or is cancelled the rasters of this run are removed again.
    """
    folder = Path(algorithm.parameterAsString(parameters, "OUTPUT_FOLDER", context))
    spots = [(place.x, place.y) for place in job.places]
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with core_errors("OUTPUT_FOLDER"):
            results = sightbound.viewsheds(dem, spots, progress=Progress(feedback, 50.0, 95.0), **arguments)
            for name, result in zip(file_names(job.places), results):
                path = folder / f"{name}.tif"
                written += [path, path.with_suffix(".qml")]
                result.write(confidence=str(path), creation_options=job.options)
                shutil.copyfile(style_path("confidence"), path.with_suffix(".qml"))
    except BaseException:
        for path in written:
            path.unlink(missing_ok=True)
        raise
    return str(folder)


def write_observer_table(algorithm, job, report, parameters, context):
    """Writes the features of OBSERVERS, one for each observer, with the columns of the report."""
    fields, crs = QgsFields(), job.dem.crs
    if job.source is not None:
        fields, crs = QgsFields(job.source.fields()), job.source.sourceCrs()
    _append_columns(fields)
    sink, target = algorithm.parameterAsSink(
        parameters, "OUTPUT_OBSERVERS", context, fields, QgsWkbTypes.Type.Point, crs
    )
    if sink is None:
        raise bad_input("OUTPUT_OBSERVERS", tr("the layer cannot be written."))
    for place, row in zip(job.places, report["observers"]):
        feature = QgsFeature(fields)
        feature.setGeometry(place.point)
        feature.setAttributes(place.feature.attributes() + [row[name] for name in _COLUMNS])
        if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
            raise bad_input("OUTPUT_OBSERVERS", tr("{} cannot be written.").format(place.label))
    style_when_loaded(context, target, "observers")
    return target


def _append_columns(fields):
    """Appends the columns, numbered where the input has one of that name."""
    for name in _COLUMNS:
        unique, count = name, 1
        while fields.lookupField(unique) >= 0:
            count += 1
            unique = f"{name}_{count}"
        fields.append(text_field(unique) if name == "status" else number_field(unique))
