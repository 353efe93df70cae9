# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependencies point down only, and a few promises of the whole tree that no compiler checks."""

import ast
import re

import pytest
from project import ROOT, files, texts

# What each layer of cpp/ may include besides itself.
BENEATH = {
    "base": set(),
    "terrain": {"base"},
    "earth": {"base", "terrain"},
    "error_model": {"base", "terrain", "earth"},
    "volume": {"base", "terrain", "earth", "error_model"},
    "sight": {"base", "terrain", "earth", "error_model", "volume"},
    "simplify": {"base", "terrain", "volume"},
    "verify": {"base", "terrain"},
    "io": {"base", "terrain", "earth", "error_model"},
    "jobs": {"base", "terrain", "earth", "error_model", "volume", "sight", "simplify", "verify", "io"},
}
# Third-party headers that only one layer may know.
ONLY_IN = {
    r"(gdal\w*|cpl_\w+|ogr\w*|proj\w*)(\.h|/.*)": "io",
    r"GeographicLib/.*": "earth",
    r"CGAL/.*": "terrain",
    r"expat\.h": "io",
    r"openvdb/.*": "volume",
}
FORBIDDEN_IN_CORE = r"(pybind11/|Python\.h|Q[A-Z]|qgs|iostream$)"

INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)
PRINTING = re.compile(r"\b(std::)?(cout|cerr|clog|printf|fprintf|puts|fputs|perror)\b")


def core_sources():
    return list(files("cpp", suffixes={".h", ".cpp"}))


def layer_of(path):
    return path.relative_to(ROOT / "cpp").parts[0]


