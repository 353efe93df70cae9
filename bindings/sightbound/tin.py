# SPDX-License-Identifier: GPL-3.0-or-later
"""Terrain of triangles: from files, arrays, scattered points or a DEM."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import core_dem

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any, Optional, Union

    import numpy as np
    import numpy.typing as npt

    from ._arguments import Doubles, FloatArray, Path, Progress
    from .dem import Dem

    Columns = Optional[Mapping[str, npt.ArrayLike]]
    Indices = npt.NDArray[np.int32]
    Layers = Union[None, str, Sequence[str]]

_DEFAULTS = core.defaults()


class Tin:
    """A surface of triangles, of any shape: height fields, overhangs, bridges, walls, closed bodies.

    Vertices at one place are joined, faces without area and repeated ones left out, the rest turned so that neighbours
    agree and look up or outward; `notes` tell of it. Positions are coordinates of the CRS, heights metres.

    Args:
        vertices: array [n, 3] of x, y (in the CRS) and height.
        faces: array [m, 3] of indices of vertices; or [m, 4] and wider, with -1 at the end of rows of fewer corners:
            larger faces are cut into triangles.
        crs: a projected CRS such as "EPSG:32633", or WKT; None for a plane in metres.
        sigma_v: one-standard-deviation vertical error of each vertex, NaN where it is not known; same unit as heights.
        vertex_attributes: name -> array [n] of numbers that go with the vertices.
        face_attributes: name -> array [m].
        vertical_unit: of heights: "auto" (the CRS says, else metres), "metre", "foot" or "us-foot".

    Raises:
        ValueError: wrong shape, type or length, an index out of range, a coordinate that is not finite, no face left,
            a CRS in degrees.
    """

    __slots__ = ("_core",)

    _core: core.Tin

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        crs: str | None = None,
        sigma_v: npt.ArrayLike | None = None,
        *,
        vertex_attributes: Columns = None,
        face_attributes: Columns = None,
        vertical_unit: str = _DEFAULTS["vertical_unit"],
    ) -> None:
        self._core = core.tin_from_arrays(
            _places("vertices", vertices),
            _indices(faces),
            _crs(crs),
            _column("sigma_v", sigma_v),
            _columns("vertex_attributes", vertex_attributes),
            _columns("face_attributes", face_attributes),
            arguments.word("vertical_unit", vertical_unit),
        )

    @classmethod
    def from_dem(cls, dem: Dem, *, memory_budget: float | None = None, progress: Progress | None = None) -> Tin:
        """All samples of a DEM, every square of four split along its NW-SE diagonal: the surface that viewsheds use.

        Args:
            dem: as read_dem() returns it. Triangles with a nodata corner are left out.
            memory_budget: bytes; None for three quarters of the machine's memory.
            progress: called with the fraction done, at most ten times a second; False cancels.

        Raises:
            ValueError: a CRS in degrees (reproject the DEM), no triangle without nodata.
            MemoryError: the TIN (72 bytes a sample) exceeds the memory budget.
            OSError: the file cannot be read.
        """
        return _wrapped(core.tin_from_dem(core_dem(dem), arguments.memory_budget(memory_budget), progress))

    @classmethod
    def from_points(
        cls,
        points: npt.ArrayLike,
        crs: str | None = None,
        sigma_v: npt.ArrayLike | None = None,
        *,
        breaklines: Sequence[npt.ArrayLike] | None = None,
        attributes: Columns = None,
        longest_edge: float | None = None,
        vertical_unit: str = _DEFAULTS["vertical_unit"],
        progress: Progress | None = None,
    ) -> Tin:
        """The Delaunay triangulation of points in plan: a height field.

        Args:
            points: array [n, 3] of x, y (in the CRS) and height. Points at one place in plan become one of their mean height.
            crs: a projected CRS such as "EPSG:32633", or WKT; None for a plane in metres.
            sigma_v: vertical error of each point, as for Tin.
            breaklines: arrays [k, 3], polylines along which edges must run. They may cross: there a vertex of their mean height is
                added.
            attributes: name -> array [n] of numbers that go with the points.
            longest_edge: triangles with a longer edge in plan (metres) are left out; None keeps the whole convex hull.
            vertical_unit: of heights, as for Tin.
            progress: called with the fraction done, at most ten times a second; False cancels.

        Raises:
            ValueError: fewer than three points, all on a line, wrong shapes, coordinates that are not finite, a CRS in degrees.
        """
        return _wrapped(
            core.tin_from_points(
                _places("points", points),
                [_places(f"breakline {i}", line) for i, line in enumerate(breaklines or (), 1)],
                _crs(crs),
                _column("sigma_v", sigma_v),
                _columns("attributes", attributes),
                arguments.limit("longest_edge", longest_edge),
                arguments.word("vertical_unit", vertical_unit),
                progress,
            )
        )

    @property
    def vertices(self) -> Doubles:
        """A new float64 array [n, 3]: x and y in the CRS, height in metres."""
        return self._core.vertices

    @property
    def local_vertices(self) -> Doubles:
        """float64 array [n, 3], metres from `origin`; read-only, no copy."""
        return self._core.local_vertices

    @property
    def origin(self) -> tuple[float, float, float]:
        """x and y of the CRS and height from which `local_vertices` count: vertices = origin + local / (metres_per_unit, same, 1)."""
        return self._core.origin

    @property
    def metres_per_unit(self) -> float:
        """Metres in one unit of the CRS in plan."""
        return self._core.metres_per_unit

    @property
    def faces(self) -> Indices:
        """int32 array [m, 3] of indices of vertices, counterclockwise seen from above or outside; read-only, no copy."""
        return self._core.faces

    @property
    def sigma_v(self) -> FloatArray | None:
        """float32 array [n], metres, NaN where unknown; None when no vertex has one."""
        return self._core.sigma_v

    @property
    def samples(self) -> Indices | None:
        """Of a TIN made of a DEM with holes: for each vertex row * cols + col of its sample, rows counted from the row order in which
        the NW-SE diagonal runs from (r, c) to (r + 1, c + 1). None when every sample is a vertex, and for other TINs."""
        return self._core.samples

    @property
    def vertex_attributes(self) -> dict[str, FloatArray]:
        """name -> float32 array [n], NaN for none."""
        return self._core.vertex_attributes

    @property
    def face_attributes(self) -> dict[str, FloatArray]:
        """name -> float32 array [m], NaN for none."""
        return self._core.face_attributes

    @property
    def crs_wkt(self) -> str | None:
        """The CRS as WKT; None when there is none. Heights are metres whatever it says."""
        return self._core.crs_wkt or None

    @property
    def notes(self) -> list[str]:
        """What was assumed, converted or repaired."""
        return self._core.notes

    @property
    def bounds(self) -> tuple[float, float, float, float, float, float]:
        """(x_min, y_min, z_min, x_max, y_max, z_max)."""
        return self._core.bounds

    @property
    def median_edge(self) -> float:
        """Median length of the faces' edges in space, metres."""
        return self._core.median_edge

    @property
    def is_height_field(self) -> bool:
        """One height a place: every face looks up and no two overlap in plan. Errors are then vertical, else along the normal."""
        return self._core.height_field_test()[0]

    @property
    def why_no_height_field(self) -> str | None:
        """What speaks against it, such as "face 14 (counted from 0) is vertical or looks down"; None for a height field."""
        return self._core.height_field_test()[1] or None

    def write(self, path: Path, *, ascii: bool = False, progress: Progress | None = None) -> list[str]:
        """Writes the TIN; the file appears when it is whole.

        Args:
            path: .ply (QGIS reads its CRS and attributes), .nc (UGRID, the same), .gpkg (PolygonZ layer), .2dm or .obj.
            ascii: PLY as text. QGIS takes NaN of a text PLY for 0, and none of the binary one.
            progress: called with the fraction done, at most ten times a second; False cancels.

        Returns:
            Warnings: what the format cannot hold.

        Raises:
            ValueError: another ending.
            OSError: the file cannot be written.
        """
        return self._core.write(arguments.path("path", path), bool(ascii), progress)

    def __repr__(self) -> str:
        return f"<sightbound.Tin: {self._core.vertex_count} vertices, {self._core.face_count} faces>"


