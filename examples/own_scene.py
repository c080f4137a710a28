"""An own scene: a drop that hangs from a ring, and the largest one that does not fall."""

import numpy as np

import iga_membrane as iga


def hanging_drop(volume, bond=1.0):
    space = iga.drop_space("bspline", degree=4, elements=10)
    bowl = iga.axisymmetric(space, lambda t: (1.0 - t, volume * t * (2.0 - t), -np.ones_like(t)))
    weight = iga.Gravity(bond, (0.0, 0.0, 1.0))  # the drop hangs along +z
    terms = [iga.SurfaceTension(1.0), iga.Volume(volume), weight]
    return iga.Scene(bowl, terms, [iga.Fixed("xi2=0"), iga.Sector("eighth")], kind="hanging_drop")


def main(volumes=(0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 8.0)):
    return iga.trace(hanging_drop, volumes, parameter="volume", on_fail="return")


if __name__ == "__main__":
    iga.plot_curves(main(), "own_scene.png", x="volume", y="pressure")
