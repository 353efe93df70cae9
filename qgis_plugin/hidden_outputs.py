# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms on hidden volumes write and tell: rasters, the fog as a mesh, areas and volumes."""

from qgis.core import (
    Qgis,
    QgsProcessingContext,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterRasterDestination,
    QgsProcessingUtils,
)

from .errors import core_errors
from .feedback import Progress
from .styling import StyleOnLoad, style_when_loaded
from .text import tr
from .values import given

# output, label, argument of write, style
RASTERS = (
    ("OUTPUT_HEIGHT", "Lowest visible height (m)", "height", "height"),
    ("OUTPUT_THICKNESS", "Thickness of the hidden layer (m)", "thickness", "thickness"),
    ("OUTPUT_CORE", "Thickness of the surely hidden core (m)", "core_thickness", "thickness"),
)
TOP = "OUTPUT_TOP"
FOG = "OUTPUT_FOG"
# QGIS draws meshes opaque in 3D. Polygons can be transparent since 3.26; before, one sees through a net of their edges.
FOG_STYLE = "fog_faces" if Qgis.QGIS_VERSION_INT >= 32600 else "fog_net"
NUMBERS = (
    ("AREA_HIDDEN", "Area that hides a thing of the height asked (m²)"),
    ("AREA_CORE", "Area that surely hides it (m²)"),
    ("VOLUME_HIDDEN", "Volume that is not surely visible (m³)"),
    ("VOLUME_CORE", "Volume that is surely hidden (m³)"),
    ("VOLUME_VISIBLE", "Volume that is surely visible (m³)"),
)


def add_outputs(algorithm, by_default=True):
    """Rasters, mesh, fog and numbers, all optional."""
    for name, label, *_ in RASTERS:
        algorithm.add(QgsProcessingParameterRasterDestination(name, tr(label)), True, by_default)
    top = QgsProcessingParameterFileDestination(TOP, tr("Top of the hidden volume (mesh)"), "PLY (*.ply)")
    algorithm.add(top, True, by_default)
    faces = QgsProcessingParameterFileDestination(FOG, tr("Fog for the 3D view (polygons)"), "GeoPackage (*.gpkg)")
    algorithm.add(faces, True, by_default)
    for name, label in NUMBERS:
        algorithm.addOutput(QgsProcessingOutputNumber(name, tr(label)))


def write_outputs(algorithm, hidden, parameters, context, feedback, first=90.0):
    """Writes what was asked for and has it loaded and styled; the results by output."""
    wanted = [row for row in RASTERS if given(parameters, row[0])]
    results = {row[0]: algorithm.parameterAsOutputLayer(parameters, row[0], context) for row in wanted}
    arguments = {row[2]: results[row[0]] for row in wanted}
    for name, argument in ((TOP, "top"), (FOG, "fog")):
        if given(parameters, name):
            results[name] = arguments[argument] = algorithm.parameterAsFileOutput(parameters, name, context)
    results.update(_told(hidden, algorithm.parameterAsDouble(parameters, "HIDE_HEIGHT", context), feedback))
    if not arguments:
        return results
    with core_errors(paths={results[name]: name for name in results if isinstance(results[name], str)}):
        warnings = hidden.write(
            **arguments,
            creation_options=algorithm.options,
            threads=algorithm.threads(parameters, context),
            progress=Progress(feedback, first, 100.0),
        )
    for warning in warnings:
        feedback.pushWarning(warning)
    for name, _, _, style in wanted:
        style_when_loaded(context, results[name], style, 0.98)
    if not results["VOLUME_HIDDEN"] > 0:  # there is no top
        return {name: value for name, value in results.items() if name not in (TOP, FOG)}
    hint = QgsProcessingUtils.LayerHint
    if TOP in results:
        # Where the fog is drawn in 3D the mesh, which would hide it, lies on the terrain as the map shows it.
        style = StyleOnLoad("fog", 0.0, flat=FOG in results)
        _load(results[TOP], context, TOP, tr("Hidden volume"), hint.Mesh, style)
    if FOG in results:
        _load(results[FOG], context, FOG, tr("Fog (3D view)"), hint.Vector, StyleOnLoad(FOG_STYLE, 0.0))
    return results


def _told(hidden, height, feedback):
    with core_errors("HIDE_HEIGHT"):
        area = hidden.area(height)
    volumes = hidden.volumes()
    found = {
        "AREA_HIDDEN": area["hidden_m2"],
        "AREA_CORE": area["core_m2"],
        "VOLUME_HIDDEN": volumes["hidden_m3"] + volumes["uncertain_m3"],
        "VOLUME_CORE": volumes["hidden_m3"],
        "VOLUME_VISIBLE": volumes["visible_m3"],
    }
    for name, label in NUMBERS:
        feedback.pushInfo(f"{tr(label)}: {found[name]:.6g}")
    return found


def _load(path, context, output, name, hint, style):
    """Adds a layer to the project when the algorithm is done."""
    if context.project() is None:
        return
    details = QgsProcessingContext.LayerDetails(name, context.project(), output, hint)
    details.setPostProcessor(style)
    context.addLayerToLoadOnCompletion(path, details)
