# SPDX-License-Identifier: GPL-3.0-or-later
"""The error volume: a terrain with its doubt as a hierarchy of voxels."""

from __future__ import annotations

from collections import namedtuple

from . import _arguments as arguments
from ._loading import core, volume_core
from .dem import Dem
from .error_model import ErrorModel, core_model
from .tin import Tin

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, NamedTuple, Union

    from . import _volume
    from ._arguments import Box, CreationOptions, FloatArray, Geotransform, Path, Progress

    Terrain = Union[Dem, Tin]

    class CoverRasters(NamedTuple):
        lower: FloatArray
        upper: FloatArray
        thickness: FloatArray
        geotransform: Geotransform

else:
    CoverRasters = namedtuple("CoverRasters", "lower upper thickness geotransform")
    CoverRasters.__doc__ = """float32 arrays [rows, cols], north up, a cell for each column of voxels; NaN: none there.

    lower, upper: lowest and highest place of the error volume over the cell, metres of height, rounded outward to voxels.
    thickness: of all voxels over the cell, metres; less than upper - lower where there are gaps, as under a bridge.
    geotransform: GDAL's six numbers.
    """

_DEFAULTS = core.defaults()
_PREPARED = 0.1  # share of the work that reading the terrain and resolving its error takes


class ErrorVolume:
    """The space in which the true surface may lie, in voxels: build() makes one, open() reads one.

    Made of a DEM, or of a TIN of any shape: overhangs, bridges, walls. Error is measured vertically where the terrain is
    a height field, else along the normal. The CRS must be projected, or none (metres).
    """

    __slots__ = ("_core", "_warnings")

    _core: _volume.ErrorVolume
    _warnings: list[str]

    def __init__(self) -> None:
        raise TypeError("Use ErrorVolume.build() or ErrorVolume.open().")

    @staticmethod
    def build(
        terrain: Terrain,
        error_model: ErrorModel | None = None,
        voxel: float | None = None,
        voxel_height: float | None = None,
        confidence: float = _DEFAULTS["confidence"],
        largest_confidence: float | None = None,
        extent: Box | None = None,
        threads: int | None = None,
        memory_budget: int | None = None,
        progress: Progress | None = None,
    ) -> ErrorVolume:
        """Surrounds a terrain with its error volume.

        Args:
            terrain: a Dem or a Tin.
            error_model: None estimates a DEM's error from the DEM. For a Tin, vertical_rmse (unless it has sigma_v) and
                geologic_variation must be numbers: nothing can be learnt from it.
            voxel: side of the voxels in plan, metres; None for the largest that holds the error of nine faces of ten.
            voxel_height: their height, metres; None for the side.
            confidence: the one that voxels are chosen for.
            largest_confidence: the largest that will be asked of the volume; None for 0.999, or `confidence`.
            extent: (x_min, y_min, x_max, y_max) of a Dem, snapped to its cells; None for all of it.
            threads: None for all cores. The volume does not depend on it.
            memory_budget: bytes; None for three quarters of the memory.
            progress: called with the fraction done, at most ten times a second; False cancels.

        Raises:
            ValueError: a wrong argument, a CRS in degrees.
            OSError: a file cannot be read.
            MemoryError: the volume would exceed the memory budget; the message names the voxel that fits.
            Cancelled: progress returned False.
        """
        prepared = _terrain(terrain, error_model, extent, threads, memory_budget, _first(progress))
        options = _options(voxel, voxel_height, confidence, largest_confidence, threads, memory_budget)
        return _wrapped(volume_core().build_volume(prepared, options, _second(progress)), prepared.warnings)

    @staticmethod
    def estimate(
        terrain: Terrain,
        error_model: ErrorModel | None = None,
        voxel: float | None = None,
        voxel_height: float | None = None,
        confidence: float = _DEFAULTS["confidence"],
        largest_confidence: float | None = None,
        extent: Box | None = None,
        threads: int | None = None,
        memory_budget: int | None = None,
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """What build() with the same arguments would take: voxel, voxel_height (metres), voxels, bytes at the peak.

        Raises what build() raises, but for the budget of the volume itself.
        """
        prepared = _terrain(terrain, error_model, extent, threads, memory_budget, progress)
        return prepared.need(_options(voxel, voxel_height, confidence, largest_confidence, threads, memory_budget))

    @staticmethod
    def open(path: Path, progress: Progress | None = None) -> ErrorVolume:
        """A volume that save() wrote.

        Raises:
            OSError: the file cannot be read, or is damaged.
            ValueError: it is no error volume of Sightbound.
        """
        return _wrapped(volume_core().open_volume(arguments.path("path", path), progress), [])

    def save(self, path: Path, progress: Progress | None = None) -> None:
        """Writes a .vdb file (half-float grids k_low and k_high) that open() and every OpenVDB tool reads.

        Raises:
            OSError: the file cannot be written; what stood there before stays.
        """
        self._core.save(arguments.path("path", path), progress)

    def rasters(self, confidence: float = _DEFAULTS["confidence"]) -> CoverRasters:
        """The space in which the true surface lies at this confidence, seen from above.

        Raises:
            ValueError: the confidence is not between 0 and 1, or more than largest_confidence.
        """
        return CoverRasters(*self._core.rasters(arguments.number("confidence", confidence)))

    def write(
        self,
        lower: Path | None = None,
        upper: Path | None = None,
        thickness: Path | None = None,
        confidence: float = _DEFAULTS["confidence"],
        creation_options: CreationOptions = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes rasters() as GeoTIFF; a path that is None is not written.

        Raises:
            ValueError: no path, one path twice, a confidence as rasters() refuses it. OSError: a file cannot be written.
            Cancelled: progress returned False.
        """
        files = volume_core().VolumeFiles()
        files.lower = arguments.path("lower", lower)
        files.upper = arguments.path("upper", upper)
        files.thickness = arguments.path("thickness", thickness)
        files.creation_options = arguments.creation_options(creation_options)
        self._core.write(files, arguments.number("confidence", confidence), arguments.threads(threads), progress)

    @property
    def voxel(self) -> float:
        """Side of the voxels in plan, metres."""
        return self._core.voxel_m

    @property
    def voxel_height(self) -> float:
        """Height of the voxels, metres."""
        return self._core.voxel_height_m

    @property
    def largest_confidence(self) -> float:
        """The largest confidence that can be asked of the volume."""
        return self._core.largest_confidence

    @property
    def is_height_field(self) -> bool:
        """True when error is measured vertically; False when along the normal."""
        return self._core.is_height_field

    @property
    def bounds(self) -> tuple[float, float, float, float, float, float]:
        """(x_min, y_min, z_min, x_max, y_max, z_max) of the terrain: CRS, heights metres."""
        return self._core.bounds

    @property
    def crs_wkt(self) -> str | None:
        """The CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def report(self) -> dict[str, Any]:
        """What was built.

        faces, faces_not_held (too steep or too well known for these voxels: nothing is lost there, but less is proven),
        finest_needed (voxel side that would hold all, metres), voxels, leaves, bytes (in memory), unknown_columns (no
        terrain), ambiguous_voxels (near the borders of a sheet), error_model (JSON of what was used), warnings, version
        """
        found = self._core.report()
        found["warnings"] = self._warnings + found["warnings"]
        found["error_model"] = self._core.error_model
        found["version"] = core.__version__
        return found

    def __repr__(self) -> str:
        return f"<ErrorVolume, voxels of {self.voxel:g} m>"


def core_volume(volume: Any) -> _volume.ErrorVolume:
    """The compiled side of the argument `volume`."""
    if not isinstance(volume, ErrorVolume):
        raise TypeError(
            f"volume must be a sightbound.ErrorVolume, as build() and open() return it; got {type(volume).__name__}."
        )
    return volume._core


def _terrain(
    terrain: Any, error_model: Any, extent: Any, threads: Any, memory_budget: Any, progress: Progress | None
) -> _volume.VolumeTerrain:
    if isinstance(terrain, Tin):
        if extent is not None:
            raise ValueError("extent is for a Dem; a Tin is taken as a whole.")
        return volume_core().volume_terrain_of_tin(terrain._core, model_of_tin(error_model), progress)
    if not isinstance(terrain, Dem):
        raise TypeError(f"terrain must be a sightbound.Dem or sightbound.Tin; got {type(terrain).__name__}.")
    return volume_core().volume_terrain_of_dem(
        terrain._core,
        core_model(error_model, terrain),
        arguments.extent(extent),
        arguments.threads(threads),
        arguments.memory_budget(memory_budget),
        progress,
    )


def model_of_tin(model: Any) -> core.ErrorModel:
    """The compiled side of the argument `error_model` that goes with a Tin."""
    if model is None:
        raise ValueError(
            "error_model is None, but a Tin's error cannot be learnt from it; "
            "give for example ErrorModel(vertical_rmse=0.1, geologic_variation=0)."
        )
    if not isinstance(model, ErrorModel):
        raise TypeError(f"error_model must be a sightbound.ErrorModel, got {type(model).__name__}.")
    if model._arrays:
        raise ValueError("error_model holds arrays, which belong to a DEM; give numbers, and a Tin's own sigma_v.")
    return model._core


def _options(
    voxel: Any, voxel_height: Any, confidence: Any, largest_confidence: Any, threads: Any, memory_budget: Any
) -> _volume.VolumeOptions:
    options = volume_core().VolumeOptions()
    options.voxel_m = optional_length("voxel", voxel)
    options.voxel_height_m = optional_length("voxel_height", voxel_height)
    options.confidence = arguments.number("confidence", confidence)
    if largest_confidence is not None:
        options.largest_confidence = arguments.number("largest_confidence", largest_confidence)
    options.threads = arguments.threads(threads)
    options.memory_bytes = arguments.memory_budget(memory_budget)
    return options


def optional_length(name: str, value: Any) -> float:
    """A positive length; 0 for None, the core's own choice."""
    if value is None:
        return 0.0
    found = arguments.number(name, value)
    if found <= 0:
        raise ValueError(f"{name} is {found}; it must be a positive length in metres, or None.")
    return found


def _wrapped(made: _volume.ErrorVolume, warnings: list[str]) -> ErrorVolume:
    volume = ErrorVolume.__new__(ErrorVolume)
    volume._core = made
    volume._warnings = list(warnings)
    return volume


def _first(progress: Progress | None) -> Progress | None:
    return progress and (lambda fraction: progress(_PREPARED * fraction))


def _second(progress: Progress | None) -> Progress | None:
    return progress and (lambda fraction: progress(_PREPARED + (1 - _PREPARED) * fraction))
