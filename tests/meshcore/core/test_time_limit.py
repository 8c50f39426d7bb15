"""Limits on processor time."""

import time

import pytest

from meshwright_core.core.time_limit import check_time, time_left, time_limit
from meshwright_core.errors import MeshError


def busy(seconds):
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


def test_without_a_limit_there_is_time():
    check_time()
    assert time_left() == float("inf")


def test_what_takes_longer_is_refused_in_one_sentence():
    with time_limit(0.01):
        check_time()
        busy(0.02)
        assert time_left() == 0.0
        with pytest.raises(MeshError, match=r"more than 0\.01 s of processor time") as error:
            check_time()
    assert "\n" not in str(error.value)
    check_time()


def test_the_outer_limit_stays():
    with time_limit(100.0), time_limit(0.001):
        busy(0.005)
        check_time()
        assert time_left() > 1.0


def test_a_limit_is_positive():
    with pytest.raises(MeshError, match="positive"), time_limit(0.0):
        pass
