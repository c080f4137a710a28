"""An own substrate: a droplet on parallel ridges, which is longer along them than across."""

import numpy as np

import iga_membrane as iga


class Ridges:
    scale, spacing, contact_angle = 0.15, 0.5, 180.0  # radius of the ridges, tops in z = 0

    def center_of(self, which):
        return np.multiply.outer(which - 500, [self.spacing, 0.0, 0.0]) - [0.0, 0.0, self.scale]

    def radius_of(self, which):
        return np.full(np.shape(which), np.inf)  # they are no spheres

    def nearest(self, points):
        which = np.rint(points[..., 0] / self.spacing).astype(int) + 500
        away = (points - self.center_of(which)) * [1.0, 0.0, 1.0]
        distance = np.linalg.norm(away, axis=-1)
        normal = away / distance[..., None]
        ridge = normal[..., ::-1] * [1.0, 0.0, -1.0] / np.sqrt(distance)[..., None]
        return iga.Nearest(distance - self.scale, normal, 0.0 * distance, which, ridge)


def main():
    drop = iga.solve(iga.sessile_droplet(Ridges(), volume=4.19, gravity=1.0, hold="xy"))
    return drop, np.ptp(drop.surface.grid(65, 65).position.reshape(-1, 3), axis=0)


if __name__ == "__main__":
    main()[0].plot("own_substrate.png", color="pressure")
