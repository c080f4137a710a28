"""A parameter sweep: heights of droplets over contact angle and Bond number, and their picture."""

import iga_membrane as iga


def droplet(angle, bond):
    return iga.sessile_droplet(iga.Plane(contact_angle=angle), volume=4.19, gravity=bond)


def main(angles=(60.0, 90.0, 120.0, 150.0), bonds=(0.1, 1.0, 4.0), **options):
    return iga.sweep(droplet, {"angle": list(angles), "bond": list(bonds)}, **options)


if __name__ == "__main__":
    found = main(out="droplets")
    found.save("droplets.csv")
    iga.plot_curves(found, "parameter_sweep.png", x="angle", y="height", by="bond")
