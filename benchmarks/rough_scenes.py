"""Thirty droplets at 180 degrees on substrates with few or no mirror planes: how each solve ends.

Run ``python benchmarks/rough_scenes.py`` (about twenty CPU minutes);
writes docs/results/rough_scenes.md. Default meshes. Hexagonal and square lattices off the droplet's
middle, lists of spheres at random places with a least distance, of one and of two sizes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
ROOT = Path(__file__).parents[1]


def scattered(seed: int, radii: tuple[float, ...], distance: float, reach: float = 1.6) -> object:
    """Spheres at random places within ``reach`` of the axis, no two closer than ``distance``."""
    random = np.random.default_rng(seed)
    places: list[np.ndarray] = []
    for _ in range(4000):
        place = random.uniform(-reach, reach, 2)
        if all(np.hypot(*(place - other)) >= distance for other in places):
            places.append(place)
    sizes = random.choice(radii, len(places))
    centers = np.column_stack([np.array(places), -sizes])
    return iga.Spheres(contact_angle=180.0, centers=centers, radii=sizes)


def told(defect: float | None) -> str:
    """A defect in a table; "n/a" where no evidence of it was gathered."""
    return "n/a" if defect is None else f"{defect:.1e}"


def scenes() -> Iterator[tuple[str, object, float]]:
    """Name, substrate and Bond number of each."""
    for bond in (0.5, 1.0, 2.0):
        for offset in ((0.0, 0.0), (0.06, 0.0), (0.06, 0.1)):
            for arrangement in ("hexagonal", "square"):
                lattice = iga.SphereLattice(180.0, 0.1, 0.3, arrangement, offset)
                yield f"{arrangement}, offset {offset}", lattice, bond
        for seed in (1, 2):
            yield f"random, seed {seed}", scattered(seed, (0.1,), 0.26), bond
            yield f"two sizes, seed {seed}", scattered(seed, (0.08, 0.12), 0.3), bond


def main() -> None:
    head = ("substrate", "Bond", "model", "unknowns", "status", "wet", "its", "CPU s",
            "smallest eigenvalue", "penetration / r", "force balance")  # fmt: skip
    rows = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    solved = 0
    for name, substrate, bond in scenes():
        scene = iga.sessile_droplet(substrate, volume=VOLUME, gravity=bond)
        s = iga.solve(scene, on_fail="return")
        solved += s.success
        audit = s.audit
        rows.append(
            f"| {name} | {bond:g} | {s.scene.sector.model} | {s.unknowns} | {s.status.name} | "
            f"{s.contact['wet_solids']} | {s.newton_iterations} | {s.cpu_seconds['solve']:.1f} | "
            + (f"{s.lambda_min:.3f}" if s.lambda_min is not None else "-")
            + f" | {told(audit and audit.penetration)} | {told(audit and audit.force)} |"
        )
        print(rows[-1], flush=True)
    text = "\n".join(
        ["# Thirty rough substrates", "", (__doc__ or "").strip(), "",
         f"{solved} of {len(rows) - 2} end CONVERGED_STABLE.", "", *rows, ""]
    )  # fmt: skip
    (ROOT / "docs/results/rough_scenes.md").write_text(text)


if __name__ == "__main__":
    main()
