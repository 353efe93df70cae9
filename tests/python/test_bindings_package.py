# SPDX-License-Identifier: GPL-3.0-or-later
"""The package as a whole: what importing it costs and refuses, its stubs, its defaults."""
import ast
import inspect
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sightbound as sb
from sightbound import _core, _volume

PACKAGE = Path(sb.__file__).resolve().parent


def python(code):
    """What `code` prints in a fresh interpreter that finds the package."""
    start = f"import sys; sys.path.insert(0, {str(PACKAGE.parent)!r})\n"
    return subprocess.run([sys.executable, "-c", start + code], capture_output=True, text=True)


def test_numpy_and_openvdb_are_not_loaded_until_they_are_needed(tmp_path):
    dem = sb.viewshed(sb.Dem(np.zeros((9, 9)), (0, 10, 0, 90, 0, -10)), [(45, 45)], error_model=sb.ErrorModel(1, 0, 0))
    dem.write(tmp_path / "dem.tif")
    job = python(f"""
import sightbound as sb
dem = sb.read_dem({str(tmp_path / 'dem.tif')!r})
result = sb.viewshed(dem, [(45, 45)], max_distance=30)
result.write({str(tmp_path / 'c.tif')!r}, verdict={str(tmp_path / 'v.tif')!r}, count={str(tmp_path / 'n.tif')!r})
heavy = {{"numpy", "typing", "json", "osgeo", "pathlib", "sightbound._volume"}} & set(sys.modules)
print(heavy or "none", result.report["visible_share"] >= 0)
""")
    assert job.stdout == "none True\n", job.stderr
    assert (tmp_path / "n.tif").is_file()


def test_another_gdal_in_the_process_is_refused():
    job = python("""
import types
gdal = sys.modules["osgeo.gdal"] = types.ModuleType("osgeo.gdal")
gdal.__version__ = "2.0.1"
import sightbound
""")
    assert job.returncode == 1 and "ImportError" in job.stderr and "GDAL 2.0.1" in job.stderr and sb.gdal_version() in job.stderr


def test_the_gdal_of_python_is_the_same():
    job = python("from osgeo import gdal; import sightbound; print(sightbound.gdal_version() == gdal.__version__)")
    assert job.stdout == "True\n", job.stderr


