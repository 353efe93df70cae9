# SPDX-License-Identifier: GPL-3.0-or-later
"""One QGIS without a window for all tests, with the staged plugin (build/qgis_plugins) and the core (build/python).

The profile is a temporary one: nothing of the user's is read or changed.
"""

import os
import sys
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / os.environ.get("SIGHTBOUND_BUILD", "build")
PLUGINS = BUILD / "qgis_plugins"
_PROFILE = tempfile.TemporaryDirectory(prefix="sightbound-qgis-")

os.environ["QT_QPA_PLATFORM"] = "offscreen"
os.environ["QGIS_CUSTOM_CONFIG_PATH"] = _PROFILE.name
os.environ["QGIS_PLUGINPATH"] = str(PLUGINS)
os.environ["PYTHONPATH"] = str(BUILD / "python")

sys.path[:0] = [
    str(BUILD / "python"),
    str(PLUGINS),
    str(Path(__file__).parent),
    "/usr/share/qgis/python/plugins",
]


def pytest_configure(config):
    if not (PLUGINS / "sightbound_qgis" / "metadata.txt").is_file():
        raise pytest.UsageError(f"the plugin is not staged in {PLUGINS}; run scripts/build.sh first.")


@pytest.fixture(scope="session", autouse=True)
def qgis_application():
    from qgis.core import QgsApplication

    application = QgsApplication([], True)
    application.initQgis()
    from processing.core.Processing import Processing

    Processing.initialize()
    yield application


@pytest.fixture(scope="session")
def plugin(qgis_application):
    import sightbound_qgis

    loaded = sightbound_qgis.classFactory(None)
    loaded.initProcessing()
    yield loaded
    loaded.unload()


@pytest.fixture(scope="session")
def provider(plugin):
    return plugin.provider


@pytest.fixture
def run(provider):
    """processing.run under a short name: run("confidenceviewshed", INPUT=..., feedback=..., context=...)."""
    import processing

    def run_algorithm(algorithm, feedback=None, context=None, **parameters):
        return processing.run(f"sightbound:{algorithm}", parameters, feedback=feedback, context=context)

    return run_algorithm


@pytest.fixture
def context():
    from qgis.core import QgsProcessingContext, QgsProject

    made = QgsProcessingContext()
    project = QgsProject()
    made.setProject(project)
    yield made


@pytest.fixture
def log():
    from scenes import Log

    return Log()


@pytest.fixture
def dem(tmp_path):
    from scenes import write_dem

    return str(write_dem(tmp_path / "dem.tif"))


@pytest.fixture
def observers(tmp_path):
    from scenes import write_observers

    return str(write_observers(tmp_path / "observers.gpkg"))
