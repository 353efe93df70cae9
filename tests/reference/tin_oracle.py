# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of sight and any TIN, triangle by triangle: what docs/guarantees.md says of lines in the error volume, error along the normal.

    sigma_s = the largest of sigma_v |cos| + sigma_h |sin| of the faces around a vertex, linear on each face
    k(x)    = distance of x from the nearest place of any face / (sigma_s + sigma_g) there
    zone    = the places of a line nearer to an end than 1.5 L, L the median edge: sigma_g alone, at least 1 mm

Lines are straight: no Earth.
"""
from __future__ import annotations

import numpy as np

from error_oracle import geologic

END_ZONE = 1.5                                   # L
END_PLACES = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 3 / 4)  # L
AT_END = 1e-4                                    # L: the end itself
FLOOR = 0.001                                    # metres
_PAIRS = 1_000_000                               # places x faces looked at together


class TinOracle:
    def __init__(self, vertices, faces, sigma_v=0.1, sigma_h=0.0, delta=0.0, model="gaussian", range_m=None):
        self.vertices, self.faces = np.asarray(vertices, float), np.asarray(faces)
        self.corner = self.vertices[self.faces]                                   # [face, corner, xyz]
        a, b, c = np.moveaxis(self.corner, 1, 0)
        normal = np.cross(b - a, c - a)
        self.normal = normal / np.linalg.norm(normal, axis=1)[:, None]
        edges = np.linalg.norm(self.corner - np.roll(self.corner, -1, axis=1), axis=2)
        self.L = float(np.sort(edges, axis=None)[edges.size // 2])                # the longer of two in the middle
        ends = np.sort(np.stack([self.faces, np.roll(self.faces, -1, axis=1)], -1), axis=2).reshape(-1, 2)
        _, which, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
        self.is_border = (count[which.ravel()] == 1).reshape(-1, 3)               # edge i, from corner i to the next
        self.delta, self.model, self.range_m = delta, model, range_m
        sigma_v = np.broadcast_to(np.asarray(sigma_v, float), len(self.vertices))
        self.sigma_s = np.zeros(len(self.vertices))
        for corner in range(3):
            v = self.faces[:, corner]
            of_face = sigma_v[v] * np.abs(self.normal[:, 2]) + sigma_h * np.hypot(self.normal[:, 0], self.normal[:, 1])
            np.maximum.at(self.sigma_s, v, of_face)

    # ---- crossings

    def crossings(self, start, end):
        """The shares t of the line, ascending, at which it goes through a face (its plane, within its three edges)."""
        along = end - start
        a, b, c = np.moveaxis(self.corner, 1, 0)
        speed = self.normal @ along
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.einsum("fx,fx->f", self.normal, a - start) / speed
        t[speed == 0] = np.inf   # along the plane
        at = start + np.where(np.isfinite(t), t, 0)[:, None] * along
        inside = np.ones(len(t), bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.einsum("fx,fx->f", np.cross(q - p, at - p), self.normal) >= 0
        return np.sort(t[inside & (t >= 0) & (t <= 1)])

    def inside(self, place):
        """Of closed bodies: the faces go round the place once, not never (van Oosterom and Strackee 1983)."""
        a, b, c = (self.corner[:, i] - place for i in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        top = np.einsum("fx,fx->f", a, np.cross(b, c))
        bottom = la * lb * lc + np.sum(a * b, 1) * lc + np.sum(b * c, 1) * la + np.sum(c * a, 1) * lb
        return abs(np.arctan2(top, bottom).sum()) > np.pi

    # ---- distances

    def nearest(self, places, most=np.inf):
        """(distance, sigma_s, sigma_g, whether it is a border) of the nearest place of any face, for each place.

        (inf, 0, 0, False) when it is further than `most`."""
        places = np.atleast_2d(places)
        faces = self._within(places, most)
        if faces.size == 0:
            nothing = np.zeros(len(places))
            return nothing + np.inf, nothing, nothing, nothing > 0
        step = max(1, _PAIRS // faces.size)
        parts = [self._nearest(places[i:i + step], faces) for i in range(0, len(places), step)]
        distance, sampling, between, border = (np.concatenate(column) for column in zip(*parts))
        return np.where(distance > most, np.inf, distance), sampling, between, border

    def _within(self, places, most):
        """Faces that come within `most` of some place, and perhaps more."""
        middle = self.corner.mean(1)
        radius = np.linalg.norm(self.corner - middle[:, None], axis=2).max(1)
        low, high = places.min(0), places.max(0)
        beside = np.linalg.norm(np.maximum(np.maximum(low - middle, middle - high), 0), axis=1)
        near = np.flatnonzero(beside <= most + radius)
        away = np.linalg.norm(places[:, None] - middle[None, near], axis=2).min(0)
        return near[away <= most + radius[near]]

    def _nearest(self, places, faces):
        x, corner, normal = places[:, None], self.corner[None, faces], self.normal[faces]
        height = np.einsum("pfx,fx->pf", x - corner[:, :, 0], normal)
        foot = x - height[..., None] * normal
        best, where = np.full(height.shape, np.inf), np.zeros(foot.shape)
        inside = np.ones(height.shape, bool)
        for i in range(3):
            p, q = corner[:, :, i], corner[:, :, (i + 1) % 3]
            edge = q - p
            inside &= np.einsum("pfx,fx->pf", np.cross(edge, foot - p), normal) >= 0
            share = np.clip(np.sum((x - p) * edge, 2) / np.sum(edge * edge, 2), 0, 1)
            on_edge = p + share[..., None] * edge
            distance = np.linalg.norm(x - on_edge, axis=2)
            nearer = distance < best
            best[nearer], where[nearer] = distance[nearer], on_edge[nearer]
        best[inside], where[inside] = np.abs(height[inside]), foot[inside]
        which, rows = np.argmin(best, axis=1), np.arange(len(places))
        face, where = faces[which], where[rows, which]
        return best[rows, which], *self._errors(face, where), self._at_border(face, where)

    def _at_border(self, face, where):
        """Does the place lie on an edge that no other face has?"""
        on = np.zeros(len(face), bool)
        for i in range(3):
            p, q = self.corner[face, i], self.corner[face, (i + 1) % 3]
            beside = np.linalg.norm(np.cross(q - p, where - p), axis=1) / np.linalg.norm(q - p, axis=1)
            on |= self.is_border[face, i] & (beside < 1e-9)
        return on

    def _errors(self, face, where):
        p = self.corner[face]
        areas = [np.linalg.norm(np.cross(p[:, (i + 1) % 3] - where, p[:, (i + 2) % 3] - where), axis=1) for i in range(3)]
        weight = np.stack(areas, 1) / np.sum(areas, 0)[:, None]
        sampling = np.sum(weight * self.sigma_s[self.faces[face]], 1)
        d = np.linalg.norm(where[:, None] - p, axis=2).min(1)
        between = np.array([geologic(one, self.delta, self.model, self.range_m) for one in d]) if self.delta else np.zeros(len(d))
        return sampling, between

    # ---- what a claim at the quantile z says of the line

    def refutes_visible(self, start, end, z, samples):
        """Why the line is not clear of every surface within z sigma, or None."""
        length = float(np.linalg.norm(end - start))
        t = self.crossings(start, end)
        t = t[(t * length > AT_END * self.L) & ((1 - t) * length > AT_END * self.L)]
        if t.size:
            return f"it goes through a face at {t[0] * length:.3f} of {length:.3f} m"
        zone = END_ZONE * self.L / length
        s = np.linspace(zone, 1 - zone, samples) if zone < 0.5 else np.zeros(0)
        at_end = np.array([f * self.L / length for f in END_PLACES] if self.delta else [])
        at_end = np.concatenate([at_end[at_end < min(zone, 1)], 1 - at_end[at_end < min(zone, 1)]])
        for places, share in ((s, 1.0), (at_end, 0.0)):
            if places.size == 0:
                continue
            distance, sampling, between, _ = self.nearest(start + places[:, None] * (end - start), self._reach(z))
            k = distance / np.maximum(share * sampling + between, FLOOR)
            if k.min() < z:
                return f"k is {k.min():.4f} at {places[k.argmin()] * length:.3f} of {length:.3f} m"
        return None

    def refutes_hidden(self, start, end, z, step, solid):
        """Why a surface within z sigma lets the line pass, or None. Looked at every `step` metres.

        Sheets: the line must go through a face, and be z sigma away before and after, from faces, not from their borders. Solids: somewhere
        z sigma inside. Within the end zones sigma_g alone counts."""
        length = float(np.linalg.norm(end - start))
        t = self.crossings(start, end)
        began_inside = solid and self.inside(start)
        if t.size == 0 and not began_inside:
            return "it meets no face"
        s = np.linspace(0, 1, int(length / step) + 3)
        step = length * s[1]            # what lies between two of these places is no further than this from one
        distance, sampling, between, border = self.nearest(start + s[:, None] * (end - start), self._reach(z) + step)
        zone = END_ZONE * self.L / length
        in_zone = (s < zone) | (s > 1 - zone)
        clear = distance + step >= z * np.maximum(np.where(in_zone, 0, sampling) + between, FLOOR)
        if solid:
            crossed = np.searchsorted(t, s) + began_inside
            return None if np.any(clear & ((crossed % 2 == 1) | (distance <= step))) else "it is nowhere deep enough inside"
        faces_nearest = ~border
        faces_nearest[1:] |= ~border[:-1]
        faces_nearest[:-1] |= ~border[1:]
        clear &= faces_nearest
        if not np.any(clear & (s <= t[-1])) or not np.any(clear & (s >= t[0])):
            return "it does not come clear of the faces on both sides"
        return None

    def _reach(self, z):
        """Further away no face matters."""
        longest = np.linalg.norm(self.corner - np.roll(self.corner, -1, axis=1), axis=2).max()
        between = geologic(longest, self.delta, self.model, self.range_m) if self.delta else 0.0
        return z * max(self.sigma_s.max() + between, FLOOR)
