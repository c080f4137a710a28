"""Sweeps on engines of others: two workers, one killed midway; nothing is lost."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path

import pytest
from analysis.cluster_sweep import ANGLES
from analysis.sweep_scenes import drop

import iga_membrane as iga
from iga_membrane.analysis.record_store import RecordStore

HERE = Path(__file__).parent
MPIEXEC = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}:{os.environ['PATH']}")


def run(command, out):
    """The last words of a program that sweeps; None if it broke off."""
    paths = [str(HERE.parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {name: v for name, v in os.environ.items() if not name.endswith("NUM_THREADS")}
    environment["PYTHONPATH"] = os.pathsep.join(paths)
    ended = subprocess.run([*command, str(out)], env=environment, text=True, timeout=300,
                           capture_output=True)  # fmt: skip
    if ended.returncode:
        return None, ended.stderr
    return tuple(ended.stdout.split()[-3:]), ended.stderr


def finished(out):
    store = RecordStore(out)
    return {path.stem: store.read(path.stem) for path in out.glob("*.json")}


def check(out):
    """All points there, and the numbers of a sweep in this process, bit by bit."""
    with ThreadPoolExecutor(1) as executor:
        plain = iga.sweep(drop, {"angle": ANGLES}, executor=executor).records
    kept = finished(out)
    assert len(kept) == len(plain)
    for record in plain:
        found = kept[RecordStore.key(record["parameters"])]
        assert found["result"]["measures"] == record["result"]["measures"]
    assert not list(out.glob(".*.claim"))


@pytest.fixture
def out(tmp_path):
    (tmp_path / "points.died").mkdir()
    return tmp_path / "points"


@pytest.mark.slow
@pytest.mark.skipif(not find_spec("distributed"), reason="dask.distributed is not installed")
def test_a_dask_worker_that_is_killed_loses_nothing(out):
    said, error = run([sys.executable, str(HERE / "cluster_sweep.py"), "dask"], out)
    assert said == (str(len(ANGLES)), str(len(ANGLES)), "True"), error
    assert len(list((out.parent / "points.died").iterdir())) == 1  # a worker was killed
    check(out)


@pytest.mark.slow
@pytest.mark.skipif(not (find_spec("mpi4py") and MPIEXEC), reason="mpi4py or mpiexec is missing")
def test_an_mpi_job_that_loses_a_worker_goes_on_when_it_is_run_again(out):
    program = ["-m", "mpi4py.futures", str(HERE / "cluster_sweep.py"), "mpi"]
    command = [MPIEXEC, "-n", "3", sys.executable, *program]
    said, error = run(command, out)
    assert said is None, error  # MPI ends a job whose process dies
    before = finished(out)
    assert None not in before.values()
    assert 0 < len(before) < len(ANGLES)
    said, error = run(command, out)
    assert said == (str(len(ANGLES)), str(len(ANGLES) - len(before)), "True"), error
    assert all(finished(out)[key] == record for key, record in before.items())
    check(out)
