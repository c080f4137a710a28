"""BLAS on one thread in tests too; ``pytest --rounding SEED`` adds another processor's rounding."""

import pytest
from helpers import rounded_by

from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.threads import one_thread


def pytest_addoption(parser):
    parser.addoption("--rounding", type=int, help="seed of errors in the last digit")


@pytest.fixture(autouse=True)
def _blas():
    """What a test computes by itself would wait for its own threads as a solve would."""
    with one_thread:
        yield


@pytest.fixture(autouse=True)
def _rounding(request, monkeypatch):
    seed = request.config.getoption("--rounding")
    if seed is not None:
        monkeypatch.setattr(Assembly, "system", rounded_by(seed))
