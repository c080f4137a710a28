"""A convergence study: error of the energy against unknowns, splines and Lagrange elements."""

import iga_membrane as iga
from iga_membrane.reference import drop_on_plane


def droplet(mesh):
    plane = iga.Plane(contact_angle=120)
    return iga.sessile_droplet(plane, volume=4.19, gravity=1.0, discretization=mesh)


def main(elements=(4, 8, 16)):
    exact = {"energy": drop_on_plane(1.0, 120.0, 4.19)["energy"]}
    spaces = [("bspline", 2), ("bspline", 3), ("lagrange", 2)]
    return iga.convergence_study(droplet, spaces=spaces, elements=elements, exact=exact)


if __name__ == "__main__":
    main().plot("convergence_study.png", measure="energy", against="unknowns")
