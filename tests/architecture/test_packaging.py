# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shipped: the staged plugin, its zip by the rules of the QGIS plugin repository, and the two versions."""

import configparser
import json
import os
import re
import subprocess
import sys
import zipfile

import pytest
from project import ROOT

BUILD = ROOT / os.environ.get("SIGHTBOUND_BUILD", "build")
STAGE = BUILD / "qgis_plugins" / "sightbound_qgis"
REQUIRED_KEYS = {"name", "description", "version", "qgisMinimumVersion", "author", "email", "about", "tracker", "repository"}


def metadata():
    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str
    parser.read(ROOT / "metadata.txt", encoding="utf-8")
    return dict(parser["general"])


@pytest.fixture(scope="module")
def plugin_zip(tmp_path_factory):
    out = tmp_path_factory.mktemp("packages")
    subprocess.run([sys.executable, ROOT / "scripts" / "make_plugin_zip.py", STAGE, out], check=True, capture_output=True)
    (path,) = out.glob("*.zip")
    return path


def test_zip_has_one_top_folder_that_is_the_plugin(plugin_zip):
    names = zipfile.ZipFile(plugin_zip).namelist()
    assert {name.split("/")[0] for name in names} == {"sightbound_qgis"}
    top = {name.split("/")[1] for name in names}
    assert {"__init__.py", "metadata.txt", "LICENSE", "defaults.json"} <= top


def test_zip_holds_nothing_the_repository_refuses(plugin_zip):
    refused = re.compile(r"(^|/)(\.|__MACOSX|__pycache__)|\.\.|\\|\.(pyc|so|dll|dylib|exe|pyd|bat|cmd|ps1|sh)$|^[A-Za-z]:")
    names = zipfile.ZipFile(plugin_zip).namelist()
    assert not [name for name in names if refused.search(name)]
    assert plugin_zip.stat().st_size < 25e6


def test_zip_holds_every_file_of_the_plugin(plugin_zip):
    inside = {name.split("/", 1)[1] for name in zipfile.ZipFile(plugin_zip).namelist()}
    folder = ROOT / "qgis_plugin"
    ours = {path.relative_to(folder).as_posix() for path in folder.rglob("*")
            if path.is_file() and "__pycache__" not in path.parts}
    assert ours <= inside


def test_zip_has_the_same_bytes_every_time(plugin_zip, tmp_path):
    subprocess.run([sys.executable, ROOT / "scripts" / "make_plugin_zip.py", STAGE, tmp_path], check=True, capture_output=True)
    (again,) = tmp_path.glob("*.zip")
    assert again.read_bytes() == plugin_zip.read_bytes()


def test_metadata_has_what_the_repository_requires():
    found = metadata()
    assert REQUIRED_KEYS <= {key for key, value in found.items() if value.strip()}
    assert "/" not in found["author"]
    assert not re.search(r"<[a-z/]", found["description"] + found["about"])
    assert found["hasProcessingProvider"] == "yes"
    assert found["qgisMinimumVersion"] == "3.22"
    assert found["qgisMaximumVersion"] == "4.99"
    assert (ROOT / "qgis_plugin" / found["icon"]).is_file()
    assert "sightbound-core" in found["about"], "external dependencies must be stated"


def test_versions_agree():
    cmake = re.search(r"project\(sightbound VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    debian = (ROOT / "cmake" / "debian" / "changelog").read_text(encoding="utf-8")
    import sightbound

    assert metadata()["version"] == cmake.group(1) == sightbound.__version__
    assert debian.startswith(f"sightbound-core ({cmake.group(1)})")


def test_defaults_shipped_with_the_plugin_are_the_core_s():
    import sightbound

    assert json.loads((STAGE / "defaults.json").read_text(encoding="utf-8")) == json.loads(json.dumps(sightbound.defaults()))


def test_staged_licence_and_metadata_are_the_project_s():
    for name in ("LICENSE", "metadata.txt"):
        assert (STAGE / name).read_bytes() == (ROOT / name).read_bytes()
