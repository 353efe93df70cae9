#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns the results of calibrate.py into tables and a summary (Markdown, to standard output) and reliability diagrams (SVG).

    benchmarks/calibration/report.py calibration.json --diagrams docs/images/calibration.svg
"""

import argparse
import json
from pathlib import Path

SIZE, GAP, LEFT, TOP = 150, 22, 34, 30
COLOURS = {"ordinary": "#888888", "pointwise": "#d95f02", "probable": "#1b6ca8"}


def percent(value, digits=1):
    return "–" if value is None or value != value else f"{100 * value:.{digits}f}"


def name_of(case):
    noise = f", {case['noise_m']:g} m error" if case["noise_m"] else ""
    told = ", told" if case["told"] else ""
    return f"{case['terrain']}, {case['factor']} × {case['cells']}{told}{noise}"


def claim_table(cases, level):
    print("| terrain | seen | visible: ordinary | pointwise | probable ± s.e. (worst view) | hidden: ordinary | pointwise | probable "
          "| uncertain: pointwise | probable | Brier: ordinary | pointwise | probable |")
    print("|---" * 13 + "|")
    for case in cases:
        o, p, q = (case["methods"][name] for name in COLOURS)
        co, cp, cq = (one["claims"][level] for one in (o, p, q))
        print(f"| {name_of(case)} | {percent(q['seen'])} | {percent(co['visible']['right'])} | {percent(cp['visible']['right'])} | "
              f"**{percent(cq['visible']['right'])}** ± {percent(cq['visible']['se'])} ({percent(cq['visible']['worst'], 0)}) | "
              f"{percent(co['hidden']['right'], 2)} | {percent(cp['hidden']['right'], 2)} | **{percent(cq['hidden']['right'], 2)}** | "
              f"{percent(cp['uncertain'])} | **{percent(cq['uncertain'])}** | {o['brier']:.4f} | {p['brier']:.4f} | **{q['brier']:.4f}** |")


def level_table(cases, levels):
    print("| terrain | " + " | ".join(f"visible at {100 * float(v):g} %" for v in levels) + " | "
          + " | ".join(f"hidden at {100 * float(v):g} %" for v in levels) + " |")
    print("|---" * (1 + 2 * len(levels)) + "|")
    for case in cases:
        claims = case["methods"]["probable"]["claims"]
        cells = [f"{percent(claims[v][kind]['right'], 2)} of {percent(claims[v][kind]['share'])}"
                 for kind in ("visible", "hidden") for v in levels]
        print(f"| {name_of(case)} | " + " | ".join(cells) + " |")


def listed(cases, holds):
    """How many hold, and which do not."""
    failing = [name_of(case) for case in cases if not holds(case)]
    return f"{len(cases) - len(failing)} of {len(cases)}" + (f" (not: {'; '.join(failing)})" if failing else "")


def bin_holds(one):
    return abs(one["p"] - one["seen"]) <= 0.03 + 2 * one["se"]


def median_and_range(values):
    ordered = sorted(values)
    return f"{ordered[0]:.2f} to {ordered[-1]:.2f}, median {ordered[len(ordered) // 2]:.2f}"


def summary(cases, levels):
    """What holds, and what does not. A claim that nowhere was made holds."""
    probable = {id(case): case["methods"]["probable"] for case in cases}
    for kind in ("visible", "hidden"):
        for level in levels:
            def right(case):
                share = probable[id(case)]["claims"][level][kind]["right"]
                return share is None or share != share or share >= float(level)
            print(f"- {kind} at {100 * float(level):g} %: holds in {listed(cases, right)}")
    bins = {id(case): [b for b in probable[id(case)]["bins"] if b["cells"] >= 200] for case in cases}
    print(f"- every bin of 200 cells within three points and two standard errors: "
          f"{listed(cases, lambda case: all(map(bin_holds, bins[id(case)])))}")
    every = [b for case in cases for b in bins[id(case)]]
    print(f"- bins that hold: {sum(map(bin_holds, every))} of {len(every)}")
    off = {id(case): sum(b["cells"] * (b["seen"] - b["p"]) for b in bins[id(case)] if 0.05 < b["p"] < 0.95)
           / max(1, sum(b["cells"] for b in bins[id(case)] if 0.05 < b["p"] < 0.95)) for case in cases}
    print("- seen less claimed, mean over bins from 0.05 to 0.95: "
          + "; ".join(f"{name_of(case)} {off[id(case)]:+.2f}" for case in sorted(cases, key=lambda case: off[id(case)])))
    print(f"- samples or means told apart: {listed(cases, lambda case: case['learnt']['samples_or_means'] == case['cells'])}")

    def ratio(of, over):
        return median_and_range([of(case["methods"]["probable"]) / over(case["methods"]) for case in cases])

    print("- uncertain at 95 % over pointwise: " + ratio(
        lambda one: one["claims"]["0.95"]["uncertain"], lambda methods: methods["pointwise"]["claims"]["0.95"]["uncertain"]))
    print("- Brier score over ordinary: " + ratio(lambda one: one["brier"], lambda methods: methods["ordinary"]["brier"]))
    print("- Brier score over pointwise: " + ratio(lambda one: one["brier"], lambda methods: methods["pointwise"]["brier"]))


def diagram(case, left, top):
    """Share seen against probability claimed, with two clustered standard errors."""
    def x(p):
        return left + SIZE * p

    def y(share):
        return top + SIZE * (1 - share)

    out = [f'<rect x="{left}" y="{top}" width="{SIZE}" height="{SIZE}" fill="#fbfbf8" stroke="#999"/>',
           f'<path d="M{x(0)} {y(0)} L{x(1)} {y(1)}" stroke="#bbb" stroke-dasharray="4 3"/>',
           f'<text x="{left}" y="{top - 6}" font-size="{10.5 if len(name_of(case)) <= 28 else 8.5}">{name_of(case)}</text>']
    for text, at in (("0", 0), ("1", 1)):
        out.append(f'<text x="{x(at) - 3}" y="{top + SIZE + 12}" font-size="9" fill="#555">{text}</text>')
    for name in ("pointwise", "probable"):
        bins = [b for b in case["methods"][name]["bins"] if b["cells"] >= 50]
        points = " ".join(f"{x(b['p']):.1f},{y(b['seen']):.1f}" for b in bins)
        out.append(f'<polyline points="{points}" fill="none" stroke="{COLOURS[name]}" stroke-width="1.6"/>')
        for b in bins:
            if name == "probable":
                low, high = max(b["seen"] - 2 * b["se"], 0), min(b["seen"] + 2 * b["se"], 1)
                out.append(f'<path d="M{x(b["p"]):.1f} {y(low):.1f} V{y(high):.1f}" stroke="{COLOURS[name]}" stroke-width="0.8"/>')
            out.append(f'<circle cx="{x(b["p"]):.1f}" cy="{y(b["seen"]):.1f}" r="2" fill="{COLOURS[name]}"/>')
    return out


def draw(cases, path, across=4):
    rows = -(-len(cases) // across)
    width, height = LEFT + across * (SIZE + GAP), TOP + rows * (SIZE + GAP + 24) + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, case in enumerate(cases):
        out += diagram(case, LEFT + (i % across) * (SIZE + GAP), TOP + (i // across) * (SIZE + GAP + 24))
    y = height - 10
    out.append(f'<text x="{LEFT}" y="{y}" font-size="10.5">across: probability claimed; up: share truly seen. '
               f'<tspan fill="{COLOURS["probable"]}">probable</tspan> (two standard errors), '
               f'<tspan fill="{COLOURS["pointwise"]}">pointwise</tspan></text></svg>')
    path.write_text("\n".join(out))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path)
    parser.add_argument("--diagrams", type=Path, help="SVG to write")
    parser.add_argument("--level", default="0.95")
    options = parser.parse_args()
    cases = json.loads(options.results.read_text())
    cases.sort(key=lambda case: (case["terrain"], case["factor"], case["cells"], case["told"], case["noise_m"]))
    claim_table(cases, options.level)
    print()
    levels = ("0.9", "0.95", "0.99")
    level_table(cases, levels)
    print()
    summary(cases, levels)
    if options.diagrams:
        draw(cases, options.diagrams)


if __name__ == "__main__":
    main()
