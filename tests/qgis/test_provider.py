# SPDX-License-Identifier: GPL-3.0-or-later
"""What QGIS lists: ids, parameters, help, icons."""

from pathlib import Path

import pytest
from qgis.core import (
    QgsApplication,
    QgsProcessingAlgorithm,
    QgsProcessingParameterDefinition,
)

VISIBILITY = ("confidenceviewshed", "probableviewshed", "errorsurfaces", "estimateerror", "lineofsightprofile", "intervisibility")
WITH_ERROR_BLOCK = tuple(name for name in VISIBILITY if name != "estimateerror")
VOLUME = ("builderrorvolume", "volumeviewshed", "volumetargets", "subtractobserver", "volumetoraster")
SIMPLIFICATION = ("demtotin", "simplifytin", "verifytin")
ALGORITHMS = VISIBILITY + VOLUME + SIMPLIFICATION
ERROR_BLOCK = """VERTICAL_ACCURACY VERTICAL_MEASURE GEOLOGIC_VARIATION HORIZONTAL_ACCURACY HORIZONTAL_MEASURE
    ERROR_RASTER GEOLOGIC_MODEL GEOLOGIC_RANGE GEOLOGIC_RASTER TERRAIN_TYPES TERRAIN_FIELD TERRAIN_TABLE
    ERROR_PRODUCT TAILS CORRELATION_LENGTH SHARED_BIAS SAMPLES_OR_MEANS RIDGE_GAIN
    ERROR_MODEL""".split()
VIEWSHED = """INPUT BAND OBSERVERS OBSERVER OBSERVER_HEIGHT TARGET_HEIGHT MAX_DISTANCE CONFIDENCE COMBINE MIN_DISTANCE
    AZIMUTH_FROM AZIMUTH_TO ANGLE_FROM ANGLE_TO OBSERVER_HEIGHT_FIELD TARGET_HEIGHT_FIELD HEIGHT_REFERENCE GROUND
    VERTICAL_UNIT REFRACTION CURVATURE STAND SEE_ACROSS_NODATA EXTENT THREADS CREATION_OPTIONS ID_FIELD OUTPUT
    OUTPUT_VERDICT OUTPUT_COUNT OUTPUT_HEIGHT OUTPUT_HEIGHT_LIKELY OUTPUT_OBSERVERS OUTPUT_FOLDER""".split()
BASIC = """INPUT BAND OBSERVERS OBSERVER OBSERVER_HEIGHT TARGET_HEIGHT MAX_DISTANCE CONFIDENCE COMBINE VERTICAL_ACCURACY
    VERTICAL_MEASURE GEOLOGIC_VARIATION""".split()


@pytest.fixture(params=ALGORITHMS)
def algorithm(request, provider):
    return provider.algorithm(request.param)


def names(definitions):
    return {definition.name() for definition in definitions}


def is_advanced(parameter):
    return bool(parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagAdvanced)


def test_provider_lists_algorithms_and_model(provider):
    assert provider.id() == "sightbound"
    assert {one.name() for one in provider.algorithms()} == {*ALGORITHMS, "Confidence of areas"}
    assert provider.warningMessage() == ""
    assert provider.versionInfo() == "0.1.0"


def test_viewshed_has_the_promised_parameters(provider):
    viewshed = provider.algorithm("confidenceviewshed")
    assert names(viewshed.parameterDefinitions()) == {*VIEWSHED, *ERROR_BLOCK}
    basic = {
        one.name()
        for one in viewshed.parameterDefinitions()
        if not is_advanced(one) and not one.isDestination()
    }
    assert basic == set(BASIC)
    shares = {
        f"{what}_{verdict}" for what in ("AREA", "SHARE") for verdict in ("VISIBLE", "UNCERTAIN", "HIDDEN")
    }
    assert shares <= names(viewshed.outputDefinitions())


