"""An own energy: a soap film on a ring, drawn to a plate by a voltage until it snaps down."""

from dataclasses import dataclass

import numpy as np

import iga_membrane as iga


@dataclass(frozen=True)
class Voltage(iga.GapTerm):
    solid: iga.Solid
    strength: float

    def law(self, gap):  # energy per area -strength / gap, with two derivatives
        return -self.strength / gap, self.strength / gap**2, -2.0 * self.strength / gap**3


def film(load, height=0.05):  # load = strength / (gamma height^3)
    space = iga.drop_space("bspline", degree=4, elements=12)
    flat = iga.axisymmetric(space, lambda t: (1.0 - t, 0.0 * t, -np.ones_like(t)))
    plate = iga.Plane(contact_angle=90, point=(0, 0, -height))
    terms = [iga.SurfaceTension(1.0), Voltage(plate, load * height**3)]
    return iga.Scene(flat, terms, [iga.Fixed("xi2=0"), iga.Sector("eighth")])


def main(loads=(0.2, 0.4, 0.6, 0.7, 0.75, 0.78, 1.0)):
    return iga.trace(film, loads, parameter="load", on_fail="return")


if __name__ == "__main__":
    iga.plot_curves(main(), "own_energy.png", x="load", y="volume")
