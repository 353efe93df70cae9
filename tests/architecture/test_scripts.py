# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts can be run as the README says, and the files beside the code say what they must."""

import json
import os
import re
import subprocess

import pytest
from project import ROOT, files

SCRIPTS = sorted(str(path.relative_to(ROOT)) for path in files("scripts", "benchmarks", ".ci")
                 if path.suffix == ".sh" or path.name == "run")


@pytest.mark.parametrize("script", SCRIPTS)
def test_script_is_sound_bash(script):
    subprocess.run(["bash", "-n", ROOT / script], check=True)


@pytest.mark.parametrize("script", [name for name in SCRIPTS if not name.endswith("setup.sh")])
def test_script_can_be_run(script):
    assert os.access(ROOT / script, os.X_OK)
    assert (ROOT / script).read_text(encoding="utf-8").startswith("#!")


def test_presets():
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
    folders = {p["name"]: p.get("binaryDir", "${sourceDir}/build-${presetName}")
               for p in presets["configurePresets"] if not p.get("hidden")}
    assert set(folders) == {"release", "debug", "asan-ubsan", "tsan", "scalar"}
    assert folders.pop("release") == "${sourceDir}/build"
    assert set(folders.values()) == {"${sourceDir}/build-${presetName}"}


def test_top_level_is_the_one_agreed():
    wanted = {"CMakeLists.txt", "cpp", "bindings", "qgis_plugin", "tests", "sample_data", "metadata.txt", "README.md",
              "docs", "benchmarks", "scripts", ".ci", "cmake", ".clang-format", ".clang-tidy", ".editorconfig",
              ".gitignore", "LICENSE", "CHANGELOG.md", "CONTRIBUTING.md", "CMakePresets.json"}
    found = {path.relative_to(ROOT).parts[0] for path in files()}
    assert wanted <= found
    assert not {name for name in found - wanted if not re.match(r"\.|[\w-]+\.(toml|ini|cfg)$", name)}


def test_licence_is_the_gpl_3():
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert text.lstrip().startswith("GNU GENERAL PUBLIC LICENSE")
    assert "Version 3, 29 June 2007" in text and len(text) > 30000
