# SPDX-License-Identifier: GPL-3.0-or-later
"""Terrain that is known finely, and the coarser DEMs that someone might have of it."""

from dataclasses import dataclass

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
SIDE = 1600  # samples: of a larger DEM its first corner is taken


@dataclass
class Truth:
    name: str
    heights: np.ndarray  # metres, NaN = unknown
    geotransform: tuple  # north up
    crs: str


def read(path, name=None, feet=False, sea=None):
    """A GDAL raster. `feet`: x, y and z are in feet; `sea`: the height that stands for water, to be left out."""
    dataset = gdal.Open(str(path))
    band = dataset.GetRasterBand(1)
    heights = band.ReadAsArray().astype(np.float32)
    nodata = band.GetNoDataValue()
    if nodata is not None:
        heights[heights == np.float32(nodata)] = np.nan
    heights[~(np.abs(heights) < 1e5)] = np.nan
    if sea is not None:
        heights[heights == np.float32(sea)] = np.nan
    geotransform, crs = dataset.GetGeoTransform(), dataset.GetProjection()
    if feet:
        heights *= 0.3048
        geotransform = (500000, geotransform[1] * 0.3048, 0, 5000000, 0, geotransform[5] * 0.3048)
        crs = "EPSG:32610"
    return Truth(name or dataset.GetDescription().rsplit("/", 1)[-1], heights[:SIDE, :SIDE], geotransform, crs)


def fractal(exponent, side=1000, cell=10.0, relief=150.0, seed=1):
    """A self-affine surface of growth exponent H by its spectrum f^-(H+1), `relief` its standard deviation in metres."""
    frequency = np.hypot(np.fft.fftfreq(side)[:, None], np.fft.fftfreq(side)[None, :])
    frequency[0, 0] = 1
    noise = np.random.default_rng(seed).normal(size=(side, side))
    surface = np.fft.ifft2(np.fft.fft2(noise) * frequency ** -(exponent + 1)).real
    heights = (surface * (relief / surface.std())).astype(np.float32)
    return Truth(f"fractal H {exponent:g}", heights, (500000, cell, 0, 5000000, 0, -cell), "EPSG:32633")


@dataclass
class Coarse:
    heights: np.ndarray
    geotransform: tuple
    crs: str
    rows: np.ndarray  # of the truth, at the coarse cells' middles
    cols: np.ndarray


def decimate(truth, factor, means, noise_m=0.0, seed=1):
    """Every `factor`-th sample, or means over factor x factor of them, with independent normal errors of `noise_m`."""
    rows, cols = (n // factor for n in truth.heights.shape)
    fine = truth.heights[: rows * factor, : cols * factor]
    if means:
        heights = fine.reshape(rows, factor, cols, factor).mean(axis=(1, 3))
        first, middle = factor // 2, (factor - 1) / 2
    else:
        heights = fine[::factor, ::factor].copy()
        first, middle = 0, 0.0
    if noise_m:
        heights = heights + np.random.default_rng(seed).normal(0, noise_m, heights.shape).astype(np.float32)
    left, dx, _, top, _, dy = truth.geotransform
    corner = middle + 0.5 - factor / 2
    geotransform = (left + dx * corner, dx * factor, 0.0, top + dy * corner, 0.0, dy * factor)
    return Coarse(heights.astype(np.float32), geotransform, truth.crs,
                  first + factor * np.arange(rows), first + factor * np.arange(cols))
