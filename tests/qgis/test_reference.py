# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/qgis_reference.md says what the algorithms say."""

import importlib.util

from conftest import ROOT


def test_reference_is_up_to_date(provider):
    path = ROOT / "scripts" / "write_qgis_reference.py"
    spec = importlib.util.spec_from_file_location("write_qgis_reference", path)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    written = script.TARGET.read_text(encoding="utf-8")
    assert written == script.reference(provider), f"write it anew: {script.__doc__}"


def test_help_links_lead_to_the_page_on_qgis(provider):
    text = (ROOT / "docs" / "qgis.md").read_text(encoding="utf-8")
    for name in (one.name() for one in provider.algorithms() if one.name().islower()):
        assert (
            provider.algorithm(name).helpUrl().endswith(f"docs/qgis.md#{name}") and f"\n## {name}\n" in text
        )
