# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, cancelling, Ctrl-C: within 0.2 s, other threads keep running, nothing is left behind."""
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import sightbound as sb
import terrains

PROMPT = 0.2   # seconds from asking to stop to having stopped
SIDE = 3000


@pytest.fixture(scope="module")
def big():
    """Nine million rough cells with a large error: seconds of work."""
    tile = terrains.fractal((500, 500), 141, 300.0, roughness=1.4)
    row = np.concatenate([tile, tile[:, ::-1]] * 3, axis=1)
    return sb.Dem(np.ascontiguousarray(np.concatenate([row, row[::-1]] * 3)), (0, 10, 0, 10 * SIDE, 0, -10))


HARD = dict(observer_height=200.0, heights=True, threads=1, error_model=sb.ErrorModel(vertical_rmse=10.0, geologic_variation=20.0, geologic_range=5.0))
EYE = [(5 * SIDE + 5.0, 5 * SIDE + 5.0)]


def test_progress_rises_to_one():
    dem = sb.Dem(terrains.fractal((300, 300), 142, 200.0, 1.4), (0, 10, 0, 3000, 0, -10))
    seen, times, threads = [], [], set()

    def progress(fraction):
        seen.append(fraction)
        times.append(time.monotonic())
        threads.add(threading.get_ident())

    started = time.monotonic()
    sb.viewshed(dem, [(1505, 1505), (505, 505)], progress=progress, **HARD)
    took = time.monotonic() - started
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] == 1.0
    assert threads == {threading.get_ident()}
    assert len(seen) <= 10 * took + 3


@pytest.mark.parametrize("after", [0.0, 0.05, 0.4])
def test_cancel(big, after):
    asked = []
    started = time.monotonic()

    def progress(fraction):
        if time.monotonic() - started >= after:
            asked.append(time.monotonic())
            return False
        return True

    with pytest.raises(sb.Cancelled):
        sb.viewshed(big, EYE, progress=progress, **HARD)
    stopped = time.monotonic()
    assert len(asked) == 1 and stopped - asked[0] < PROMPT
    assert stopped - started < after + 0.15 + PROMPT   # asked in time, too


def test_none_and_true_go_on():
    dem = sb.Dem(np.zeros((40, 40), np.float32), (0, 10, 0, 400, 0, -10))
    for answer in (None, True, 1):
        sb.viewshed(dem, [(205, 205)], progress=lambda fraction: answer)


def test_an_exception_in_progress_comes_through(big):
    class Mine(Exception):
        pass

    def progress(fraction):
        raise Mine("from the callback")

    with pytest.raises(Mine, match="from the callback"):
        sb.viewshed(big, EYE, progress=progress, **HARD)


@pytest.fixture
def interruptible():
    """A shell's background jobs ignore SIGINT, and so would what they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("after", [0.1, 0.5])
def test_ctrl_c(big, after, interruptible):
    sent = []

    def press():
        time.sleep(after)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt):
        sb.viewshed(big, EYE, **HARD)
    assert time.monotonic() - sent[0] < PROMPT


def test_other_threads_run_meanwhile(big):
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    started = time.monotonic()
    with pytest.raises(sb.Cancelled):
        sb.viewshed(big, EYE, progress=lambda fraction: time.monotonic() - started < 0.5, **HARD)
    stop.set()
    other.join()
    assert counted[0] > 50


def test_two_jobs_at_once():
    dem = sb.Dem(terrains.fractal((200, 200), 143, 200.0), (0, 10, 0, 2000, 0, -10))
    alone = [sb.viewshed(dem, [(x, 1005)]).confidence.tobytes() for x in (505, 1505)]
    found = {}

    def run(i, x):
        found[i] = sb.viewshed(dem, [(x, 1005)]).confidence.tobytes()

    jobs = [threading.Thread(target=run, args=a) for a in ((0, 505), (1, 1505))]
    for job in jobs:
        job.start()
    for job in jobs:
        job.join()
    assert [found[0], found[1]] == alone


def test_cancel_everything_else(big, tmp_path):
    """Estimate, error surfaces, writing: each stops when asked."""
    result = sb.viewshed(big, EYE, max_distance=9000, error_model=sb.ErrorModel(1.0, 0, 0))
    target = tmp_path / "confidence.tif"
    for job in (lambda p: sb.estimate_error(big, progress=p), lambda p: sb.error_surfaces(big, progress=p),
                lambda p: next(sb.viewsheds(big, EYE, progress=p)), lambda p: sb.line_of_sight(big, EYE[0], (105.0, 105.0), progress=p),
                lambda p: result.write(target, progress=p)):
        asked = []

        def progress(fraction):
            asked.append(time.monotonic())
            return False

        with pytest.raises(sb.Cancelled):
            job(progress)
        assert time.monotonic() - asked[0] < PROMPT
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_ends_a_script(tmp_path, interruptible):
    """The process of a user: SIGINT from outside, no handler of ours."""
    script = tmp_path / "job.py"
    script.write_text(f"""
import sys
sys.path.insert(0, {str(Path(sb.__file__).resolve().parent.parent)!r})
import numpy as np, sightbound as sb
z = np.random.default_rng(0).uniform(0, 90, ({SIDE}, {SIDE})).astype(np.float32)
dem = sb.Dem(z, (0, 10, 0, {10 * SIDE}, 0, -10))
print('ready', flush=True)
sb.viewshed(dem, [({EYE[0][0]}, {EYE[0][1]})], observer_height=200.0, heights=True, threads=1,
            error_model=sb.ErrorModel(10.0, 0.0, 20.0, 5.0))
print('finished', flush=True)
""")
    job = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert job.stdout.readline() == "ready\n"
    time.sleep(0.4)
    job.send_signal(signal.SIGINT)
    sent = time.monotonic()
    out, err = job.communicate(timeout=20)
    assert "finished" not in out and "KeyboardInterrupt" in err
    assert time.monotonic() - sent < 2.0   # the interpreter's own end included
