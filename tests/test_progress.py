"""A bar on a terminal, lines in a log, nothing in a pipe unless asked."""

import logging
import os
import re
import subprocess
import sys

import pytest
from helpers import droplet_file

from iga_membrane.progress import iterations, progress_bar


def test_progress_is_a_line_for_every_tenth_in_a_log(caplog):
    with (
        caplog.at_level(logging.INFO, "iga_membrane.progress"),
        progress_bar("sweep", 40) as report,
    ):
        for done in range(41):
            report(done)
    assert caplog.messages == [f"sweep: {tenth} %" for tenth in range(10, 101, 10)]


@pytest.fixture
def command(tmp_path):
    scene = tmp_path / "scene.toml"
    more = '[[path]]\nparameter = "substrate.contact_angle"\nvalues = [120, 110]\n'
    scene.write_text(droplet_file(120.0, 1.0, more, degree=3, elements=6))
    return [sys.executable, "-m", "iga_membrane"], ["solve", str(scene), "--out", str(tmp_path)]


def test_a_pipe_gets_nothing_but_the_result_unless_asked(command):
    program, solve = command
    quiet, asked = (
        subprocess.run([*program, *flags, *solve], capture_output=True, text=True, check=True)
        for flags in ([], ["--progress"])
    )
    assert quiet.stderr == ""
    assert "solving: 100 %" in asked.stderr.splitlines()
    # phase, number and residual of every Newton iteration
    assert re.search(r"^load 1, \d+, residual \de-\d\d$", asked.stderr, re.MULTILINE)
    assert quiet.stdout.startswith("CONVERGED_STABLE")


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo terminals")
def test_a_terminal_gets_a_bar(command):
    pytest.importorskip("rich")
    program, solve = command
    there, here = os.openpty()
    run = subprocess.Popen([*program, *solve], stdout=subprocess.DEVNULL, stderr=here)
    os.close(here)
    text = b""
    try:
        while part := os.read(there, 4096):
            text += part
    except OSError:  # the terminal ends with its last user
        pass
    os.close(there)
    assert run.wait() == 0
    assert b"solving" in text
    assert re.search(rb"solving: load [\d.]+, \d+, residual \de-\d\d", text)
    assert b"100%" in text


def test_the_bar_counts_the_digits_of_one_solve(monkeypatch):
    rich = pytest.importorskip("rich.progress")
    drawn = []
    update = rich.Progress.update

    def noted(self, task, **changes):
        update(self, task, **changes)
        drawn.append((self.tasks[task].completed, self.tasks[task].description))

    monkeypatch.setattr(rich.Progress, "update", noted)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress_bar("solving"):
        for number, residual in enumerate((1e-1, 1e-3, 1e-2, 1e-6, 1e-13), start=1):
            iterations.debug("%s, %d, residual %.0e", "solve", number, residual)
    parts = [part for part, _ in drawn]
    assert parts == sorted(parts)
    assert parts[-1] == pytest.approx(1.0)
    assert drawn[-1][1] == "solving: solve, 5, residual 1e-13"
    assert not iterations.handlers


NOTEBOOK = """
import sys
import types

seen = []

class HTML:
    def __init__(self, data):
        self.data = data

class Place:
    def update(self, shown):
        seen.append(shown.data)

def display(shown, display_id):
    seen.append(shown.data)
    return Place()

shell = types.ModuleType("IPython")
shell.get_ipython = lambda: types.SimpleNamespace(kernel=object())
page = types.ModuleType("IPython.display")
page.HTML, page.display = HTML, display
sys.modules |= {"IPython": shell, "IPython.display": page}

import iga_membrane as iga
mesh = iga.Discretization(elements=6, degree=3)
drop = iga.sessile_droplet(iga.Plane(120), volume=1.0, gravity=1.0, discretization=mesh)
with iga.progress_bar("<solving>") as report:
    iga.solve(drop, report=report)
assert all("<solving>" not in each and "&lt;solving&gt;" in each for each in seen)
print(len(seen), *seen, sep="\\n")
"""


def test_a_notebook_gets_an_element_that_fills():
    """By what the kernel of a notebook answers to; nothing of it is installed here."""
    run = subprocess.run(
        [sys.executable, "-c", NOTEBOOK], capture_output=True, text=True, check=True
    )
    shown = run.stdout.splitlines()[1:]
    parts = [float(re.search(r"value='([\d.]+)'", line)[1]) for line in shown]
    assert parts == sorted(parts)
    assert (parts[0], parts[-1]) == (0.0, 1.0)
    assert any("residual" in line for line in shown)
    assert "done" in shown[-1]
