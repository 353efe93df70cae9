# SPDX-License-Identifier: GPL-3.0-or-later
"""qgis_process from end to end, in processes of their own, with and without the core."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
import scenes
from conftest import BUILD, PLUGINS

# Debian 12's wrapper `qgis_process` fails on every command.
PROGRAM = shutil.which("qgis_process.bin") or shutil.which("qgis_process")


@pytest.fixture
def qgis_process(tmp_path):
    """Runs a command of qgis_process with the staged plugin; `core` is the folder on PYTHONPATH."""
    profile = tmp_path / "profile"
    settings = profile / "profiles" / "default" / "QGIS" / "QGIS3.ini"
    settings.parent.mkdir(parents=True)
    settings.write_text("[PythonPlugins]\nsightbound_qgis=true\n")

    def run_command(*command, plugins=PLUGINS, core=BUILD / "python"):
        environment = dict(
            os.environ,
            QGIS_CUSTOM_CONFIG_PATH=str(profile),
            QGIS_PLUGINPATH=str(plugins),
            PYTHONPATH=str(core),
            PYTHONDONTWRITEBYTECODE="1",
        )
        return subprocess.run(
            [PROGRAM, *map(str, command)],
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )

    return run_command


@pytest.fixture
def bare_plugins(tmp_path):
    """The plugin as the zip holds it: without the link to the core that the build puts beside it."""
    plugins = tmp_path / "plugins"
    shutil.copytree(
        PLUGINS / "sightbound_qgis",
        plugins / "sightbound_qgis",
        ignore=lambda _, names: {"sightbound"} & {*names},
    )
    return plugins


def arguments(dem, observers, tmp_path):
    return f"INPUT={dem}", f"OBSERVERS={observers}", f"OUTPUT={tmp_path / 'p.tif'}"


def test_list_and_help(qgis_process):
    listed = qgis_process("list").stdout
    for name in ("confidenceviewshed", "errorsurfaces", "lineofsightprofile", "Confidence of areas"):
        assert f"sightbound:{name}" in listed
    shown = qgis_process("help", "sightbound:confidenceviewshed").stdout
    assert "VERTICAL_MEASURE" in shown and "LE90" in shown


def test_viewshed(qgis_process, dem, observers, tmp_path):
    done = qgis_process(
        "--json", "run", "sightbound:confidenceviewshed", "--", *arguments(dem, observers, tmp_path),
        "OBSERVER_HEIGHT_FIELD=eye", "TARGET_HEIGHT=2", "MAX_DISTANCE=150", "VERTICAL_ACCURACY=1.5",
        "VERTICAL_MEASURE=LE95", "COMBINE=worst", f"OUTPUT_VERDICT={tmp_path / 'v.tif'}",
        f"OUTPUT_OBSERVERS={tmp_path / 'o.gpkg'}",
        f"OUTPUT_FOLDER={tmp_path / 'each'}", "ID_FIELD=name",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr + done.stdout
    results = json.loads(done.stdout[done.stdout.index("{") :])["results"]
    assert results["SHARE_VISIBLE"] + results["SHARE_UNCERTAIN"] + results["SHARE_HIDDEN"] == pytest.approx(
        1.0
    )
    assert json.loads(results["ERROR_MODEL_USED"])["vertical_rmse"] == pytest.approx(1.5 / 1.96, abs=1e-4)
    assert scenes.read(results["OUTPUT"])[0].dtype.name == "float32"
    rows = scenes.rows_of(tmp_path / "o.gpkg")
    assert [row["eye_height"] - row["ground_height"] for row in rows] == pytest.approx([1.7, 8.0], abs=1e-3)
    assert {one.name for one in (tmp_path / "each").glob("*.tif")} == {"tower_a_b.tif", "hut.tif"}


def test_one_point_and_lines(qgis_process, dem, observers, tmp_path):
    point = f"OBSERVER={scenes.FIRST[0]},{scenes.FIRST[1]} [EPSG:{scenes.UTM}]"
    done = qgis_process(
        "run", "sightbound:confidenceviewshed", "--", f"INPUT={dem}", point, f"OUTPUT={tmp_path / 'p.tif'}"
    )
    assert done.returncode == 0 and (tmp_path / "p.tif").is_file(), done.stderr + done.stdout
    done = qgis_process("run", "sightbound:lineofsightprofile", "--", f"INPUT={dem}", f"OBSERVERS={observers}",
                        f"TARGETS={observers}", f"OUTPUT={tmp_path / 'l.gpkg'}",
                        f"OUTPUT_HTML={tmp_path / 'l.html'}")  # fmt: skip
    assert done.returncode == 0 and len(scenes.rows_of(tmp_path / "l.gpkg")) == 2, done.stderr + done.stdout
    assert (tmp_path / "l.html").read_text(encoding="utf-8").count("<svg") == 2 + 1  # and the key


def test_bad_input_fails_and_says_why(qgis_process, dem, tmp_path):
    done = qgis_process(
        "run", "sightbound:confidenceviewshed", "--", f"INPUT={dem}", f"OUTPUT={tmp_path / 'p.tif'}"
    )
    assert done.returncode != 0 and "OBSERVERS:" in done.stdout + done.stderr
    assert not (tmp_path / "p.tif").exists()


def test_without_the_core_the_message_says_how_to_install_it(
    qgis_process, bare_plugins, dem, observers, tmp_path
):
    nothing = {"core": tmp_path / "nowhere", "plugins": bare_plugins}
    assert "sightbound:errorsurfaces" in qgis_process("list", **nothing).stdout
    run_it = ("run", "sightbound:confidenceviewshed", "--", *arguments(dem, observers, tmp_path))
    done = qgis_process(*run_it, **nothing)
    assert done.returncode != 0
    assert "sudo apt install ./sightbound-core_*.deb" in done.stdout + done.stderr
    assert "cmake --install build" in done.stdout + done.stderr


def test_core_in_the_plugins_own_folder_is_used(qgis_process, bare_plugins, dem, observers, tmp_path):
    shutil.copytree(BUILD / "python" / "sightbound", bare_plugins / "sightbound_qgis" / "sightbound")
    run_it = ("run", "sightbound:confidenceviewshed", "--", *arguments(dem, observers, tmp_path))
    done = qgis_process(*run_it, plugins=bare_plugins, core=tmp_path / "nowhere")
    assert done.returncode == 0 and (tmp_path / "p.tif").is_file(), done.stderr + done.stdout


@pytest.mark.parametrize(
    "version, gdal, words", [("9.9.0", None, ("9.9.0", "0.1")), ("0.1.0", "9.9.9", ("GDAL 9.9.9",))]
)
def test_core_that_does_not_fit_is_refused(
    qgis_process, bare_plugins, dem, observers, tmp_path, version, gdal, words
):
    other = tmp_path / "other" / "sightbound"
    other.mkdir(parents=True)
    answer = f"return {gdal!r}" if gdal else "from osgeo import gdal; return gdal.__version__"
    (other / "__init__.py").write_text(f"__version__ = {version!r}\n\n\ndef gdal_version():\n    {answer}\n")
    run_it = ("run", "sightbound:confidenceviewshed", "--", *arguments(dem, observers, tmp_path))
    done = qgis_process(*run_it, plugins=bare_plugins, core=other.parent)
    said = done.stdout + done.stderr
    assert done.returncode != 0 and all(word in said for word in words) and "apt install" in said


def test_program_is_there():
    assert PROGRAM is not None and Path(PROGRAM).exists()
