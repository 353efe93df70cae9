# SPDX-License-Identifier: GPL-3.0-or-later
"""What the viewshed says of each observer: one raster each in a folder, and a table of areas."""

import os
import shutil
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from qgis.core import QgsFeature, QgsFeatureSink, QgsFields, QgsWkbTypes

from .errors import bad_input, core_errors
from .feedback import Progress
from .fields import add_unique, number_field, text_field
from .observers import file_names
from .styling import style_path, style_when_loaded
from .text import tr

# Columns of the table, under the names they have in the core's report of an observer.
_COLUMNS = ("ground_height", "eye_height", "visible_m2", "uncertain_m2", "hidden_m2", "status")
# What GDAL keeps beside a raster; of an older raster it says nothing true of the new one.
_SIDE_FILES = (".aux.xml", ".ovr", ".msk")


@contextmanager
def observer_rasters(folder, sightbound, dem, job, arguments, feedback):
    """Writes the confidence raster of each observer, cropped to its reach, with its style beside it.

    They are made in a hidden folder inside `folder` and appear in it when the block ends. If the block or the writing
    fails or is cancelled none does, and what stood in `folder` stays.
    """
    folder = Path(folder)
    with ExitStack() as stack:
        with core_errors("OUTPUT_FOLDER"):
            folder.mkdir(parents=True, exist_ok=True)
            hidden = Path(stack.enter_context(TemporaryDirectory(prefix=".sightbound-", dir=folder)))
            new, old = hidden / "new", hidden / "old"
            new.mkdir()
            old.mkdir()
            _write_rasters(new, sightbound, dem, job, arguments, feedback)
        yield
        with core_errors("OUTPUT_FOLDER"):
            _replace_files(new, folder, old)


def _write_rasters(folder, sightbound, dem, job, arguments, feedback):
    spots = [(place.x, place.y) for place in job.places]
    results = sightbound.viewsheds(dem, spots, progress=Progress(feedback, 50.0, 95.0), **arguments)
    for name, result in zip(file_names(job.places), results):
        path = folder / f"{name}.tif"
        here = feedback.progress()
        result.write(
            confidence=str(path), creation_options=job.options, progress=Progress(feedback, here, here)
        )
        shutil.copyfile(style_path("confidence"), path.with_suffix(".qml"))


def _replace_files(new, folder, old):
    """Moves all files of `new` into `folder`, those they replace into `old`; if one cannot be moved, all go back."""
    moved = []

    def move(source, target):
        os.replace(source, target)
        moved.append((source, target))

    try:
        for path in sorted(new.iterdir()):
            for name in [path.name] + [path.name + side for side in _SIDE_FILES]:
                if (folder / name).is_file():
                    move(folder / name, old / name)
            move(path, folder / path.name)
    except OSError:
        for source, target in reversed(moved):
            os.replace(target, source)
        raise


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
        add_unique(fields, text_field if name == "status" else number_field, name)
