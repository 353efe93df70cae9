# SPDX-License-Identifier: GPL-3.0-or-later
"""How well probabilities of sight agree with what was truly seen. Cells of one view are not independent: the uncertainty of
every share is clustered by observer."""

import numpy as np

BINS = np.array([0, 0.005, 0.025, 0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95, 0.975, 0.995])
LEVELS = (0.90, 0.95, 0.99)


def clustered_share(counts, hits):
    """Share of hits and its standard error from counts and hits by observer."""
    total = counts.sum()
    if total == 0:
        return np.nan, np.nan
    share = hits.sum() / total
    n = max(np.count_nonzero(counts), 2)
    return share, np.sqrt(n / (n - 1) * ((hits - share * counts) ** 2).sum()) / total


class Scores:
    """Of one method on one case; `add` once an observer."""

    def __init__(self):
        self.rows = []

    def add(self, p, seen):
        """`p`: probabilities; `seen`: what is true, same shape."""
        p, seen = np.asarray(p, float).ravel(), np.asarray(seen, bool).ravel()
        bins = np.digitize(p, BINS) - 1
        size = len(BINS)
        row = {
            "n": np.bincount(bins, minlength=size),
            "p": np.bincount(bins, weights=p, minlength=size),
            "seen": np.bincount(bins, weights=seen, minlength=size),
            "brier": ((p - seen) ** 2).sum(),
        }
        for level in LEVELS:
            visible, hidden = p >= (1 + level) / 2, p <= (1 - level) / 2
            row[f"visible {level}"] = (visible.sum(), (visible & seen).sum())
            row[f"hidden {level}"] = (hidden.sum(), (hidden & ~seen).sum())
        self.rows.append(row)

    def summary(self):
        rows = self.rows
        n = np.array([row["n"].sum() for row in rows])
        out = {"observers": len(rows), "cells": int(n.sum()), "brier": sum(row["brier"] for row in rows) / n.sum(),
               "seen": sum(row["seen"].sum() for row in rows) / n.sum(), "claims": {}, "bins": []}
        for level in LEVELS:
            claim = {}
            for kind in ("visible", "hidden"):
                counts, hits = (np.array([row[f"{kind} {level}"][i] for row in rows]) for i in (0, 1))
                right, error = clustered_share(counts, hits)
                by_observer = (hits / counts)[counts >= 50] if len(counts) else np.array([])
                claim[kind] = {"share": counts.sum() / n.sum(), "right": right, "se": error,
                               "worst": float(by_observer.min()) if by_observer.size else None}
            claim["uncertain"] = 1 - claim["visible"]["share"] - claim["hidden"]["share"]
            out["claims"][str(level)] = claim
        for i in range(len(BINS)):
            counts, hits = (np.array([row[key][i] for row in rows]) for key in ("n", "seen"))
            if counts.sum() == 0:
                continue
            share, error = clustered_share(counts, hits)
            out["bins"].append({"p": sum(row["p"][i] for row in rows) / counts.sum(), "seen": share, "se": error,
                                "cells": int(counts.sum())})
        return out
