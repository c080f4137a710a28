"""A critical angle: below which contact angle does a sheet of liquid lift a particle?"""

import iga_membrane as iga


def sheet(angle, bond=0.1):
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.liquid_sheet(particle, size=5.0, boundary="circle", gravity=bond)


def main(low=90.0, high=170.0):
    return iga.critical_value(sheet, lambda found: found.forces[0].effective[2], low, high)


if __name__ == "__main__":
    angle = main().value  # 144.06 degrees
    iga.solve(sheet(angle)).plot("critical_angle.png", color="none", traction=True)