def code_only(text):
    """C++ without comments and string literals."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(\\.|[^"\\\n])*"', "", text, flags=re.DOTALL)


def test_every_layer_is_known():
    assert {layer_of(path) for path in core_sources()} == set(BENEATH)


@pytest.mark.parametrize("layer", BENEATH)
def test_a_layer_includes_only_layers_beneath_it(layer):
    wrong = []
    for path in core_sources():
        if layer_of(path) != layer:
            continue
        for quote, header in INCLUDE.findall(path.read_text(encoding="utf-8")):
            if quote != '"':
                continue
            assert (ROOT / "cpp" / header).is_file(), f'{path}: "{header}" is not relative to cpp/'
            if header.split("/")[0] not in BENEATH[layer] | {layer}:
                wrong.append(f"{path.relative_to(ROOT)} includes {header}")
    assert not wrong


def test_who_simplifies_and_who_verifies_do_not_know_each_other():
    """A proof that shares code with what it proves shares its mistakes."""
    assert "simplify" not in BENEATH["verify"]
    assert "verify" not in BENEATH.get("simplify", set())


@pytest.mark.parametrize("layer", BENEATH)
def test_cmake_links_what_the_diagram_allows(layer):
    text = (ROOT / "cpp" / layer / "CMakeLists.txt").read_text(encoding="utf-8")
    uses = re.search(r"\bUSES\s+([a-z_\s]+?)(?=\n?\s*(LIBRARIES|SOURCES|\)))", text)
    assert set(uses.group(1).split() if uses else ()) <= BENEATH[layer]


@pytest.mark.parametrize("layer", BENEATH)
def test_cmake_lists_every_source(layer):
    folder = ROOT / "cpp" / layer
    listed = set(re.findall(r"[\w/]+\.cpp", (folder / "CMakeLists.txt").read_text(encoding="utf-8")))
    assert listed == {str(path.relative_to(folder)) for path in folder.rglob("*.cpp")}


def test_libraries_stay_in_their_layer():
    wrong = []
    for path in core_sources():
        for _, header in INCLUDE.findall(path.read_text(encoding="utf-8")):
            wrong += [f"{path.relative_to(ROOT)} includes {header}, which only cpp/{home} may"
                      for pattern, home in ONLY_IN.items()
                      if re.fullmatch(pattern, header) and layer_of(path) != home]
            if re.match(FORBIDDEN_IN_CORE, header):
                wrong.append(f"{path.relative_to(ROOT)} includes {header}")
    assert not wrong


def test_openvdb_stays_inside_the_volume():
    """cpp/volume shows OpenVDB to nobody: of its headers only vdb*.h include it, and only its sources include those."""
    inner = re.compile(r"volume/vdb\w*\.h")
    wrong = []
    for path in core_sources():
        name = str(path.relative_to(ROOT / "cpp"))
        if inner.fullmatch(name) or (layer_of(path) == "volume" and path.suffix == ".cpp"):
            continue
        wrong += [f"{name} includes {header}" for _, header in INCLUDE.findall(path.read_text(encoding="utf-8"))
                  if header.startswith("openvdb/") or inner.fullmatch(header)]
    assert not wrong


def test_the_core_does_not_print():
    wrong = [str(path.relative_to(ROOT)) for path in core_sources()
             if PRINTING.search(code_only(path.read_text(encoding="utf-8")))]
    assert not wrong


def test_only_bindings_know_pybind11():
    wrong = [str(path) for path, text in texts()
             if path.suffix in {".h", ".cpp"} and path.parts[0] != "bindings" and "<pybind11/" in text]
    assert not wrong


def imports(path):
    """(dots, module) of every import of a Python file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((0, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.level, node.module or ""


def test_the_python_package_knows_neither_qgis_nor_gdal():
    wrong = [f"{path.relative_to(ROOT)} imports {name}"
             for path in files("bindings", suffixes={".py"})
             for dots, name in imports(path)
             if dots == 0 and name.split(".")[0] in {"qgis", "osgeo", "PyQt5", "PyQt6"}]
    assert not wrong


def test_the_plugin_imports_itself_relatively():
    names = {path.stem for path in files("qgis_plugin", suffixes={".py"})} | {"sightbound_qgis", "qgis_plugin"}
    names -= {"__init__"}
    wrong = [f"{path.relative_to(ROOT)} imports {name}"
             for path in files("qgis_plugin", suffixes={".py"})
             for dots, name in imports(path)
             if dots == 0 and name.split(".")[0] in names]
    assert not wrong


def test_sources_begin_with_their_licence():
    wanted = {".cpp", ".h", ".py", ".pyi", ".sh", ".cmake"}
    wrong = []
    for path, text in texts():
        if path.suffix in wanted or path.name in {"CMakeLists.txt", "run"}:
            if not any("SPDX-License-Identifier: GPL-3.0-or-later" in line for line in text.splitlines()[:2]):
                wrong.append(str(path))
    assert not wrong


def test_nothing_names_a_machine():
    """No path of somebody's machine: the tree must work wherever it is cloned."""
    ours = re.compile(r"(?<![\w.~])/(home|root|work|Users|opt|mnt|srv)/[\w.]")
    wrong = [f"{path}:{number}: {line.strip()}"
             for path, text in texts() if path.name not in {"LICENSE", "test_layers.py"}
             for number, line in enumerate(text.splitlines(), 1) if ours.search(line)]
    assert not wrong


def test_documents_that_are_named_exist():
    """A comment that sends the reader to docs/x.md must not send him nowhere; a bare x.md may lie anywhere."""
    named = re.compile(r"(?<![\w/.])((?:[\w-]+/)*[\w-]+\.md)\b")
    bare = {path.name for path in files() if path.suffix == ".md"}
    wrong = [f"{path} names {name}"
             for path, text in texts()
             if path.suffix in {".h", ".cpp", ".py", ".sh", ".cmake", ".md", ".txt"} and path.name != "test_layers.py"
             for name in named.findall(text)
             if name not in bare and not any((folder / name).is_file() for folder in (ROOT, (ROOT / path).parent, ROOT / "docs"))]
    assert not wrong


def test_nothing_is_left_undone():
    wrong = [f"{path}:{number}: {line.strip()}"
             for path, text in texts() if path.suffix in {".h", ".cpp", ".py", ".sh", ".cmake", ".txt", ".md"}
             for number, line in enumerate(text.splitlines(), 1)
             if path.name != "test_layers.py" and re.search(r"\b(TODO|FIXME|XXX|HACK)\b", line)]
    assert not wrong
