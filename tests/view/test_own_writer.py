"""A writer of one's own, in one file: registered from outside, whole or not at all."""

import numpy as np
import pytest

import iga_membrane as iga


@pytest.fixture(scope="module")
def drop():
    mesh = iga.Discretization(elements=8)
    return iga.solve(
        iga.sessile_droplet(iga.Plane(contact_angle=90.0), volume=1.0, discretization=mesh)
    )


@iga.writer(".points.txt")
def points_of(solution):
    """The control points, one per line."""
    points = solution.surface.points
    return lambda file: np.savetxt(file, points)


@iga.writer(".broken.txt")
def breaks_down(solution):
    def write(file):
        with open(file, "w") as half:
            half.write("half of it")
        raise OSError("the disk is full")

    return write


def test_an_own_ending_is_written_by_its_writer(drop, tmp_path):
    drop.save(tmp_path / "drop.points.txt")
    assert np.allclose(np.loadtxt(tmp_path / "drop.points.txt"), drop.surface.points)


def test_what_an_own_writer_leaves_half_done_does_not_appear(drop, tmp_path):
    with pytest.raises(iga.OutputError, match="disk is full"):
        drop.save(tmp_path / "drop.broken.txt")
    assert list(tmp_path.iterdir()) == []


def test_an_ending_without_a_writer_is_refused_with_those_there_are(drop, tmp_path):
    with pytest.raises(iga.OutputError, match=r"\.points\.txt"):
        drop.save(tmp_path / "drop.nothing")


def test_an_ending_begins_with_its_dot():
    with pytest.raises(iga.SceneError, match="from its dot on"):
        iga.writer("txt")
