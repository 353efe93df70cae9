# SPDX-License-Identifier: GPL-3.0-or-later
"""viewsheds: one result per observer, each cropped to its reach, made when it is asked for."""
import numpy as np
import pytest
import sightbound as sb
import terrains

GT = (0.0, 10.0, 0.0, 2000.0, 0.0, -10.0)
EYES = [(305.0, 305.0), (1505.0, 905.0), (995.0, 1605.0)]


@pytest.fixture(scope="module")
def dem():
    return sb.Dem(terrains.fractal((200, 200), 201, 120.0), GT)


def test_each_is_the_viewshed_of_its_observer(dem):
    model = sb.ErrorModel(0.5, 0, 0)
    how = dict(observer_height=[2.0, 5.0, 9.0], max_distance=[200, 300, 400])
    found = list(sb.viewsheds(dem, EYES, error_model=model, **how))
    assert len(found) == 3
    for i, result in enumerate(found):
        alone = sb.viewshed(dem, [EYES[i]], error_model=model, observer_height=how["observer_height"][i], max_distance=how["max_distance"][i])
        assert result.geotransform == alone.geotransform and result.confidence.tobytes() == alone.confidence.tobytes()
        assert result.report["observers"][0]["x"] == EYES[i][0] and len(result.report["observers"]) == 1
    assert len({r.shape for r in found}) == 3


def test_the_error_is_that_of_the_whole_dem(dem):
    """Estimated once: the same recipe for every observer, and for all together."""
    models = {r.report["error_model"] for r in sb.viewsheds(dem, EYES, max_distance=300)}
    assert models == {sb.viewshed(dem, EYES, max_distance=300).report["error_model"]}


def test_arguments_are_checked_at_once_results_made_late(dem):
    with pytest.raises(ValueError, match="confidence"):
        sb.viewsheds(dem, EYES, confidence="x")
    with pytest.raises(ValueError, match="observer_height has 2 values for 3 observers"):
        sb.viewsheds(dem, EYES, observer_height=[1, 2])
    results = sb.viewsheds(dem, [EYES[0], (-50.0, 5.0)], max_distance=200)
    assert next(results).shape[0] < 60
    with pytest.raises(ValueError, match="outside"):
        next(results)


def test_messages_count_the_observers_as_in_one_call(dem):
    eyes = [*EYES[:2], (-50.0, 5.0)]
    results = sb.viewsheds(dem, eyes, max_distance=200, error_model=sb.ErrorModel(0.5, 0, 0))
    next(results), next(results)
    with pytest.raises(ValueError) as alone:
        next(results)
    with pytest.raises(ValueError) as together:
        sb.viewshed(dem, eyes, max_distance=200)
    assert str(alone.value) == str(together.value) and str(alone.value).startswith("Observer 3 at (-50, 5)")


def test_progress_is_of_all(dem):
    seen = []
    list(sb.viewsheds(dem, EYES, max_distance=300, progress=lambda fraction: seen.append(fraction)))
    assert seen == sorted(seen) and seen[-1] == 1.0 and 0 <= seen[0]


def test_extent_is_kept_for_each(dem):
    extent = (200.0, 200.0, 1200.0, 1200.0)
    shapes = {r.shape for r in sb.viewsheds(dem, EYES, extent=extent, error_model=sb.ErrorModel(0.5, 0, 0))}
    assert shapes == {(100, 100)}
    whole = sb.viewshed(dem, EYES, extent=extent, error_model=sb.ErrorModel(0.5, 0, 0))
    best = np.max([r.confidence for r in sb.viewsheds(dem, EYES, extent=extent, error_model=sb.ErrorModel(0.5, 0, 0))], axis=0)
    assert np.array_equal(whole.confidence, best)
