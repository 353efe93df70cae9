# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw demo_output/map.png and say in words what the run found: draw_demo_map.py <demo_output> <dem>."""

import json
import sys
import tempfile
from pathlib import Path

import maps
from osgeo import ogr

ogr.UseExceptions()


def summary(results, observers_path):
    """Lines that tell the areas and shares of the whole run, then of each observer."""
    lines = ["Seen from any of the observers, within 15 km, target 2 m above ground, at 95 % confidence:"]
    for word in ("visible", "uncertain", "hidden"):
        area, share = results[f"AREA_{word.upper()}"], results[f"SHARE_{word.upper()}"]
        lines.append(f"  {word:<10}{area / 1e6:8.1f} km²  {100.0 * share:5.1f} %")
    lines.append("Each observer by itself:")
    source = ogr.Open(str(observers_path))
    for feature in source.GetLayer(0):
        areas = [feature.GetField(f"{word}_m2") / 1e6 for word in ("visible", "uncertain", "hidden")]
        lines.append("  {:<15}visible {:6.1f} km²   uncertain {:6.1f} km²   hidden {:6.1f} km²".format(
            feature.GetField("name"), *areas))
    return lines


def draw(folder, dem, results):
    with tempfile.TemporaryDirectory() as scratch:
        relief = maps.hillshade(dem, scratch)
        observers = maps.points(folder / "observers.gpkg", "Observer", "name")
        confidence = maps.raster(folder / "confidence.tif", "Confidence of being seen", folder / "confidence.qml")
        verdict = maps.raster(folder / "verdict.tif", "Verdict at 95 %", folder / "verdict.qml")
        share = {word: 100.0 * results[f"SHARE_{word.upper()}"] for word in ("visible", "uncertain", "hidden")}
        maps.write_page(
            folder / "map.png",
            "What can be seen from here, and how sure are we?",
            [
                maps.Panel([observers, confidence, relief], "Confidence", "How sure it is that a 2 m target at the "
                           "place is seen by at least one observer."),
                maps.Panel([observers, verdict, relief], "Verdict",
                           "Visible {visible:.1f} %, uncertain {uncertain:.1f} %, hidden {hidden:.1f} % of what was "
                           "asked (15 km around each observer).".format(**share)),
            ],
            [observers, confidence, verdict],
            footer="Terrain: U.S. Geological Survey, public domain. Its error was estimated from the DEM itself.",
        )


def main():
    folder, dem = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    results = json.loads((folder / "result.json").read_text(encoding="utf-8"))["results"]
    application = maps.start()
    draw(folder, dem, results)
    print("\n".join(summary(results, folder / "observers.gpkg")))
    print(f"Left in {folder}:")
    for name, what in (
        ("map.png", "the map"),
        ("confidence.tif", "0 surely hidden … 1 surely visible (style: confidence.qml)"),
        ("verdict.tif", "0 hidden, 1 uncertain, 2 visible (style: verdict.qml)"),
        ("observers.gpkg", "the observers with the areas each one sees"),
        ("result.json", "what qgis_process reported"),
    ):
        print(f"  {name:<16}{what}")
    sys.stdout.flush()
    maps.stop(application)


if __name__ == "__main__":
    main()
