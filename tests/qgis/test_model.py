# SPDX-License-Identifier: GPL-3.0-or-later
"""The shipped model, and the algorithms inside models."""

import json

import pytest
import scenes
from qgis.core import (
    QgsProcessing,
    QgsProcessingException,
    QgsProcessingModelAlgorithm,
    QgsProcessingModelChildAlgorithm,
    QgsProcessingModelChildParameterSource,
    QgsProcessingModelOutput,
)

MODEL = "sightbound:Confidence of areas"
Source = QgsProcessingModelChildParameterSource


def test_shipped_model_is_valid(provider):
    model = provider.algorithm("Confidence of areas")
    assert model.validate() == (True, [])
    assert model.group() == "Visibility"


def test_shipped_model_runs(provider, dem, observers, tmp_path):
    import processing

    areas = str(scenes.write_terrain_types(tmp_path / "areas.gpkg"))
    definitions = {
        one.description(): one.name() for one in provider.algorithm("Confidence of areas").outputDefinitions()
    }
    outputs = {name: QgsProcessing.TEMPORARY_OUTPUT for name in definitions.values()}
    parameters = {"dem": dem, "observers": observers, "areas": areas, "max_distance": 1000.0, **outputs}
    results = processing.run(MODEL, parameters)
    p, _ = scenes.read(results[definitions["Confidence"]])
    rows = list(results[definitions["Areas with confidence"]].getFeatures())
    assert len(rows) == 2 and rows[0]["p_mean"] == pytest.approx(float(p[:, :20].mean()), abs=0.01)


def child(name, identifier, **sources):
    made = QgsProcessingModelChildAlgorithm(f"sightbound:{name}")
    made.setChildId(identifier)
    for parameter, source in sources.items():
        made.addParameterSources(parameter, [source])
    return made


def test_estimate_once_and_use_it_in_a_model(provider, dem, observers, tmp_path):
    """errorsurfaces hands its error model file to confidenceviewshed; only what must be said is said."""
    recipe = str(tmp_path / "model.json")
    model = QgsProcessingModelAlgorithm("Two steps", "tests", "tests")
    first = child("errorsurfaces", "surfaces", INPUT=Source.fromStaticValue(dem),
                  CONFIDENCE=Source.fromStaticValue(0.95), VERTICAL_ACCURACY=Source.fromStaticValue(0.7),
                  GEOLOGIC_VARIATION=Source.fromStaticValue(0.0),
                  OUTPUT_MODEL=Source.fromStaticValue(recipe))  # fmt: skip
    second = child(
        "confidenceviewshed",
        "viewshed",
        INPUT=Source.fromStaticValue(dem),
        OBSERVERS=Source.fromStaticValue(observers),
        OBSERVER_HEIGHT=Source.fromExpression("1 + 0.7"),
        TARGET_HEIGHT=Source.fromStaticValue(0.0),
        CONFIDENCE=Source.fromStaticValue(0.95),
        ERROR_MODEL=Source.fromChildOutput("surfaces", "OUTPUT_MODEL"),
    )
    output = QgsProcessingModelOutput("confidence")
    output.setChildId("viewshed")
    output.setChildOutputName("OUTPUT")
    second.setModelOutputs({"confidence": output})
    model.addChildAlgorithm(first)
    model.addChildAlgorithm(second)
    assert model.validate() == (True, [])
    import processing

    results = processing.run(model, {"viewshed:confidence": str(tmp_path / "p.tif")})
    _, dataset = scenes.read(tmp_path / "p.tif")
    used = json.loads(dataset.GetMetadataItem("SIGHTBOUND_ERROR_MODEL"))
    assert used["vertical_rmse"] == 0.7 and results["viewshed:confidence"].endswith("p.tif")


def test_bad_input_stops_a_model_with_the_reason(provider, dem, log):
    import processing

    model = QgsProcessingModelAlgorithm("Bad", "tests", "tests")
    model.addChildAlgorithm(
        child(
            "confidenceviewshed",
            "viewshed",
            INPUT=Source.fromStaticValue(dem),
            CONFIDENCE=Source.fromStaticValue(0.95),
            OBSERVER_HEIGHT=Source.fromStaticValue(1.7),
            TARGET_HEIGHT=Source.fromStaticValue(0.0),
        )  # fmt: skip
    )
    with pytest.raises(QgsProcessingException):
        processing.run(model, {}, feedback=log)
    assert any("OBSERVERS:" in text for text in log.errors + log.warnings + log.infos)
