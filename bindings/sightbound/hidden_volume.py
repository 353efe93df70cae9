# SPDX-License-Identifier: GPL-3.0-or-later
"""What cannot be seen, in three dimensions: the answer of a volume viewshed."""

from __future__ import annotations

from collections import namedtuple

from . import _arguments as arguments
from ._loading import core, volume_core
from .tin import _wrapped as _wrapped_tin

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, NamedTuple

    from . import _volume
    from ._arguments import CreationOptions, FloatArray, Geotransform, Path, Progress
    from .tin import Tin

    class HiddenRasters(NamedTuple):
        lowest_visible_height: FloatArray
        thickness: FloatArray
        core_thickness: FloatArray

else:
    HiddenRasters = namedtuple("HiddenRasters", "lowest_visible_height thickness core_thickness")
    HiddenRasters.__doc__ = """float32 arrays [rows, cols], north up, with HiddenVolume.geotransform; NaN: nothing asked.

    lowest_visible_height: metres above ground from which on all targets up to the ceiling are visible; NaN where there
        are none.
    thickness, core_thickness: of all that is not visible, and of what is surely hidden, metres.
    """


class HiddenVolume:
    """For each target above ground: visible, uncertain or surely hidden, and the confidence that it is visible.

    The hidden volume is all that is not visible; its core is surely hidden, whatever the true surface within the error
    volume. volume_viewshed() makes one, open() reads one. `a | b` is what is left hidden when both look (the view of b
    subtracted from the hidden volume of a), `a & b` what is left when only what both see counts as seen, `b - a` what b
    sees and a does not claim to see; all need the same targets and confidence.
    """

    __slots__ = ("_core", "_estimate", "_warnings")

    _core: _volume.HiddenVolume
    _estimate: dict[str, Any]
    _warnings: list[str]

    def __init__(self) -> None:
        raise TypeError("Use volume_viewshed() or HiddenVolume.open().")

    @staticmethod
    def open(path: Path, progress: Progress | None = None) -> HiddenVolume:
        """A hidden volume that save() wrote.

        Raises:
            OSError: the file cannot be read, or is damaged.
            ValueError: it is no hidden volume of Sightbound.
        """
        return wrapped(volume_core().open_hidden_volume(arguments.path("path", path), progress))

    def save(self, path: Path, progress: Progress | None = None) -> None:
        """Writes a .vdb file (grids p and verdict) that open() and every OpenVDB tool reads.

        Raises:
            OSError: the file cannot be written; what stood there before stays.
        """
        self._core.save(arguments.path("path", path), progress)

    def write(
        self,
        height: Path | None = None,
        thickness: Path | None = None,
        core_thickness: Path | None = None,
        top: Path | None = None,
        fog: Path | None = None,
        creation_options: CreationOptions = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> list[str]:
        """Writes rasters (GeoTIFF), and the top of the hidden volume as a mesh with p and thickness at its vertices.

        Args:
            height (lowest_visible_height), thickness, core_thickness: paths of rasters; None is not written.
            top: path of the mesh, .ply for QGIS; .nc, .2dm, .obj, .gpkg.
            fog: path of the same faces as polygons with p and thickness, .gpkg: 3D views that cannot draw a mesh transparent
                can draw these.
            creation_options: GDAL's for GTiff.

        Returns:
            Warnings: where nothing is hidden there is no top.

        Raises:
            ValueError: no path, one path twice. OSError: a file cannot be written. Cancelled: progress returned False.
        """
        files = volume_core().HiddenFiles()
        files.height = arguments.path("height", height)
        files.thickness = arguments.path("thickness", thickness)
        files.core_thickness = arguments.path("core_thickness", core_thickness)
        files.top = arguments.path("top", top)
        files.fog = arguments.path("fog", fog)
        files.creation_options = arguments.creation_options(creation_options)
        return self._core.write(files, arguments.threads(threads), progress)

    @property
    def confidence(self) -> float:
        """The confidence of the claims."""
        return self._core.confidence

    @property
    def lattice(self) -> dict[str, Any]:
        """The targets: spacing, height_spacing, ceiling (metres), columns, rows, targets (how many)."""
        return self._core.lattice()

    @property
    def geotransform(self) -> Geotransform:
        """GDAL's six numbers of the rasters."""
        return self._core.geotransform

    @property
    def crs_wkt(self) -> str | None:
        """The CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def report(self) -> dict[str, Any]:
        """How it was made.

        observers: JSON text of each view; error_model: JSON; operations: set operations, oldest first; view_places,
        targets, lines: of the viewshed, when it was made now; warnings; version
        """
        return {
            **self._estimate,
            "observers": self._core.observers,
            "error_model": self._core.error_model,
            "operations": self._core.operations,
            "warnings": self._warnings,
            "version": core.__version__,
        }

    def volumes(self) -> dict[str, float]:
        """Cubic metres by verdict: hidden_m3 (the core), uncertain_m3, visible_m3."""
        return self._core.volumes()

    def area(self, height: float) -> dict[str, float]:
        """Square metres of ground that hide a thing of this height (a man 1.8, a lorry 3.5), metres.

        asked_m2; hidden_m2: no target from the ground to the height is visible; core_m2: all are surely hidden.

        Raises:
            ValueError: the height is 0 or less, or more than the ceiling.
        """
        return self._core.area(arguments.number("height", height))

    def places(self, height: float, sure: bool = False, most: int = 20) -> list[dict[str, Any]]:
        """The largest connected places that hide a thing of this height (surely, if `sure`), largest first.

        area_m2, volume_m3 (hidden over them, up to the ceiling), centroid and deepest (x, y), depth (metres, there).
        """
        if not hasattr(most, "__index__") or most < 0:
            raise ValueError(f"most is {most!r}; it must be a whole number, 0 or more.")
        return self._core.places(arguments.number("height", height), bool(sure), int(most))

    def at(self, x: float, y: float, z: float) -> tuple[int, float] | None:
        """(verdict, p) at a place (CRS, absolute height in metres): 0 surely hidden, 1 uncertain, 2 visible; None: not asked."""
        return self._core.at(arguments.number("x", x), arguments.number("y", y), arguments.number("z", z))

    def rasters(self) -> HiddenRasters:
        """lowest_visible_height, thickness and core_thickness as arrays."""
        return HiddenRasters(*self._core.rasters())

    def top(self) -> Tin:
        """The top of the hidden volume: the fog over the terrain. Vertex attributes p (least of the column), thickness.

        Raises:
            ValueError: nothing is hidden.
        """
        return _wrapped_tin(self._core.top())

    def __or__(self, other: HiddenVolume) -> HiddenVolume:
        return wrapped(self._core.union_of_seen(core_hidden(other)))

    def __and__(self, other: HiddenVolume) -> HiddenVolume:
        return wrapped(self._core.intersection_of_seen(core_hidden(other)))

    def __sub__(self, other: HiddenVolume) -> HiddenVolume:
        return wrapped(core_hidden(other).difference_of_seen(self._core))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, HiddenVolume) and self._core.same_as(other._core)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<HiddenVolume, {self.lattice['targets']} targets>"


def core_hidden(hidden: Any) -> _volume.HiddenVolume:
    """The compiled side of a hidden volume."""
    if not isinstance(hidden, HiddenVolume):
        raise TypeError(f"hidden must be a sightbound.HiddenVolume; got {type(hidden).__name__}.")
    return hidden._core


def wrapped(
    made: _volume.HiddenVolume, estimate: dict[str, Any] | None = None, warnings: list[str] | None = None
) -> HiddenVolume:
    """The compiled side as what users hold."""
    hidden = HiddenVolume.__new__(HiddenVolume)
    hidden._core = made
    hidden._estimate = {key: value for key, value in (estimate or {}).items() if key != "seconds"}
    hidden._warnings = list(warnings or [])
    return hidden
