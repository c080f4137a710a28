"""The tilt, in degrees, at which a droplet lets go of the particle that holds it on a plane."""

import numpy as np

import iga_membrane as iga

PLANE, PARTICLE = iga.Plane(150.0), iga.Sphere(70.0, radius=0.3, center=(0.0, 0.0, 1.62))


def scene(tilt: float, elements: int | None = None) -> iga.Scene:
    down = np.array([np.sin(np.radians(tilt)), 0.0, -np.cos(np.radians(tilt))])
    mesh, volume = iga.Discretization(elements=elements, model="half"), 4.0 * np.pi / 3.0
    return iga.sessile_droplet(
        PLANE, volume=volume, gravity=0.5 * down, particles=[PARTICLE], discretization=mesh
    )


def main(elements: int | None = None, tilts: tuple[float, ...] = (0.0, 5.0, 30.0)) -> iga.Path:
    return iga.trace(lambda t: scene(t, elements), tilts, parameter="tilt", on_fail="return")


if __name__ == "__main__":
    end = main().end
    print(end.message)
    end.plot("critical_tilt.png", color="pressure", view=(0.0, -1.0, 0.1))