def read_tin(
    path: Path,
    layer: Layers = None,
    crs: str | None = None,
    *,
    vertical_unit: str = _DEFAULTS["vertical_unit"],
    z_field: str | None = None,
    longest_edge: float | None = None,
    progress: Progress | None = None,
) -> Tin:
    """Reads a TIN: PLY, OBJ, 2DM, LandXML, or a vector source of 3D polygons, TINs, points and lines.

    Args:
        path: the file, or anything that GDAL opens as vectors. Polygons become faces; points are triangulated, with lines as breaklines.
        layer: the surface of a LandXML file or the layer of a vector source, when there are several; or a list of layers of points and
            lines that make one TIN. tin_layers() tells their names.
        crs: wins over the file's, such as "EPSG:32633".
        vertical_unit: of heights: "auto" takes the file's or the CRS's, "metre", "foot" and "us-foot" overrule it.
        z_field: the field of a vector layer that holds heights, instead of 3D geometries.
        longest_edge: of triangulated points: triangles with a longer edge in plan (metres) are left out.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Raises:
        OSError: the file cannot be opened, or is truncated.
        ValueError: the file is damaged, has several surfaces and none is named, no heights, a CRS in degrees.
        MemoryError: the file is too large for this machine.
    """
    layers = [layer] if isinstance(layer, str) else arguments.listed(layer) if layer is not None else []
    if layers is None or not all(isinstance(one, str) and one for one in layers):
        raise ValueError(f"layer is {layer!r}; it must be a name, or a list of names.")
    return _wrapped(
        core.read_tin(
            arguments.path("path", path),
            list(layers),
            _crs(crs),
            arguments.word("vertical_unit", vertical_unit),
            "" if z_field is None else arguments.word("z_field", z_field),
            arguments.limit("longest_edge", longest_edge),
            progress,
        )
    )


