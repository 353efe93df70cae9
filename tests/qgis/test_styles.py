# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs that QGIS loads are styled; what the styles show is what they promise."""

import numpy
import pytest
import scenes
from qgis.core import (
    QgsNumericFormatContext,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsRasterLayer,
    QgsVectorLayer,
)


@pytest.fixture
def loaded(provider):
    """Runs an algorithm as the dialog does: outputs are loaded and post-processed. Returns layers by output name."""
    from processing.gui.Postprocessing import handleAlgorithmResults

    project = QgsProject.instance()

    def run_and_load(name, outputs, **parameters):
        context, log = QgsProcessingContext(), scenes.Log()
        context.setProject(project)
        for output in outputs:
            definition = QgsProcessingOutputLayerDefinition(QgsProcessing.TEMPORARY_OUTPUT, project)
            definition.destinationName = output
            parameters[output] = definition
        algorithm = provider.algorithm(name).create()
        _, done = algorithm.run(parameters, context, log)
        assert done, log.errors
        handleAlgorithmResults(algorithm, context, log)
        return {output: project.mapLayersByName(output)[0] for output in outputs}

    yield run_and_load
    project.clear()


def colour(layer, value):
    """(red, green, blue, alpha) that the layer's shader gives to a value."""
    found, *rgba = layer.renderer().shader().shade(value)
    assert found
    return rgba


def test_viewshed_outputs_are_styled(loaded, dem, observers):
    names = (
        "OUTPUT",
        "OUTPUT_VERDICT",
        "OUTPUT_COUNT",
        "OUTPUT_HEIGHT",
        "OUTPUT_HEIGHT_LIKELY",
        "OUTPUT_OBSERVERS",
    )
    layers = loaded("confidenceviewshed", names, INPUT=dem, OBSERVERS=observers)
    for name in ("OUTPUT", "OUTPUT_COUNT", "OUTPUT_HEIGHT", "OUTPUT_HEIGHT_LIKELY"):
        assert layers[name].renderer().type() == "singlebandpseudocolor", name
    assert layers["OUTPUT_VERDICT"].renderer().type() == "paletted"
    marker = layers["OUTPUT_OBSERVERS"].renderer().symbol().symbolLayer(0)
    assert marker.layerType() == "SimpleMarker" and marker.color().name() == "#d53e4f"


def test_confidence_is_transparent_where_surely_hidden(loaded, dem, observers):
    layer = loaded("confidenceviewshed", ["OUTPUT"], INPUT=dem, OBSERVERS=observers)["OUTPUT"]
    assert colour(layer, 0.0)[3] == 0 and colour(layer, 0.02)[3] > 80 and colour(layer, 1.0)[3] > 150
    light = [
        0.2126 * r + 0.7152 * g + 0.0722 * b
        for r, g, b, _ in (colour(layer, p) for p in numpy.arange(0.05, 1.01, 0.05))
    ]
    assert (numpy.diff(light) > 0).all()


def test_verdict_has_three_classes_that_colour_blind_people_tell_apart(loaded, dem, observers):
    layer = loaded("confidenceviewshed", ["OUTPUT_VERDICT", "OUTPUT"], INPUT=dem, OBSERVERS=observers)[
        "OUTPUT_VERDICT"
    ]
    classes = {int(one.value): one for one in layer.renderer().classes()}
    assert {value: one.label for value, one in classes.items()} == {0: "hidden", 1: "uncertain", 2: "visible"}
    seen = [
        numpy.array([one.color.redF(), one.color.greenF(), one.color.blueF()]) for one in classes.values()
    ]
    # Red-green blindness keeps blue and a mixture of red and green: tell-tale axes of Viénot's simulation.
    axes = numpy.array([[0.11, 0.89, 0.0], [0.0, 0.0, 1.0]])
    for i in range(3):
        for j in range(i):
            assert numpy.abs(axes @ (seen[i] - seen[j])).max() > 0.15


def test_ramps_fit_the_values(loaded, dem, observers):
    layers = loaded("errorsurfaces", ["OUTPUT_SIGMA", "OUTPUT_LOWER", "OUTPUT_UPPER"], INPUT=dem)
    colours = [
        item.color
        for item in layers["OUTPUT_SIGMA"].renderer().shader().rasterShaderFunction().colorRampItemList()
    ]
    assert (numpy.diff([one.lightness() for one in colours]) > 0).all()
    for layer in layers.values():
        values = scenes.read(layer.source())[0]
        function = layer.renderer().shader().rasterShaderFunction()
        assert function.minimumValue() == pytest.approx(numpy.nanmin(values), abs=1e-3)
        assert function.maximumValue() == pytest.approx(numpy.nanpercentile(values, 98), rel=0.02)
        spoken = function.legendSettings().numericFormat().formatDouble(function.maximumValue(), QgsNumericFormatContext())
        assert len(spoken.replace(".", "")) <= 5, "three digits of the span"


def test_lines_and_critical_places_are_styled(loaded, dem, observers):
    layers = loaded(
        "lineofsightprofile", ["OUTPUT", "OUTPUT_CRITICAL"], INPUT=dem, OBSERVERS=observers, TARGETS=observers
    )
    layers.update(network=loaded("intervisibility", ["OUTPUT"], INPUT=dem, POINTS_A=observers)["OUTPUT"])
    for layer in layers.values():
        renderer = layer.renderer()
        assert renderer.type() == "categorizedSymbol" and renderer.classAttribute() == "verdict"
        assert [one.value() for one in renderer.categories()] == ["visible", "uncertain", "hidden", "unknown"]


@pytest.mark.parametrize("style", ["confidence", "verdict", "count", "height", "sigma", "surface", "thickness"])
def test_raster_styles_load_by_themselves(provider, dem, style):
    from sightbound_qgis.styling import style_path

    layer = QgsRasterLayer(dem, "dem")
    message, loaded_fine = layer.loadNamedStyle(style_path(style))
    assert loaded_fine, message


def test_hiding_places_are_numbered(provider, observers):
    from sightbound_qgis.styling import style_path

    layer = QgsVectorLayer(observers, "places", "ogr")
    message, loaded_fine = layer.loadNamedStyle(style_path("places"))
    assert loaded_fine, message
    assert layer.labelsEnabled() and layer.labeling().settings().fieldName == "rank"
