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
from qgis.PyQt.QtTest import QSignalSpy


_WORDS = ("from_fid", "from", "to_fid", "to", "verdict", "status")


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


@pytest.mark.parametrize("name, outputs, more", [
    ("confidenceviewshed", ["OUTPUT"], {}),
    ("probableviewshed", ["OUTPUT", "OUTPUT_HEIGHTS"], {"HEIGHTS": "3", "REALISATIONS": 8}),
])  # fmt: skip
def test_probabilities_are_in_classes_whose_borders_are_the_claims(loaded, dem, observers, name, outputs, more):
    layers = loaded(name, outputs, INPUT=dem, OBSERVERS=observers, CONFIDENCE=0.9, **more)
    for layer in layers.values():
        assert colour(layer, 0.0)[3] == colour(layer, 0.0499)[3] == 0 and colour(layer, 0.051)[3] > 80
        assert colour(layer, 0.9499) != colour(layer, 0.9501) == colour(layer, 1.0) and colour(layer, 1.0)[3] > 150
        classes = numpy.array([colour(layer, p)[:3] for p in (0.07, 0.2, 0.4, 0.6, 0.8, 0.94, 1.0)])
        assert (numpy.diff(classes @ [0.2126, 0.7152, 0.0722]) > 0).all(), "ever lighter"
        labels = [label for label, _ in layer.renderer().legendSymbologyItems()]
        assert labels[0] == "5 % and less: almost surely hidden" and labels[-1] == "95 % and more: almost surely visible"
        assert labels[1:3] == ["5 – 10 %", "10 – 30 %"]


def test_claims_that_lie_between_the_usual_borders(provider, dem):
    from sightbound_qgis.styling import class_claims, style_path

    layer = QgsRasterLayer(dem, "p")
    layer.loadNamedStyle(style_path("confidence"))
    redrawn = QSignalSpy(layer.rendererChanged)
    class_claims(layer, 0.5)
    assert len(redrawn) == 1, "the legend is told"
    labels = [label for label, _ in layer.renderer().legendSymbologyItems()]
    assert labels[1:-1] == ["25 – 30 %", "30 – 50 %", "50 – 70 %", "70 – 75 %"]


def test_legends_learn_of_stretched_ramps(provider, dem):
    from sightbound_qgis.styling import stretch_ramp, style_path

    layer = QgsRasterLayer(dem, "sigma")
    layer.loadNamedStyle(style_path("sigma"))
    redrawn = QSignalSpy(layer.rendererChanged)
    stretch_ramp(layer, 0.98)
    assert len(redrawn) == 1


def test_columns_have_titles_with_units(loaded, dem, observers):
    outputs = ["OUTPUT", "OUTPUT_CRITICAL", "OUTPUT_TABLE"]
    layers = loaded("intervisibility", outputs, INPUT=dem, POINTS_A=observers, PROBABILITY=True, REALISATIONS=8, FREQUENCY=900.0)
    for layer in layers.values():
        numbers = [name for name in layer.fields().names() if name not in _WORDS]
        untitled = [name for name in numbers if layer.attributeDisplayName(layer.fields().lookupField(name)) == name]
        assert untitled == []
    table = layers["OUTPUT_TABLE"]
    at = table.fields().lookupField("distance")
    assert table.attributeDisplayName(at) == "Distance (m)"
    assert table.editorWidgetSetup(at).config() == {"Precision": 1}


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