def test_error_block_is_the_same_everywhere(provider):
    def described(algorithm):
        block = [algorithm.parameterDefinition(name) for name in ERROR_BLOCK]
        return [(one.type(), one.description(), one.defaultValue(), one.flags(), one.help()) for one in block]

    blocks = [described(provider.algorithm(name)) for name in (*WITH_ERROR_BLOCK, "builderrorvolume", "demtotin", "simplifytin")]
    assert all(block == blocks[0] for block in blocks)


def test_heights_and_limits_are_dynamic(provider):
    viewshed = provider.algorithm("confidenceviewshed")
    for name in """OBSERVER_HEIGHT TARGET_HEIGHT MIN_DISTANCE MAX_DISTANCE AZIMUTH_FROM AZIMUTH_TO ANGLE_FROM
                ANGLE_TO""".split():
        parameter = viewshed.parameterDefinition(name)
        assert parameter.isDynamic() and parameter.dynamicLayerParameterName() == "OBSERVERS", name


def test_every_algorithm_says_what_it_is(algorithm):
    groups = {"Visibility": VISIBILITY, "Error volume": VOLUME, "Simplification": SIMPLIFICATION}
    assert algorithm.name() in groups[algorithm.group()]
    assert algorithm.groupId() == algorithm.group().lower().replace(" ", "")
    assert algorithm.shortDescription() and algorithm.shortHelpString() and algorithm.helpUrl()
    assert len(algorithm.tags()) > 5
    assert Path(algorithm.svgIconPath()).is_file() and not algorithm.icon().isNull()
    assert algorithm.canExecute() == (True, "")


def test_every_parameter_has_help(algorithm):
    without = [one.name() for one in algorithm.parameterDefinitions() if len(one.help()) < 10]
    assert without == []


def test_batch_and_cancel_are_possible(algorithm):
    flags = algorithm.flags()
    assert flags & QgsProcessingAlgorithm.Flag.FlagSupportsBatch
    assert flags & QgsProcessingAlgorithm.Flag.FlagCanCancel
    assert not flags & QgsProcessingAlgorithm.Flag.FlagNoThreading


def test_rarely_used_parameters_need_no_value_in_a_model(algorithm):
    needed = {
        one.name()
        for one in algorithm.parameterDefinitions()
        if not one.flags() & QgsProcessingParameterDefinition.Flag.FlagOptional
    }
    assert needed <= {
        "INPUT",
        "OBSERVERS",
        "POINTS_A",
        "HEIGHT_A",
        "TARGETS",
        "OBSERVER_HEIGHT",
        "TARGET_HEIGHT",
        "CONFIDENCE",
        "OUTPUT",
        "OUTPUT_SIGMA",
        "HIDDEN",
        "HIDE_HEIGHT",
    }


def test_dialog_hands_over_what_the_algorithm_accepts(algorithm, dem, observers, context):
    from processing.gui.AlgorithmDialog import AlgorithmDialog

    dialog = AlgorithmDialog(algorithm.create())
    file = "volume.vdb"  # the dialog looks at the ending alone
    given = {"INPUT": dem, "OBSERVERS": observers, "TARGETS": observers, "HIDDEN": file, "POINTS_A": observers}
    given |= {"SIMPLIFIED_TIN": observers, "TOLERANCE": 1.0}
    if algorithm.parameterDefinition("INPUT").type() == "file":
        given["INPUT"] = file
    if algorithm.parameterDefinition("INPUT").type() == "mesh":
        given = {"TIN": observers, "TOLERANCE": 1.0}
    dialog.setParameters(
        {name: value for name, value in given.items() if algorithm.parameterDefinition(name)}
    )
    values = dialog.createProcessingParameters()
    assert algorithm.checkParameterValues(values, context) == (True, "")
    if "TERRAIN_TABLE" in values:
        assert "craggy" in values["TERRAIN_TABLE"]
    dialog.deleteLater()


def test_provider_can_be_removed_and_added_again(plugin):
    registry = QgsApplication.processingRegistry()
    assert registry.algorithmById("sightbound:confidenceviewshed") is not None
    assert registry.providerById("sightbound") is plugin.provider
