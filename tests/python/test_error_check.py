# SPDX-License-Identifier: GPL-3.0-or-later
"""A DEM's error learnt from check points and from a better DEM: what was put in must come out."""

import numpy as np
import pytest
import sightbound as sb
from osgeo import ogr, osr

CELL, STEP, SIZE = 5.0, 4, 512  # the truth's cells, metres; the DEM keeps every STEP-th sample
UTM = 32633
EXACT = sb.ErrorModel(geologic_variation=0.0)  # nothing between samples


def system(code):
    made = osr.SpatialReference()
    made.ImportFromEPSG(code)
    made.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return made


def fractal(seed, hurst=0.9, height=60.0):
    rng = np.random.default_rng(seed)
    frequency = np.fft.fftfreq(SIZE)
    radius = np.hypot(*np.meshgrid(frequency, frequency))
    radius[0, 0] = 1.0
    power = radius ** -(hurst + 1.0)
    power[0, 0] = 0.0
    z = np.fft.ifft2(np.fft.fft2(rng.standard_normal((SIZE, SIZE))) * power).real
    return height * z / z.std()


def correlated(seed, shape, length):
    """Unit errors alike over `length` cells: exp(-d / length)."""
    rng = np.random.default_rng(seed)
    steps = np.fft.fftfreq(256) * 256
    spectrum = np.fft.fft2(np.exp(-np.hypot(*np.meshgrid(steps, steps)) / length)).real.clip(0.0)
    e = np.fft.ifft2(np.fft.fft2(rng.standard_normal((256, 256))) * np.sqrt(spectrum)).real[: shape[0], : shape[1]]
    return e - e.mean()


def truth_of(z):
    return sb.Dem(z.astype(np.float32), (0.0, CELL, 0.0, SIZE * CELL, 0.0, -CELL))


