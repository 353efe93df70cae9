# SPDX-License-Identifier: GPL-3.0-or-later
"""The algorithms as the dialog runs them: prepared in the main thread, computed in another one."""

import time

import numpy
import pytest
import scenes
from qgis.core import QgsApplication, QgsProcessingAlgRunnerTask, QgsProcessingContext
from qgis.PyQt.QtCore import QCoreApplication


def wait_for(condition, seconds):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        QCoreApplication.processEvents()
        time.sleep(0.005)
    return condition()


@pytest.fixture
def start(provider):
    """Starts an algorithm as a task; returns it and the list that its outcome is put into."""
    kept = []

    def started(name, feedback, **parameters):
        context, outcome = QgsProcessingContext(), []
        task = QgsProcessingAlgRunnerTask(provider.algorithm(name).create(), parameters, context, feedback)
        task.executed.connect(lambda fine, results: outcome.append((fine, results)))
        kept.extend((context, task))
        QgsApplication.taskManager().addTask(task)
        return task, outcome

    return started


def test_result_and_progress_come_from_the_worker(start, dem, observers, tmp_path, log):
    _, outcome = start(
        "confidenceviewshed", log, INPUT=dem, OBSERVERS=observers, OUTPUT=str(tmp_path / "p.tif")
    )
    assert wait_for(lambda: outcome, 60.0)
    fine, results = outcome[0]
    assert fine and results["OUTPUT"] == str(tmp_path / "p.tif") and (tmp_path / "p.tif").is_file()
    assert log.fractions[-1] == 100.0


def test_cancelling_takes_effect_soon(start, tmp_path):
    row, col = numpy.mgrid[0:400, 0:400]
    dem = scenes.write_dem(
        tmp_path / "large.tif", (30.0 * numpy.sin(col / 17.0) * numpy.cos(row / 23.0)).astype("float32")
    )
    places = [(scenes.WEST + 900.0 + 30.0 * i, scenes.NORTH - 900.0 - 27.0 * i) for i in range(100)]
    many = scenes.write_points(tmp_path / "many.gpkg", [(*place, {}) for place in places], {})
    log = scenes.Log()
    task, outcome = start(
        "confidenceviewshed", log, INPUT=str(dem), OBSERVERS=str(many), OUTPUT=str(tmp_path / "p.tif")
    )
    assert wait_for(lambda: log.fractions and log.fractions[-1] > 3.0, 120.0)
    asked = time.monotonic()
    task.cancel()
    log.cancel()
    assert wait_for(lambda: outcome, 60.0)
    assert time.monotonic() - asked < 2.0  # 0.2 s on an idle machine
    assert not (tmp_path / "p.tif").exists()
