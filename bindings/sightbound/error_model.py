# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a DEM's error."""

from __future__ import annotations

import os

from . import _arguments as arguments
from . import _quantities as quantities
from ._loading import core
from .dem import Dem, core_dem

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from ._arguments import FloatArray, Path
    from ._quantities import Quantity

_DEFAULTS = core.defaults()
_FIELDS = ("vertical_rmse", "geologic_variation")


class ErrorModel:
    """Error of a DEM. What is said is meant (0 is 0); what is left None is estimated from the DEM when it is used.

    Args:
        vertical_rmse: standard deviation of the measured heights, metres: a number, the path of a raster (or
            (path, band)) of any grid and CRS, or an array on the DEM's grid, in its row order.
        horizontal_rmse: standard deviation of the measured positions along one axis, metres.
        geologic_variation: the largest rise between neighbouring samples, metres at 95 %; number, raster or array.
        geologic_range: distance from a sample, metres, over which the terrain is known ("gaussian": it fades with this
            scale; "step": it ends there). None with "gaussian": the scale is 1 / geologic_variation.
        geologic_model: how the terrain becomes unknown between samples: "gaussian", "step" or "growth".
        terrain_types: path of polygons (any vector file, any CRS) that overrule geologic_variation where they lie.
        terrain_field: their attribute: metres, or the name of a class.
        terrain_table: class -> metres, as a dict or as the path of a JSON or CSV file; None for terrain_table().
        terrain_layer: the layer of `terrain_types`; None for the first.
        growth_exponent: how fast the doubt grows with distance ("growth" only).
        tails: how errors are distributed: "normal", "laplace" or "student" (5 degrees of freedom: what real ground
            shows). None: normal, unless estimated.
        correlation_length: metres; the measured errors of samples d apart correlate by exp(-d / length). 0: not at all.
        shared_bias: how much the DEM is too high everywhere, metres. It moves heights that are absolute, nothing else.
        samples_or_means: what a cell holds: "samples" (the height of its middle) or "means" (the mean over the cell).
            None or "auto": samples, unless estimated.
        ridge_gain: how far the truth stands above the surface, in units of its curvature (-2 to 2).
        level_variance: factor of the variance learnt from the DEM where the samples around stand level (0 to 10). None: 1,
            unless estimated.
        step_variance: the same where they step.
        level_tail: how unevenly what is drawn is spread where they stand level: the power of an exponential variable that
            its scale is (0: normal; 0.5: Laplace's distribution; 1.5 at most: most roofs are bare, a few have a chimney).
            Needs a geologic_variation that is estimated, and step_tail. None: as `tails`, unless estimated.
        step_tail: the same where they step.

    Raises:
        ValueError: a value out of range, or values that contradict each other.
        OSError: the table cannot be read.
    """

    __slots__ = ("_arrays", "_core", "_report")

    _core: core.ErrorModel
    _arrays: dict[str, FloatArray]
    _report: dict[str, Any]

    def __init__(
        self,
        vertical_rmse: Quantity = None,
        horizontal_rmse: float = _DEFAULTS["horizontal_rmse"],
        geologic_variation: Quantity = None,
        geologic_range: float | None = None,
        geologic_model: str = _DEFAULTS["geologic_model"],
        terrain_types: Path | None = None,
        terrain_field: str | None = None,
        terrain_table: Mapping[str, float] | Path | None = None,
        terrain_layer: str | None = None,
        growth_exponent: float | None = None,
        tails: str | None = None,
        correlation_length: float = _DEFAULTS["correlation_length"],
        shared_bias: float = _DEFAULTS["shared_bias"],
        samples_or_means: str | None = None,
        ridge_gain: float | None = None,
        level_variance: float | None = None,
        step_variance: float | None = None,
        level_tail: float | None = None,
        step_tail: float | None = None,
    ) -> None:
        model = core.ErrorModel()
        self._core, self._arrays, self._report = model, {}, {}
        for field, value in zip(_FIELDS, (vertical_rmse, geologic_variation)):
            self._set(field, value)
        model.horizontal_rmse = arguments.number("horizontal_rmse", horizontal_rmse)
        model.geologic_model = arguments.word("geologic_model", geologic_model)
        if geologic_range is not None:
            model.geologic_range = arguments.number("geologic_range", geologic_range)
        if growth_exponent is not None:
            model.growth_exponent = arguments.number("growth_exponent", growth_exponent)
        if tails is not None:
            model.tails = arguments.word("tails", tails)
        model.correlation_length = arguments.number("correlation_length", correlation_length)
        model.shared_bias = arguments.number("shared_bias", shared_bias)
        if samples_or_means not in (None, "auto"):
            model.samples_or_means = arguments.word("samples_or_means", samples_or_means)
        if ridge_gain is not None:
            model.ridge_gain = arguments.number("ridge_gain", ridge_gain)
        if level_variance is not None:
            model.level_variance = arguments.number("level_variance", level_variance)
        if step_variance is not None:
            model.step_variance = arguments.number("step_variance", step_variance)
        if level_tail is not None:
            model.level_tail = arguments.number("level_tail", level_tail)
        if step_tail is not None:
            model.step_tail = arguments.number("step_tail", step_tail)
        if terrain_types is not None:
            types = arguments.path("terrain_types", terrain_types)
            table = quantities.class_table(terrain_table)
            model.terrain_types = core.TerrainTypes(types, terrain_layer or "", terrain_field or "", table)
        elif terrain_field is not None or terrain_table is not None or terrain_layer is not None:
            raise ValueError("terrain_field, terrain_table and terrain_layer describe terrain_types, which is missing.")
        model.validate()

    @classmethod
    def from_accuracy(
        cls,
        rmse: Quantity = None,
        le90: Any = None,
        le95: Any = None,
        horizontal_rmse: float | None = None,
        ce90: float | None = None,
        ce95: float | None = None,
        **other: Any,
    ) -> ErrorModel:
        """A model from accuracies as data sheets state them.

        Args:
            rmse: vertical root mean square error, metres; raster and array as for vertical_rmse.
            le90, le95: linear error at 90 or 95 %, metres: a number, or an array on the DEM's grid.
            horizontal_rmse: along one axis, metres.
            ce90, ce95: circular error at 90 or 95 % (radial), metres.
            other: further arguments of ErrorModel.

        Raises:
            ValueError: more than one vertical or more than one horizontal accuracy.
        """
        vertical = quantities.only_one(rmse=rmse, vertical_rmse=other.pop("vertical_rmse", None), le90=le90, le95=le95)
        horizontal = quantities.only_one(horizontal_rmse=horizontal_rmse, ce90=ce90, ce95=ce95)
        if vertical is not None:
            other["vertical_rmse"] = quantities.standard_deviation(*vertical)
        if horizontal is not None:
            other["horizontal_rmse"] = quantities.standard_deviation(*horizontal)
        return cls(**other)

    @classmethod
    def from_json(cls, text_or_path: Path) -> ErrorModel:
        """The model that to_json() wrote, from its text or from a file that holds it.

        Raises:
            ValueError: not such a text.
            OSError: the file cannot be read.
        """
        text = os.fspath(text_or_path)
        if not text.lstrip().startswith("{"):
            with open(text, encoding="utf-8") as file:
                text = file.read()
        model = core.ErrorModel.from_json(text)
        model.validate()
        return cls._of(model, {})

    def to_json(self) -> str:
        """The model as JSON; rasters are named by their paths.

        Raises:
            ValueError: the model holds an array.
        """
        if self._arrays:
            field = next(iter(self._arrays))
            raise ValueError(f"{field} is an array, which JSON cannot hold; save it as a raster and give its path.")
        return self._core.to_json()

    @property
    def vertical_rmse(self) -> Any:
        """None (estimated from the DEM), metres, a path (or (path, band) for another band than 1), or an array."""
        return self._get("vertical_rmse")

    @property
    def horizontal_rmse(self) -> float:
        """Metres, along one axis."""
        return self._core.horizontal_rmse

    @property
    def geologic_variation(self) -> Any:
        """As vertical_rmse: None, metres, a path, or an array."""
        return self._get("geologic_variation")

    @property
    def geologic_range(self) -> float | None:
        """Metres, or None."""
        return self._core.geologic_range

    @property
    def geologic_model(self) -> str:
        """ "gaussian", "step" or "growth"."""
        return self._core.geologic_model

    @property
    def growth_exponent(self) -> float | None:
        """Of the geologic model "growth"."""
        return self._core.growth_exponent

    @property
    def terrain_types(self) -> str | None:
        """Path of the polygons, or None."""
        types = self._core.terrain_types
        return types.path if types else None

    @property
    def terrain_field(self) -> str | None:
        """Attribute of the polygons, or None."""
        types = self._core.terrain_types
        return types.field if types else None

    @property
    def terrain_table(self) -> dict[str, float] | None:
        """class -> metres; None without polygons, or when the default table is used."""
        types = self._core.terrain_types
        return (types.table or None) if types else None

    @property
    def tails(self) -> str | None:
        """ "normal", "laplace" or "student"; None counts as normal."""
        return self._core.tails

    @property
    def correlation_length(self) -> float:
        """Metres, of the measured errors."""
        return self._core.correlation_length

    @property
    def shared_bias(self) -> float:
        """Metres by which the DEM is too high everywhere."""
        return self._core.shared_bias

    @property
    def samples_or_means(self) -> str | None:
        """ "samples" or "means"; None counts as samples."""
        return self._core.samples_or_means

    @property
    def ridge_gain(self) -> float | None:
        """How far the truth stands above the surface, in units of its curvature."""
        return self._core.ridge_gain

    @property
    def level_variance(self) -> float | None:
        """Factor of the variance learnt from the DEM where the samples around stand level."""
        return self._core.level_variance

    @property
    def step_variance(self) -> float | None:
        """Factor of the variance learnt from the DEM where the samples around step."""
        return self._core.step_variance

    @property
    def level_tail(self) -> float | None:
        """How unevenly what is drawn is spread where the samples around stand level: 0 normal, 0.5 Laplace's; None: as `tails`."""
        return self._core.level_tail

    @property
    def step_tail(self) -> float | None:
        """How unevenly what is drawn is spread where the samples around step."""
        return self._core.step_tail

    @property
    def report(self) -> dict[str, Any]:
        """What estimate_error() found: growth_exponent, typical_sigma, rounding, rms_of_spacing (metres) and more; of
        checkpoints and reference under these names; warnings. Of a product its title and source (product_error()).
        Else empty."""
        return dict(self._report)

    def __repr__(self) -> str:
        shown = [f"{field}={'array' if field in self._arrays else self._get(field)!r}" for field in _FIELDS]
        shown += [f"horizontal_rmse={self.horizontal_rmse}", f"geologic_model={self.geologic_model!r}"]
        return f"<sightbound.ErrorModel: {', '.join(shown)}>"

    @classmethod
    def _of(
        cls, model: core.ErrorModel, arrays: dict[str, FloatArray], report: dict[str, Any] | None = None
    ) -> ErrorModel:
        made = cls.__new__(cls)
        made._core, made._arrays, made._report = model, arrays, report or {}
        return made

    def _set(self, field: str, value: Quantity) -> None:
        found = quantities.from_argument(field, value)
        if hasattr(found, "dtype"):
            self._arrays[field] = found
            found = 0.0  # stands for the array until the DEM is known: something is given
        setattr(self._core, field, found)

    def _get(self, field: str) -> Any:
        if field in self._arrays:
            return self._arrays[field]
        value = getattr(self._core, field)
        return value[0] if isinstance(value, tuple) and value[1] == 1 else value

    def _on(self, dem: Dem) -> core.ErrorModel:
        """The compiled model for jobs on `dem`, its arrays in the core's row order."""
        if not self._arrays:
            return self._core
        model = self._core.copy()
        for field, values in self._arrays.items():
            if values.shape != dem.shape:
                raise ValueError(f"{field} has shape {values.shape}, the DEM has {dem.shape}; give one value per cell.")
            getattr(model, f"set_{field}")(values, core_dem(dem).flipped)
        return model


