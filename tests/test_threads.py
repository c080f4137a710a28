"""BLAS on one thread while solving, the user's own number of threads again afterwards."""

import os
import subprocess
import sys
import threading
from time import thread_time

import pytest
from helpers import droplet, within
from threadpoolctl import threadpool_info, threadpool_limits

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly
from iga_membrane.deadline import OutOfTime, check_time, until
from iga_membrane.threads import one_thread


def blas():
    """Numbers of threads of the libraries of this process."""
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def _blas():
    """Here it has the threads that the user asks for."""


@pytest.fixture(params=[2, 3])
def asked(request):
    """What the user has asked for."""
    with threadpool_limits(request.param):
        yield request.param


@pytest.fixture
def seen(monkeypatch):
    """Numbers of threads met while matrices are assembled."""
    met, original = set(), Assembly.system

    def watched(self, *arguments):
        met.update(blas())
        return original(self, *arguments)

    monkeypatch.setattr(Assembly, "system", watched)
    return met


def path():
    iga.trace(lambda angle: droplet(angle, elements=6), [90.0, 100.0])


SOLVES = {
    "solve": lambda: iga.solve(droplet(100, elements=6)),
    "a solve that fails": lambda: iga.solve(
        droplet(100, elements=6), iga.SolverOptions(max_iterations=1), on_fail="return"
    ),
    "trace": path,
}


@pytest.mark.parametrize("name", SOLVES)
def test_blas_has_one_thread_inside_and_the_users_number_afterwards(name, asked, seen):
    SOLVES[name]()
    assert seen == {1}
    assert blas() == {asked}


def test_an_error_inside_gives_the_users_number_back(asked):
    with pytest.raises(iga.SceneError):
        iga.solve(None)
    with pytest.raises(ZeroDivisionError), one_thread, one_thread:
        raise ZeroDivisionError
    assert blas() == {asked}


def test_the_limit_holds_until_the_last_thread_has_left(asked):
    inside, leave = threading.Event(), threading.Event()

    def other():
        with one_thread:
            inside.set()
            leave.wait(60)

    beside = threading.Thread(target=other)
    with one_thread:
        beside.start()
        inside.wait(60)
    assert blas() == {1}
    leave.set()
    beside.join()
    assert blas() == {asked}


def test_two_solves_at_once_are_those_of_one_after_the_other(asked):
    scenes = [droplet(120, elements=8, model="full"), droplet(150, 1.0, elements=12)]
    alone = [iga.solve(scene).measures for scene in scenes]
    found = {}
    threads = [
        threading.Thread(target=lambda k=k: found.update({k: iga.solve(scenes[k]).measures}))
        for k in (0, 1)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for k in (0, 1):
        assert found[k] == pytest.approx(alone[k], rel=1e-10, abs=1e-12)
    assert blas() == {asked}


LATER = """
import sys, numpy
from threadpoolctl import threadpool_info
from iga_membrane.threads import one_thread
def blas(): return sorted(p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas")
assert "scipy.linalg" not in sys.modules
print(blas())
with one_thread:
    import scipy.linalg
    with one_thread:
        print(blas())
    print(blas())
print(blas())
"""
WORK = """
from time import process_time, thread_time
import iga_membrane as iga
mesh = iga.Discretization(elements=40, model="full")
process, thread = process_time(), thread_time()
iga.solve(iga.liquid_sheet(None, size=1.0, pressure=1.0, discretization=mesh))
solve = thread_time() - thread
print(process_time() - process - solve, solve)
"""
LOADING = """
from time import process_time, sleep, thread_time
import numpy
process, thread = process_time(), thread_time()
import scipy.linalg
sleep(0.5)
print(process_time() - process - (thread_time() - thread))
"""


def in_a_process(code):
    environment = {name: v for name, v in os.environ.items() if not name.endswith("NUM_THREADS")}
    environment |= {"OPENBLAS_NUM_THREADS": "2", "PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run([sys.executable, "-c", code], env=environment, check=True,
                         capture_output=True, text=True)  # fmt: skip
    return run.stdout.split("\n")


def test_a_library_that_is_loaded_inside_is_held_and_given_back_too():
    before, inside, outer, after, _ = in_a_process(LATER)
    if before != "[2]":
        pytest.skip("numpy and scipy do not bring a BLAS of their own each")
    assert (inside, outer, after) == ("[1, 1]", "[1, 1]", "[2, 2]")


def test_nothing_begins_after_its_deadline():
    began = []
    with pytest.raises(OutOfTime), until(thread_time() - 1.0):
        began.append(True)
    assert not began


def test_a_first_solve_of_a_process_keeps_only_its_own_thread_busy():
    """With a sparse matrix, for which scipy's BLAS is loaded midway: as any BLAS does, whatever it
    is loaded for, it starts its threads, and they wait actively for a time before they sleep."""
    others, solve = map(float, in_a_process(WORK)[0].split())
    loading = float(in_a_process(LOADING)[0])
    assert others <= 0.1 * solve + 1.5 * loading


def test_one_thread_is_kept_where_another_thread_has_set_the_number():
    """threadpoolctl >= 3.8 lets only one thread of Python set it."""
    with threadpool_limits(2):
        met = set()

        def other():
            with one_thread:
                met.update(blas())

        beside = threading.Thread(target=other)
        beside.start()
        beside.join()
        assert met == {1}
        assert blas() == {2}
        with threadpool_limits(3):
            assert blas() == {3}
        assert blas() == {2}


def test_to_enter_costs_less_than_a_millisecond():
    with one_thread:
        pass
    with within(0.1):
        for _ in range(100):
            with one_thread:
                pass


def burn(seconds):
    end = thread_time() + seconds
    while thread_time() < end:
        pass


def test_the_cpu_limit_counts_the_thread_that_solves():
    with until(thread_time() + 0.1):
        beside = threading.Thread(target=burn, args=(0.2,))
        beside.start()
        beside.join()
        check_time()
        burn(0.2)
        with pytest.raises(OutOfTime):
            check_time()


def test_a_busy_thread_beside_takes_nothing_from_a_solves_limit(monkeypatch):
    """Which spends more than the limit during every Newton step."""
    original = Assembly.system

    def waiting(self, *arguments):
        beside = threading.Thread(target=burn, args=(0.4,))
        beside.start()
        beside.join()
        return original(self, *arguments)

    monkeypatch.setattr(Assembly, "system", waiting)
    assert iga.solve(droplet(100, elements=6), iga.SolverOptions(max_cpu_s=0.35)).success
