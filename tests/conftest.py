"""Rounding of another processor: ``pytest --rounding SEED`` adds it to every assembled system."""

import pytest
from helpers import rounded_by

from iga_membrane.solver.assembly import Assembly


def pytest_addoption(parser):
    parser.addoption("--rounding", type=int, help="seed of errors in the last digit")


@pytest.fixture(autouse=True)
def _rounding(request, monkeypatch):
    seed = request.config.getoption("--rounding")
    if seed is not None:
        monkeypatch.setattr(Assembly, "system", rounded_by(seed))