def tin_layers(path: Path) -> list[str]:
    """Names of a LandXML file's surfaces or a vector source's layers; none for formats that hold one mesh.

    Raises:
        OSError: the file cannot be opened.
    """
    return core.tin_layers(arguments.path("path", path))


def core_tin(tin: Any) -> core.Tin:
    """The compiled side of the argument `tin`."""
    if not isinstance(tin, Tin):
        raise TypeError(f"tin must be a sightbound.Tin, as read_tin() returns it; got {type(tin).__name__}.")
    return tin._core


def _wrapped(made: core.Tin) -> Tin:
    tin = Tin.__new__(Tin)
    tin._core = made
    return tin


def _crs(crs: str | None) -> str:
    return "" if crs is None else arguments.word("crs", crs)


def _places(name: str, given: Any) -> Doubles:
    import numpy as np

    try:
        rows = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be an array [n, 3] of numbers.") from None
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError(f"{name} has shape {rows.shape}; it must be an array [n, 3] of x, y and height.")
    return rows


def _indices(given: Any) -> Indices:
    import numpy as np

    rows = np.asarray(given)
    if rows.dtype.kind not in "iu":
        raise ValueError(f"faces has type {rows.dtype}; it must be an array of whole numbers.")
    if rows.ndim != 2 or rows.shape[1] < 3:
        raise ValueError(f"faces has shape {rows.shape}; it must be an array [m, 3] of indices of vertices.")
    if rows.size and (rows.min() < -1 or rows.max() > np.iinfo(np.int32).max):
        raise ValueError(f"faces holds the index {rows.min() if rows.min() < -1 else rows.max()}; allowed are 0 to n - 1.")
    return np.ascontiguousarray(rows, dtype=np.int32)


def _column(name: str, given: Any) -> FloatArray | None:
    if given is None:
        return None
    try:
        column = arguments.float_array(given)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be an array of numbers, one each.") from None
    if column.ndim != 1:
        raise ValueError(f"{name} has shape {column.shape}; it must be an array of one number each.")
    return column


def _columns(name: str, given: Columns) -> dict[str, FloatArray]:
    if given is None:
        return {}
    if not hasattr(given, "items"):
        raise ValueError(f"{name} is {given!r}; it must be a dict of names and arrays.")
    return {str(key): _column(f"{name}[{key!r}]", values) for key, values in given.items()}
