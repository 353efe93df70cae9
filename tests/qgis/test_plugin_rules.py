# SPDX-License-Identifier: GPL-3.0-or-later
"""What the plugin repository and other QGIS versions ask of the plugin's files."""

import ast
import configparser
import json
import re

import pytest
from conftest import PLUGINS, ROOT

FOLDER = PLUGINS / "sightbound_qgis"
SOURCES = sorted((ROOT / "qgis_plugin").rglob("*.py"))
REQUIRED = "name description version qgisMinimumVersion author email about tracker repository".split()


def test_metadata():
    metadata = configparser.ConfigParser(interpolation=None)
    metadata.read(FOLDER / "metadata.txt", encoding="utf-8")
    general = metadata["general"]
    assert [key for key in REQUIRED if not general.get(key)] == []
    assert general["name"] == "Sightbound" and general["hasProcessingProvider"] == "yes"
    assert general["qgisMinimumVersion"] == "3.22" and general["qgisMaximumVersion"] == "4.99"
    assert "sightbound" in general["about"] and "apt install" in general["about"]
    assert (FOLDER / general["icon"]).is_file()
    assert not re.search(r"[<>]", general["about"] + general["description"])


def test_no_binaries_and_nothing_hidden():
    allowed = {".py", ".txt", ".json", ".html", ".css", ".qml", ".svg", ".model3", ""}
    files = [one for one in FOLDER.rglob("*") if one.is_file() and "__pycache__" not in one.parts]
    assert [one for one in files if one.suffix not in allowed or one.name.startswith(".")] == []
    assert [one for one in files if not one.suffix and one.name != "LICENSE"] == []
    assert (FOLDER / "LICENSE").is_file() and (FOLDER / "defaults.json").is_file()
    for one in files:
        one.read_text(encoding="utf-8")


@pytest.mark.parametrize("source", SOURCES, ids=lambda one: one.name)
def test_sources(source):
    text = source.read_text(encoding="utf-8")
    assert text.startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n")
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 0:
            assert not node.module.startswith(("sightbound", "PyQt"))
        if isinstance(node, ast.Import):
            modules = {one.name.split(".")[0] for one in node.names}
            assert not modules & {
                "sightbound",
                "sightbound_qgis",
                "PyQt5",
                "PyQt6",
                "subprocess",
                "pickle",
                "marshal",
            }
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in {"exec", "eval", "compile", "__import__"}


# Members that live on both Qt5 and Qt6 only under their enum's name.
UNSCOPED = re.compile(
    r"QgsProcessing\.Type[A-Z]|QgsProcessingParameterDefinition\.Flag[A-Z]|QgsProcessingParameterNumber\.(Double|Integer)\b|"
    r"QgsProcessingAlgorithm\.Flag[A-Z]|QgsUnitTypes\.Distance[A-Z](?!nit)|QgsFeatureSink\.FastInsert|"
    r"QgsWkbTypes\.(Point|LineString|MultiPolygon)\b|QgsRasterBandStats\.(Min|Max)\b|QgsProperty\.StaticProperty"
)


@pytest.mark.parametrize("source", SOURCES, ids=lambda one: one.name)
def test_enums_are_scoped(source):
    assert UNSCOPED.findall(source.read_text(encoding="utf-8")) == []


def test_no_help_text_takes_the_place_of_another():
    def once(pairs):
        names = [name for name, _ in pairs]
        assert sorted(set(names)) == sorted(names)
        return dict(pairs)

    json.loads((FOLDER / "help" / "parameters.json").read_text(encoding="utf-8"), object_pairs_hook=once)