def dem_of(z, errors=0.0, right=0, down=0):
    """Every STEP-th sample of the truth with errors; those right and down of where they are said to be."""
    kept = z[down::STEP, right::STEP][: SIZE // STEP - 1, : SIZE // STEP - 1]
    wide = STEP * CELL
    corner = (0.5 * (CELL - wide), SIZE * CELL - 0.5 * (CELL - wide))
    return sb.Dem((kept + errors).astype(np.float32), (corner[0], wide, 0.0, corner[1], 0.0, -wide))


KEPT = (SIZE // STEP - 1, SIZE // STEP - 1)


def points_on(surface, count, seed=5):
    """Places inside a Dem's raster that are samples, as (x, y) and their rows and columns."""
    rng = np.random.default_rng(seed)
    rows, cols = (rng.integers(2, size - 2, count) for size in surface.shape)
    g = surface.geotransform
    return np.c_[g[0] + (cols + 0.5) * g[1], g[3] + (rows + 0.5) * g[5]], rows, cols


def check_samples(errors, count=3000, **arguments):
    """Check points at samples of a rough DEM, which is `errors` above them."""
    dem = dem_of(fractal(1))
    places, rows, cols = points_on(dem, count)
    true = dem.heights[rows, cols] - errors[rows, cols]
    return sb.estimate_error(dem, checkpoints=np.c_[places, true], error_model=EXACT, **arguments)


def test_tails_of_the_samples_do_not_take_the_place_of_those_between_them():
    """Bare ground with things on it here and there, and check points at samples."""
    rng = np.random.default_rng(11)
    things = np.kron(rng.random((128, 128)) < 0.15, np.ones((2, 2))) * rng.uniform(1, 5, (256, 256))
    dem = sb.Dem((things + rng.normal(0, 0.02, things.shape)).astype(np.float32), (0.0, 5.0, 0.0, 1280.0, 0.0, -5.0))
    alone = sb.estimate_error(dem, samples_or_means="samples")
    assert alone.level_tail > 0.8
    places, rows, cols = points_on(dem, 600)
    checked = sb.estimate_error(dem, checkpoints=np.c_[places, dem.heights[rows, cols] + rng.normal(0, 0.1, 600)], samples_or_means="samples")
    assert (checked.level_tail, checked.step_tail) == (alone.level_tail, alone.step_tail)
    told = sb.estimate_error(dem, error_model=sb.ErrorModel(tails="laplace"), samples_or_means="samples")
    assert told.level_tail is None


# ---- statistics


def test_figures_are_those_of_numpy():
    rng = np.random.default_rng(0)
    noise = rng.standard_normal(KEPT) + 0.7
    model = check_samples(noise)
    found = model.report["checkpoints"]
    _, rows, cols = points_on(sb.Dem(np.zeros(KEPT, np.float32), (0, 1, 0, 0, 0, -1)), 3000)
    r = noise[rows, cols]
    near = pytest.approx
    assert found["count"] == 3000 and found["left_out"] == 0
    assert found["mean"] == near(r.mean(), abs=1e-4) and found["sd"] == near(r.std(ddof=1), abs=1e-4)
    assert found["median"] == near(np.median(r), abs=1e-4)
    assert found["rmse"] == near(np.sqrt((r**2).mean()), abs=1e-4)
    assert found["nmad"] == near(1.4826 * np.median(abs(r - np.median(r))), abs=1e-3)
    assert found["le90"] == near(np.quantile(abs(r), 0.9, method="weibull"), abs=1e-4)
    assert found["le95_unbiased"] == near(np.quantile(abs(r - np.median(r)), 0.95, method="weibull"), abs=1e-4)
    assert found["skewness"] == near(((r - r.mean()) ** 3).mean() / r.std() ** 3, abs=1e-3)
    assert found["excess_kurtosis"] == near(((r - r.mean()) ** 4).mean() / r.std() ** 4 - 3.0, abs=1e-3)
    assert model.shared_bias == found["median"]
    assert model.vertical_rmse == near(1.0, rel=0.05) and model.horizontal_rmse == 0.0
    assert model.correlation_length == 0.0


@pytest.mark.parametrize(
    "tails, draw",
    [
        ("normal", lambda rng: rng.standard_normal(KEPT)),
        ("laplace", lambda rng: rng.laplace(size=KEPT) / np.sqrt(2.0)),
        ("student", lambda rng: rng.standard_t(5, size=KEPT) * np.sqrt(0.6)),
    ],
)
def test_tails_are_recognised(tails, draw):
    errors = 2.0 * draw(np.random.default_rng(7))
    model = check_samples(errors, count=12000)
    assert model.tails == tails
    assert model.vertical_rmse == pytest.approx(2.0, rel=0.05)


def test_few_points_tell_no_tails_and_say_so():
    errors = np.random.default_rng(1).laplace(size=KEPT)
    model = check_samples(errors, count=60)
    assert model.tails is None
    assert any("kind of tails cannot be told" in note for note in model.report["warnings"])


def test_tails_heavier_than_all_are_told_of():
    errors = np.random.default_rng(1).standard_t(1.5, size=KEPT)
    assert any("heavier than any" in note for note in check_samples(errors).report["warnings"])
    errors = np.random.default_rng(1).laplace(size=KEPT)
    assert not any("heavier than any" in note for note in check_samples(errors).report["warnings"])


def test_blunders_are_told_of_but_kept():
    noise = np.random.default_rng(2).standard_normal(KEPT)
    noise[::9, ::7] += 80.0
    model = check_samples(noise)
    found = model.report["checkpoints"]
    assert found["outliers"] > 20 and found["rmse"] > 5.0
    assert any("blunders" in note for note in model.report["warnings"])
    assert model.vertical_rmse == pytest.approx(1.0, rel=0.15) and abs(model.shared_bias) < 0.1


def test_a_large_bias_asks_for_the_vertical_datum():
    model = check_samples(45.0 + np.random.default_rng(2).standard_normal(KEPT))
    assert model.shared_bias == pytest.approx(45.0, abs=0.1)
    assert any("vertical datum" in note for note in model.report["warnings"])


# ---- growth with slope, likeness of neighbours


def test_growth_with_slope_is_koppes():
    rng = np.random.default_rng(4)
    wide = STEP * CELL
    row, col = np.mgrid[0 : KEPT[0], 0 : KEPT[1]]
    hill = 0.2 * wide * col * col / KEPT[1]  # slope grows from 0 to 0.4 along the rows
    slope = 0.4 * col / KEPT[1]
    dem = sb.Dem(hill.astype(np.float32), (0.0, wide, 0.0, KEPT[0] * wide, 0.0, -wide))
    places, rows, cols = points_on(dem, 8000)
    errors = (0.5 + 4.0 * slope[rows, cols]) * rng.standard_normal(8000)
    model = sb.estimate_error(dem, checkpoints=np.c_[places, hill[rows, cols] - errors], error_model=EXACT)
    assert model.vertical_rmse == pytest.approx(0.5, abs=0.06)
    assert model.horizontal_rmse == pytest.approx(4.0, rel=0.07)
    assert model.report["checkpoints"]["slope"]["explained"] > 0.1
    assert model.tails == "normal"  # only in units of their own sigma


@pytest.mark.parametrize("length, nugget", [(6.0, 0.0), (12.0, 0.0), (6.0, 1.0)])
def test_correlation_length_against_a_better_dem(length, nugget):
    z = fractal(3)
    noise = np.random.default_rng(8).standard_normal(KEPT)
    errors = correlated(9, KEPT, length) + nugget * noise
    model = sb.estimate_error(dem_of(z, errors + 2.0), reference=truth_of(z))
    found = model.report["reference"]
    assert found["variogram"]["length"] == pytest.approx(length * STEP * CELL, rel=0.35)
    if nugget:
        assert found["variogram"]["nugget"] == pytest.approx(1.0, rel=0.2)
        # As much correlation, summed over the plane, as half of the variance with the whole length.
        assert model.correlation_length == pytest.approx(found["variogram"]["length"] / np.sqrt(2.0), rel=0.1)
    assert found["median"] == pytest.approx(2.0, abs=0.3)
    assert found["between_samples"] == 0.0
    assert model.vertical_rmse == pytest.approx(np.sqrt(1.0 + nugget), rel=0.15)


def test_independent_errors_have_no_correlation_length():
    noise = np.random.default_rng(3).standard_normal(KEPT)
    for model in (
        check_samples(noise),
        sb.estimate_error(dem_of(fractal(2), noise), reference=truth_of(fractal(2))),
    ):
        assert model.correlation_length == 0.0


def test_a_tilt_is_told_of():
    row, col = np.mgrid[0 : KEPT[0], 0 : KEPT[1]]
    noise = 0.1 * np.random.default_rng(3).standard_normal(KEPT)
    model = check_samples(0.05 * col + noise)
    assert any("trend" in note for note in model.report["warnings"])


# ---- what lies between samples is not counted twice


def test_what_the_dem_expects_between_samples_is_taken_off():
    z = fractal(11)
    dem = dem_of(z, correlated(12, KEPT, 6.0) * 3.0)
    rng = np.random.default_rng(13)
    rows, cols = rng.integers(8, SIZE - 16, (2, 4000))
    places = np.c_[(cols + 0.5) * CELL, SIZE * CELL - (rows + 0.5) * CELL, z[rows, cols]]
    model = sb.estimate_error(dem, checkpoints=places)
    found = model.report["checkpoints"]
    assert 0.0 < found["between_samples"] < found["sd"]
    assert model.vertical_rmse == pytest.approx(3.0, rel=0.15)
    alone = sb.estimate_error(dem_of(z), checkpoints=places)
    assert alone.vertical_rmse < 0.6 * alone.report["checkpoints"]["sd"]


# ---- shift


@pytest.mark.parametrize("right, down", [(0, 0), (1, 0), (0, 2), (3, 1)])
@pytest.mark.parametrize("flip", [False, True])
def test_shift_is_found_within_its_standard_error(right, down, flip):
    z = fractal(21)
    dem = dem_of(z, correlated(22, KEPT, 6.0) + 2.0, right, down)
    if flip:  # the same, rows from south to north
        g = dem.geotransform
        dem = sb.Dem(dem.heights[::-1].copy(), (g[0], g[1], 0.0, g[3] + dem.shape[0] * g[5], 0.0, -g[5]))
    model = sb.estimate_error(dem, reference=truth_of(z), correct_shift=True)
    shift = model.report["reference"]["shift"]
    assert abs(shift["dx"] + right * CELL) < 3.0 * shift["se_dx"] < 1.5
    assert abs(shift["dy"] - down * CELL) < 3.0 * shift["se_dy"] < 1.5
    assert abs(shift["dz"] - 2.0) < 3.0 * shift["se_dz"]
    assert shift["significant"] == (right + down > 0) and shift["corrected"]
    assert model.shared_bias == pytest.approx(0.0, abs=0.1)
    assert model.vertical_rmse == pytest.approx(1.0, rel=0.15)


def test_check_points_find_the_shift_too():
    z = fractal(31)
    dem = dem_of(z, 0.0, 2, 0)
    rng = np.random.default_rng(1)
    rows, cols = rng.integers(16, SIZE - 24, (2, 2000))
    places = np.c_[(cols + 0.5) * CELL, SIZE * CELL - (rows + 0.5) * CELL, z[rows, cols]]
    model = sb.estimate_error(dem, checkpoints=places)
    shift = model.report["checkpoints"]["shift"]
    assert shift["dx"] == pytest.approx(-10.0, abs=4.0 * shift["se_dx"]) and shift["se_dx"] < 0.5
    assert shift["dy"] == pytest.approx(0.0, abs=4.0 * shift["se_dy"])
    assert shift["significant"] and not shift["corrected"]
    assert any("sideways" in note for note in model.report["warnings"])


def test_flat_ground_tells_no_shift():
    dem = sb.Dem(np.full((60, 60), 7.0, np.float32), (0, 10, 0, 600, 0, -10))
    places, _, _ = points_on(dem, 50)
    model = sb.estimate_error(dem, checkpoints=np.c_[places, 7.0 + np.random.default_rng(0).standard_normal(50)])
    assert model.report["checkpoints"]["shift"] is None
    assert any("too flat" in note for note in model.report["warnings"])


def test_corrected_dem_lies_where_the_truth_is(tmp_path):
    z = fractal(41)
    dem, truth = dem_of(z, 2.0, 3, 1), truth_of(z)
    shift = sb.estimate_error(dem, reference=truth, correct_shift=True).report["reference"]["shift"]
    sb.write_corrected(dem, tmp_path / "moved.tif", shift)
    moved = sb.read_dem(tmp_path / "moved.tif")
    assert moved.geotransform[0] == pytest.approx(dem.geotransform[0] + 15.0, abs=0.2)
    assert moved.geotransform[3] == pytest.approx(dem.geotransform[3] - 5.0, abs=0.2)
    assert np.allclose(moved.heights, dem.heights - shift["dz"], atol=1e-4)
    again = sb.estimate_error(moved, reference=truth).report["reference"]
    assert not again["shift"]["significant"] and again["nmad"] < 0.2
    with pytest.raises(ValueError, match="shift is"):
        sb.write_corrected(dem, tmp_path / "no.tif", (1.0, 2.0))


def used_together(dem, model, place):
    """The ground that absolute heights are compared with."""
    line = sb.line_of_sight(dem, place, (place[0] + 100.0, place[1]), 500.0, 500.0, model, height_reference="absolute")
    return line.report["observer_ground"]


@pytest.mark.parametrize("known", ["reference", "points", "both", "points on a slope"])
def test_a_model_belongs_to_one_dem(tmp_path, known):
    """Corrected DEM with its model, and the DEM as it is with its own: the same ground, which is the truth's."""
    slope = "slope" in known  # which looks one way: no shift can be told
    z, right = (np.fromfunction(lambda r, c: 0.5 * c, (SIZE, SIZE)), 0) if slope else (fractal(45, height=20.0), 1)
    dem, truth = dem_of(z, 2.5 + (0.0 if slope else 0.05) * correlated(46, KEPT, 6.0), right), truth_of(z)
    places, rows, cols = points_on(truth, 600)
    inside = (rows < SIZE - 16) & (cols < SIZE - 16)
    lower = 1.0 if known == "both" else 0.0  # the points' datum, which counts
    given = {} if known == "reference" else {"checkpoints": np.c_[places, z[rows, cols] - lower][inside]}
    if known in ("reference", "both"):
        given["reference"] = truth
    exact = EXACT if slope else None
    as_it_is, moved = (sb.estimate_error(dem, error_model=exact, correct_shift=on, **given) for on in (False, True))
    told = moved.report["reference" if "reference" in given else "checkpoints"]
    assert told["correction"]["taken_off"] and (told["shift"] is None) == slope
    assert moved.shared_bias == pytest.approx(lower, abs=0.1)
    assert as_it_is.shared_bias == pytest.approx(2.5 + lower, abs=0.15)
    sb.write_corrected(dem, tmp_path / "moved.tif", told["correction"])
    row, col = 60 * STEP, 60 * STEP + right  # a sample of the DEM
    east, north, true = (col + 0.5) * CELL, (SIZE - row - 0.5) * CELL, z[row, col] - lower
    assert used_together(sb.read_dem(tmp_path / "moved.tif"), moved, (east, north)) == pytest.approx(true, abs=0.3)
    assert used_together(dem, as_it_is, (east - right * CELL, north)) == pytest.approx(true, abs=0.3)


# ---- a better DEM of other kinds


def test_means_are_compared_with_means():
    z = fractal(51)
    count = SIZE // STEP
    means = z.reshape(count, STEP, count, STEP).mean(axis=(1, 3))
    wide = STEP * CELL
    dem = sb.Dem(means.astype(np.float32), (0.0, wide, 0.0, SIZE * CELL, 0.0, -wide))
    as_means = sb.estimate_error(dem, "means", reference=truth_of(z))
    as_samples = sb.estimate_error(dem, "samples", reference=truth_of(z))
    assert as_means.samples_or_means == "means" and as_samples.samples_or_means == "samples"
    assert sb.estimate_error(dem, reference=truth_of(z)).samples_or_means == "means"
    assert sb.estimate_error(dem_of(z), reference=truth_of(z)).samples_or_means == "samples"
    assert any("hold means, not samples" in note for note in as_samples.report["warnings"])
    found = [model.report["reference"]["sd"] for model in (as_means, as_samples)]
    assert found[0] < 0.1 * found[1]
    # Means plane off what is convex: the truth stands above them there.
    assert as_samples.report["reference"]["ridge_bias"] > 0.1


def test_a_reference_that_does_not_tell_samples_from_means_says_so():
    z = fractal(52)
    truth = truth_of(z)
    same = sb.Dem((z + np.random.default_rng(1).standard_normal(z.shape)).astype(np.float32), truth.geotransform)
    model = sb.estimate_error(same, reference=truth)
    assert model.report["reference"]["samples_or_means"] == "not told"
    assert model.samples_or_means == model.report["samples_or_means"]
    assert any("not told by the reference" in note for note in model.report["warnings"])
    for said in (
        sb.estimate_error(same, "samples", reference=truth),
        sb.estimate_error(same, reference=truth, error_model=sb.ErrorModel(samples_or_means="samples")),
        sb.estimate_error(dem_of(z), reference=truth),
    ):
        assert not any("not told by the reference" in note for note in said.report["warnings"])


def test_reference_of_another_crs_and_of_a_part(tmp_path):
    """A plane, in UTM and in degrees: bilinear in both, so that they differ by next to nothing."""
    wkt = system(UTM).ExportToWkt()
    row, col = np.mgrid[0:80, 0:90]
    x, y = 500000.0 + 10.0 * (col + 0.5), 5000000.0 - 10.0 * (row + 0.5)
    surface = lambda x, y: 100.0 + 10.0 * np.sin((x - 500000.0) / 80.0) + 6.0 * np.cos((y - 4999000.0) / 110.0)
    dem = sb.Dem((surface(x, y) + 1.5).astype(np.float32), (500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0), wkt)
    degrees, utm = system(4326), system(UTM)
    lon, lat, _ = osr.CoordinateTransformation(utm, degrees).TransformPoint(500300.0, 4999700.0)
    size, step = 200, 2.0e-5
    g = (lon - 0.5 * size * step, step, 0.0, lat + 0.5 * size * step, 0.0, -step)
    r, c = np.mgrid[0:size, 0:size]
    places = np.c_[(g[0] + (c.ravel() + 0.5) * step), (g[3] - (r.ravel() + 0.5) * step)]
    at = np.array(osr.CoordinateTransformation(degrees, utm).TransformPoints(places.tolist()))
    fine = surface(at[:, 0], at[:, 1]).reshape(size, size)
    reference = sb.Dem(fine.astype(np.float32), g, degrees.ExportToWkt())
    found = sb.estimate_error(dem, "samples", reference=reference).report["reference"]
    assert found["count"] > 500 and found["left_out"] > 0
    assert found["median"] == pytest.approx(1.5, abs=0.01) and found["sd"] < 0.02
    assert abs(found["shift"]["dx"]) < 0.05 and abs(found["shift"]["dy"]) < 0.05


def test_level_water_is_left_out():
    z = fractal(61)
    z[:, :200] = 0.0
    model = sb.estimate_error(dem_of(z, np.where(z[::STEP, ::STEP][: KEPT[0], : KEPT[1]] == 0.0, 0.0, 1.0)),
                              reference=truth_of(z))
    found = model.report["reference"]
    assert found["equal_level"] > 5000 and any("water" in note for note in model.report["warnings"])
    assert found["median"] == pytest.approx(1.0, abs=0.01)


def test_both_reference_and_check_points():
    z = fractal(71)
    dem = dem_of(z, correlated(72, KEPT, 6.0) + 1.0)
    places, rows, cols = points_on(truth_of(z), 500)
    inside = (rows < SIZE - 16) & (cols < SIZE - 16)
    lower = np.c_[places, z[rows, cols] - 4.0][inside]  # the points' datum lies 4 m lower
    model = sb.estimate_error(dem, reference=truth_of(z), checkpoints=lower)
    assert model.shared_bias == model.report["checkpoints"]["median"] == pytest.approx(5.0, abs=0.4)
    assert model.vertical_rmse == model.report["reference"]["sigma_at_flat"]


def test_what_was_said_is_not_changed():
    z = fractal(81)
    said = sb.ErrorModel(vertical_rmse=0.3, tails="laplace", correlation_length=12.0, shared_bias=-1.0)
    model = sb.estimate_error(dem_of(z, 2.0), reference=truth_of(z), error_model=said)
    assert (model.vertical_rmse, model.horizontal_rmse, model.tails) == (0.3, 0.0, "laplace")
    assert (model.correlation_length, model.shared_bias) == (12.0, -1.0)
    assert sb.ErrorModel.from_json(model.to_json()).to_json() == model.to_json()


# ---- check points from files


def write_points(path, places, crs=UTM, field=None, three_d=True):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("points", system(crs) if crs else None, ogr.wkbPoint25D if three_d else ogr.wkbPoint)
    if field:
        layer.CreateField(ogr.FieldDefn(field, ogr.OFTReal))
        layer.CreateField(ogr.FieldDefn("name", ogr.OFTString))
    for x, y, z in places:
        feature = ogr.Feature(layer.GetLayerDefn())
        point = ogr.Geometry(ogr.wkbPoint25D if three_d else ogr.wkbPoint)
        point.AddPoint(x, y, z) if three_d else point.AddPoint_2D(x, y)
        feature.SetGeometry(point)
        if field:
            feature.SetField(field, z)
        layer.CreateFeature(feature)
    return path


@pytest.fixture
def hill():
    """A DEM in UTM, one metre above the truth, and places on it with their true heights."""
    row, col = np.mgrid[0:40, 0:50]
    truth = 100.0 + 8.0 * np.sin(col / 6.0) + 5.0 * np.cos(row / 5.0)
    dem = sb.Dem((truth + 1.0).astype(np.float32), (500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0), system(UTM).ExportToWkt())
    places, rows, cols = points_on(dem, 60)
    return dem, np.c_[places, truth[rows, cols]]


def test_points_of_a_file(hill, tmp_path):
    dem, places = hill
    with_z = write_points(tmp_path / "z.gpkg", places)
    with_field = write_points(tmp_path / "field.gpkg", places, field="height", three_d=False)
    feet = write_points(tmp_path / "feet.gpkg", places / [1.0, 1.0, 0.3048])
    for model in (
        sb.estimate_error(dem, checkpoints=with_z),
        sb.estimate_error(dem, checkpoints=with_field, elevation_field="height"),
        sb.estimate_error(dem, checkpoints=feet, checkpoint_unit="foot"),
    ):
        assert model.report["checkpoints"]["count"] == 60
        assert model.shared_bias == pytest.approx(1.0, abs=1e-3)


def test_points_of_another_crs(hill, tmp_path):
    dem, places = hill
    to_degrees = osr.CoordinateTransformation(system(UTM), system(4326))
    lon_lat = np.array(to_degrees.TransformPoints(places[:, :2].tolist()))[:, :2]
    path = write_points(tmp_path / "degrees.gpkg", np.c_[lon_lat, places[:, 2]], crs=4326)
    assert sb.estimate_error(dem, checkpoints=path).shared_bias == pytest.approx(1.0, abs=1e-3)


def test_points_outside_and_on_holes_are_counted(hill):
    dem, places = hill
    heights = dem.heights.copy()
    heights[10:20, 10:20] = np.nan
    holed = sb.Dem(heights, dem.geotransform, dem.crs_wkt)
    found = sb.estimate_error(holed, checkpoints=np.r_[places, places + [5000.0, 0.0, 0.0]]).report["checkpoints"]
    assert found["left_out"] >= 60 and found["count"] + found["left_out"] == 120 and found["count"] < 60


def test_bad_check_points(hill, tmp_path):
    dem, places = hill
    flat = write_points(tmp_path / "flat.gpkg", places, field="height", three_d=False)
    empty = write_points(tmp_path / "empty.gpkg", [])
    elsewhere = write_points(tmp_path / "elsewhere.gpkg", places, crs=32601)

    def refused(match, *arguments, error=ValueError, **more):
        with pytest.raises(error, match=match):
            sb.estimate_error(dem, *arguments, **more)

    refused("Only 9 places", checkpoints=places[:9])
    refused("Only 0 places", checkpoints=elsewhere)
    refused("is empty", checkpoints=empty)
    refused("no Z", checkpoints=flat)
    refused("no field 'z'; the layer has 'height', 'name'", checkpoints=flat, elevation_field="z")
    refused("'name' holds no numbers", checkpoints=flat, elevation_field="name")
    refused("there is no layer 'x'", checkpoints=flat, layer="x")
    refused("array \\[n, 3\\]", checkpoints=places[:, :2])
    refused("array \\[n, 3\\]", checkpoints=object())
    refused("not finite", checkpoints=places * np.nan)
    refused("missing.gpkg", checkpoints=tmp_path / "missing.gpkg", error=OSError)
    refused("samples_or_means is 'both'", "both")
    far = sb.Dem(dem.heights, (900000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0), dem.crs_wkt)
    refused("does not overlap", reference=far)


# ---- the rest


def test_maps_hold_both_parts(tmp_path):
    dem = dem_of(fractal(91))
    maps = sb.error_maps(dem, sb.ErrorModel(vertical_rmse=0.4))
    learnt = sb.estimate_error(dem)
    assert np.allclose(maps.sampling, 0.4)
    assert np.sqrt((maps.between**2).mean()) == pytest.approx(learnt.report["typical_sigma"], rel=0.05)
    maps.write(between=tmp_path / "between.tif", sampling=tmp_path / "sampling.tif")
    assert np.array_equal(sb.read_dem(tmp_path / "between.tif").heights, maps.between)
    with pytest.raises(ValueError, match="name a file"):
        maps.write()


def test_growth_is_reported():
    report = sb.estimate_error(dem_of(fractal(92))).report
    assert report["typical_sigma"] < report["rms_of_spacing"][0] < report["rms_of_spacing"][1]


def test_progress_covers_all_parts(hill):
    dem, places = hill
    seen = []
    sb.estimate_error(dem, checkpoints=places, reference=dem, progress=lambda f: seen.append(f))
    assert seen == sorted(seen) and seen[-1] == 1.0
    with pytest.raises(sb.Cancelled):
        sb.estimate_error(dem, checkpoints=places, progress=lambda f: False)
