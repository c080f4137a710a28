"""An own spline space: cubics that are C1 only, beside the smoothest ones."""

import numpy as np

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane


def rough(elements, degree):
    breaks = np.linspace(0.0, 1.0, elements + 1)
    ends, inner = degree + 1, degree - 1  # knots that are repeated inside leave C1
    return iga.bspline_basis(np.repeat(breaks, [ends, *[inner] * (elements - 1), ends]), degree)


def droplet(mesh):
    plane = iga.Plane(contact_angle=120)
    return iga.sessile_droplet(plane, volume=4.19, gravity=1.0, discretization=mesh)


def main(elements=(4, 8, 16)):
    exact = {"energy": drop_on_plane(1.0, 120.0, 4.19)["energy"]}
    spaces = [("bspline", 3), (rough, 3)]
    return iga.convergence_study(droplet, spaces=spaces, elements=elements, exact=exact)


if __name__ == "__main__":
    main().plot("own_space.png", measure="energy", against="unknowns")