def test_a_missing_core_is_explained(tmp_path):
    folder = tmp_path / "sightbound"
    folder.mkdir()
    for file in PACKAGE.glob("*.py"):
        (folder / file.name).write_bytes(file.read_bytes())
    job = subprocess.run([sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import sightbound"],
                         capture_output=True, text=True)
    assert "compiled part _core of sightbound cannot be loaded by Python" in job.stderr and "-DPython_EXECUTABLE" in job.stderr


def test_public_names():
    assert sorted(sb.__all__) == sb.__all__
    for name in sb.__all__:
        assert inspect.getdoc(getattr(sb, name)) or name == "defaults", name
    assert (PACKAGE / "py.typed").is_file()


def stubbed(module):
    """name -> attributes (classes) or argument names (functions) of the module's .pyi."""
    found = {}
    for node in ast.parse((PACKAGE / f"{module.__name__.rpartition('.')[2]}.pyi").read_text()).body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = {child.target.id if isinstance(child, ast.AnnAssign) else child.name for child in node.body
                                if isinstance(child, (ast.AnnAssign, ast.FunctionDef))} - {"__init__"}
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = [argument.arg for argument in node.args.args]
    return found


@pytest.mark.parametrize("module", [_core, _volume])
def test_stubs_tell_what_is_there(module):
    stubs = stubbed(module)
    actual = {name for name in vars(module) if not name.startswith("__")}
    assert set(stubs) == actual
    for name, described in stubs.items():
        thing = getattr(module, name)
        if inspect.isclass(thing):
            assert described == {one for one in vars(thing) if not one.startswith("_")} - ({"args"} if thing is sb.Cancelled else set()), name
        elif described and "arg0" not in thing.__doc__:
            signature = thing.__doc__.split("->")[0]
            assert all(f"{argument}: " in signature for argument in described), (name, signature)


def test_defaults_are_those_of_the_signatures():
    defaults = sb.defaults()
    assert json.loads(json.dumps(defaults, allow_nan=False)).keys() == defaults.keys()
    for function in (sb.viewshed, sb.viewsheds, sb.line_of_sight, sb.lines_of_sight, sb.error_surfaces, sb.read_dem, sb.ErrorModel.__init__):
        for name, parameter in inspect.signature(function).parameters.items():
            if name in defaults and name != "terrain_table":
                assert parameter.default == defaults[name], (function, name)
    assert defaults["terrain_table"] == sb.terrain_table() and defaults["max_distance"] is None


def test_viewshed_and_viewsheds_take_the_same_arguments():
    assert inspect.signature(sb.viewshed).parameters == inspect.signature(sb.viewsheds).parameters


def test_every_argument_is_described():
    for function in (sb.viewshed, sb.error_surfaces, sb.read_dem, sb.estimate_error):
        described = inspect.getdoc(function)
        for name in inspect.signature(function).parameters:
            assert f"{name}:" in described or f"{name}, " in described, (function, name)
    described = inspect.getdoc(sb.ErrorModel)
    assert all(f"{name}:" in described for name in inspect.signature(sb.ErrorModel).parameters)


def test_a_table_is_a_copy():
    sb.terrain_table()["craggy"] = 99
    assert sb.terrain_table()["craggy"] != 99


@pytest.mark.parametrize("content, name", [('{"moor": 0.6, "scree": 2}', "table.json"), ("class,metres\nmoor,0.6\nscree,2\n", "table.csv")])
def test_a_terrain_table_from_a_file(tmp_path, content, name):
    (tmp_path / name).write_text(content)
    model = sb.ErrorModel(0.5, terrain_types="types.gpkg", terrain_field="kind", terrain_table=tmp_path / name)
    assert model.terrain_table == {"moor": 0.6, "scree": 2.0} and (model.terrain_types, model.terrain_field) == ("types.gpkg", "kind")


def test_viewsheds_are_lazy_and_check_at_once():
    dem = sb.Dem(np.zeros((30, 30)), (0, 10, 0, 300, 0, -10))
    with pytest.raises(ValueError, match="observer_height"):
        sb.viewsheds(dem, [(105, 105)], observer_height="tall")
    heard = []
    results = sb.viewsheds(dem, [(105, 105), (205, 205)], max_distance=30, progress=heard.append, names=["north", "south"])
    assert heard == []
    first = next(results)
    assert heard and heard[-1] < 1 and first.shape < dem.shape
    second = next(results)
    assert heard == sorted(heard) and heard[-1] == 1.0 and next(results, None) is None
    assert [one.report["observers"][0]["name"] for one in (first, second)] == ["north", "south"]
    alone = sb.viewshed(dem, [(205, 205)], max_distance=30)
    assert np.array_equal(second.confidence, alone.confidence, equal_nan=True)
    assert second.report["error_model"] == alone.report["error_model"]


def test_many_lines_and_one():
    dem = sb.Dem(np.random.default_rng(5).normal(0, 3, (30, 30)), (0, 10, 0, 300, 0, -10))
    observers, targets = [(105, 105), (55, 205)], [(205, 245), (215, 15)]
    lines = sb.lines_of_sight(dem, observers, targets, observer_height=[2, 3])
    for line, observer, target, height in zip(lines, observers, targets, (2, 3)):
        alone = sb.line_of_sight(dem, observer, target, observer_height=height)
        assert (line.p, line.k, line.critical, line.verdict) == (alone.p, alone.k, alone.critical, alone.verdict)
        assert line.verdict in (0, 1, 2) and line.report["error_model"] == alone.report["error_model"]