def two_sided_quantile(confidence: float, tails: str | None = None) -> float:
    """z(c): within so many standard deviations lies the share `confidence` of errors with these `tails` (None: normal).

    Raises:
        ValueError: a confidence outside 0 to 1, or unknown tails.
    """
    return core.two_sided_quantile(arguments.number("confidence", confidence), arguments.word("tails", tails or "normal"))


def products() -> dict[str, dict[str, Any]]:
    """Elevation products of published accuracy: name -> title, vertical_rmse (metres, one standard deviation of a
    sample), shared (what is published of the product as a whole: no part of vertical_rmse), and source."""
    return core.products()


def product_error(name: str, **other: Any) -> ErrorModel:
    """The model of a product by name; see products(). What lies between its samples is estimated from the DEM.

    Args:
        name: "srtm_eurasia", "copernicus_glo30", "3dep_ql2" ...
        other: further arguments of ErrorModel.from_accuracy, which win over what is published.

    Returns:
        A model; its `report` holds product, title, shared and source.

    Raises:
        ValueError: no such product (the message lists them), or a value out of range.
    """
    core.require_product(arguments.word("name", name))
    found = products()[name]
    if all(other.get(key) is None for key in ("rmse", "le90", "le95", "vertical_rmse")):
        other["vertical_rmse"] = found["vertical_rmse"]
    model = ErrorModel.from_accuracy(**other)
    model._report = {"product": name, **{key: found[key] for key in ("title", "shared", "source")}}
    return model


def core_model(model: ErrorModel | None, dem: Dem) -> core.ErrorModel:
    """The compiled side of the argument `error_model` of a job on `dem`."""
    if model is None:
        return core.ErrorModel()
    if not isinstance(model, ErrorModel):
        raise TypeError(f"error_model must be a sightbound.ErrorModel or None, got {type(model).__name__}.")
    return model._on(dem)


def terrain_table() -> dict[str, float]:
    """The default table of terrain types: class -> largest rise between samples, metres at 95 %. A copy of it."""
    return core.terrain_table()
