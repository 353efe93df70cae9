# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/qgis_reference.md, the reference of the QGIS algorithms, from the algorithms themselves.

    PYTHONPATH=build/python:build/qgis_plugins /usr/bin/python3 scripts/write_qgis_reference.py

tests/qgis/test_reference.py tells when that has to be done.
"""

import os
import re
from pathlib import Path

from qgis.core import QgsProcessingParameterDefinition, QgsProcessingParameterEnum

TARGET = Path(__file__).resolve().parent.parent / "docs" / "qgis_reference.md"
HEAD = """# The QGIS algorithms

Provider *Sightbound*, groups *Visibility*, *Error volume* and *Simplification*. Written by `scripts/write_qgis_reference.py` from the algorithms; the same
texts are the help in QGIS. Parameters marked *dynamic* take a number, a field or an expression. In `qgis_process` and
`processing.run` give them by the names in the first column; words such as `LE90` are given as they are.
"""


def reference(provider):
    """The whole page."""
    names = (
        "confidenceviewshed", "probableviewshed", "errorsurfaces", "estimateerror", "lineofsightprofile", "intervisibility",
        "builderrorvolume", "volumeviewshed", "volumetargets", "subtractobserver", "volumetoraster",
        "demtotin",
        "simplifytin",
        "verifytin",
    )
    return HEAD + "".join(section(provider.algorithm(name)) for name in names)


def section(algorithm):
    about = re.sub(r"</?(b|i)>", "*", algorithm.shortHelpString())
    about = re.sub(r"</?p>", "\n", about)
    lines = [f"\n## {algorithm.name()}\n", "\n".join(line.strip() for line in about.strip().splitlines())]
    parameters = algorithm.parameterDefinitions()
    advanced = QgsProcessingParameterDefinition.Flag.FlagAdvanced
    for title, rows in (
        ("Parameters", [one for one in parameters if not one.isDestination() and not one.flags() & advanced]),
        ("Advanced parameters", [one for one in parameters if one.flags() & advanced]),
        ("Layers and files written", [one for one in parameters if one.isDestination()]),
    ):
        lines += [f"\n### {title}\n", "| name | default | what |", "|---|---|---|", *map(row, rows)]
    written = {one.name() for one in parameters}
    values = [one for one in algorithm.outputDefinitions() if one.name() not in written]
    lines += ["\n### Values returned\n", *(f"- `{one.name()}`: {one.description()}" for one in values)]
    return "\n".join(lines) + "\n"


def row(parameter):
    what = parameter.help()
    if isinstance(parameter, QgsProcessingParameterEnum):
        what = f"*{' / '.join(parameter.options())}.* {what}"
    if parameter.isDynamic():
        what = f"*Dynamic.* {what}"
    value = parameter.defaultValue()
    if parameter.isDestination():
        shown = "" if parameter.createByDefault() else "not written"
    elif isinstance(value, list):
        shown = "see there"
    elif value is None or value == "":
        shown = "" if parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagOptional else "*needed*"
    else:
        shown = f"{value:g}" if isinstance(value, float) else str(value)
    return f"| `{parameter.name()}` | {shown} | {what.replace('|', chr(92) + '|')} |"


def main():
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    from sightbound_qgis.plugin import SightboundPlugin

    plugin = SightboundPlugin(None)
    plugin.initProcessing()
    TARGET.write_text(reference(plugin.provider), encoding="utf-8")
    plugin.unload()
    application.exitQgis()


if __name__ == "__main__":
    main()
