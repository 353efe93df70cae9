# SPDX-License-Identifier: GPL-3.0-or-later
"""What a verification found as a page: figures, and a histogram of the deviation at the original's vertices."""

import html

from .pages import page, ticks
from .text import tr, upward

_WIDTH, _HEIGHT = 860, 300
_LEAST_SPAN = 1e-3  # metres from end to end
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 850, 16, 260


def write_report(path, report, tolerance):
    """`tolerance` as a text for the reader."""
    parts = [f"<p>{_sentence(report)}</p>", _table(_rows(report, tolerance))]
    if report["histogram"]["counts"]:
        parts.append(f"<h2>{tr('Deviation at the vertices of the original')}</h2>{_histogram(report['histogram'])}")
    if report["warnings"]:
        notes = "".join(f"<li>{html.escape(note)}</li>" for note in report["warnings"])
        parts.append(f"<h2>{tr('Repaired when the simplified TIN was read')}</h2><ul>{notes}</ul>")
    path.write_text(page(tr("Verification of a simplified TIN"), parts), encoding="utf-8")


def _sentence(report):
    within, formed = report["within_tolerance"], report["well_formed"]
    told = [
        _judgement(within, tr("Every place is within the tolerance."), tr("Some place is beyond the tolerance.")),
        _judgement(formed, tr("No face is flipped, folded or degenerate."), tr("There are bad faces.")),
    ]
    return " ".join(told)


def _judgement(good, yes, no):
    return f"<b class='good'>{yes}</b>" if good else f"<b class='bad'>{no}</b>"


def _rows(report, tolerance):
    deviation, ratio = report["largest_deviation"], report["largest_ratio"]
    vertical = report["method"] == "vertical"
    rows = [
        (tr("Faces of the original, of the simplified"), f"{report['faces_before']}, {report['faces_after']}"),
        (tr("Tolerance"), html.escape(tolerance)),
        (tr("Largest deviation (m), certified"), f"{upward(deviation['bound'])} {_at(deviation['place'])}"),
        (tr("Largest deviation / tolerance, certified"), f"{upward(ratio['bound'])} {_at(ratio['place'])}"),
        (tr("Mean and root mean square at the vertices (m)"), f"{report['mean_deviation']:.6g}, {report['rms_deviation']:.6g}"),
        (tr("Degenerate faces"), _faces(report["degenerate"])),
    ]
    if vertical:
        rows += [
            (tr("Flipped faces"), _faces(report["flipped"])),
            (tr("Folded faces"), _faces(report["folded"])),
            (tr("Ground of the original that is uncovered (m²)"), _area(report["uncovered"])),
            (tr("Area beyond the original (m²)"), _area(report["surplus"])),
        ]
    pieces = tr("Pieces of the overlay") if vertical else tr("Triangles looked at; bounds above the truth by at most (m)")
    rows.append((pieces, f"{report['pieces']}" + ("" if vertical else f"; {upward(report['resolution'])}")))
    return rows


def _at(place):
    return tr("at {:.2f}, {:.2f}").format(*place[:2])


def _faces(found):
    return f"{found['count']}" + (tr(", the first is {}").format(found["first"]) if found["count"] else "")


def _area(found):
    return f"{found['m2']:.6g}" + (f" {_at(found['place'])}" if found["m2"] else "")


def _table(rows):
    return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"


def _histogram(histogram):
    counts, low = histogram["counts"], histogram["low"]
    high = max(histogram["high"], low + _LEAST_SPAN)
    most = max(counts)
    width = (_RIGHT - _LEFT) / len(counts)
    parts = [f"<svg viewBox='0 0 {_WIDTH} {_HEIGHT}' role='img'>"]
    for count in ticks(0, most, 5):
        y = _BOTTOM - count / most * (_BOTTOM - _TOP)
        parts.append(f"<line class='grid' x1='{_LEFT}' x2='{_RIGHT}' y1='{y:.1f}' y2='{y:.1f}'/>")
        parts.append(f"<text x='{_LEFT - 8}' y='{y + 4:.1f}' text-anchor='end'>{count:g}</text>")
    for number, count in enumerate(counts):
        tall = count / most * (_BOTTOM - _TOP)
        x = _LEFT + number * width
        parts.append(f"<rect class='bar' x='{x:.1f}' y='{_BOTTOM - tall:.1f}' width='{width - 1:.1f}' height='{tall:.1f}'/>")
    for metres in ticks(low, high, 10):
        x = _LEFT + (metres - low) / (high - low) * (_RIGHT - _LEFT)
        parts.append(f"<text x='{x:.1f}' y='{_BOTTOM + 18}' text-anchor='middle'>{metres:g} m</text>")
    return "".join(parts) + "</svg>"
