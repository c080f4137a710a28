"""Every computed figure of the paper, by its own method and by this package's.

The paper's method (``WholeMembrane``): a membrane round the whole liquid with its wetted part,
three unknowns per control point, the stabilization of eq. (23) with ``mu = gamma``, the penalty of
eq. (24) with ``10^4 gamma / R``, the line load of eq. (32), load steps over the contact angle or
the weight. Ours: one unknown per control point, contact lines and areas held exactly, one solve.

- Figures 5 and 6: a droplet of Bond number 1 on a plane and on asperities of R / 20 at 180 degrees.
- Figure 7: the same asperities at 150 degrees. The paper's method needs the contact lines as lines
  of the mesh, which it cannot have on asperities that the droplet finds by itself: ours alone.
- Figures 8 and 10: a square sheet on a particle at 150, 120, 90 and 30 degrees.
- Figure 11: the effective force on that particle over the contact angle.

``python examples/paper_figures.py`` takes about two minutes; it prints the table of differences and
CPU times and writes the pictures ``figure_5_paper.png``, ``figure_5_ours.png`` and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import iga_membrane as iga

VOLUME = 4.0 * np.pi / 3.0
BOND = 0.3
"""Bond number of the particle in figure 11."""
SHAPE = {"color": "pressure"}
SHEET_VIEW = {"color": "none", "traction": True, "view": (1, -2, 1.2)}
FOOT = ("height", "p_base", "A_wet", "energy")
LINE = ("phi_deg", "F_CL", "energy")


@dataclass(frozen=True)
class Figure:
    """A figure of the paper.

    Attributes
    ----------
    name : its number, with the contact angle where it has several parts.
    scene : choice of the method, ``membrane`` and other arguments, to the scene.
    measures : that are compared.
    paper : the choice of the paper's method; empty where it has none.
    view : options of the picture.
    """

    name: str
    scene: Callable[..., iga.Scene]
    measures: tuple[str, ...]
    paper: dict[str, Any]
    view: dict[str, Any] = field(default_factory=dict)


def droplet(substrate: iga.Plane | iga.SphereLattice, **how: Any) -> iga.Scene:
    """The droplet of section 6.1, ``rho g = gamma / R^2``."""
    return iga.sessile_droplet(substrate, volume=VOLUME, gravity=1.0, hold="xy", **how)


def sheet(angle: float, **how: Any) -> iga.Scene:
    """The sheet of section 6.2 on a particle as dense as the liquid."""
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=(0, 0, -1), density=1.0)
    return iga.liquid_sheet(particle, size=5.0, boundary="square", gravity=BOND, **how)


def figures(radius: float = 0.05, load_steps: int = 20, elements: int = 80) -> list[Figure]:
    """All figures.

    Parameters
    ----------
    radius : of the asperities, a quarter of their spacing.
    load_steps : of the paper's method.
    elements : of the paper's method on asperities, from the middle of the foot to the widest place.
    """
    repelling, wetted = (
        iga.SphereLattice(angle, radius=radius, spacing=4.0 * radius) for angle in (180.0, 150.0)
    )
    # the penalty of the paper lets the droplet sink by a tenth of an asperity's radius
    sinking = iga.WholeMembrane(load_steps=load_steps, penetration_tolerance=0.3)
    found = [
        Figure("5", partial(droplet, iga.Plane(180.0)), FOOT, {"membrane": sinking}, SHAPE),
        Figure(
            "6",
            partial(droplet, repelling),
            FOOT,
            {"membrane": sinking, "discretization": iga.Discretization(elements=elements)},
            SHAPE,
        ),
        Figure("7", partial(droplet, wetted), FOOT, {}, SHAPE),
    ]
    for part, angle in zip("abcd", (150.0, 120.0, 90.0, 30.0), strict=True):
        how = {"membrane": iga.WholeMembrane(load_steps=load_steps)}
        found.append(Figure(f"10{part}", partial(sheet, angle), LINE, how, SHEET_VIEW))
    return found


@dataclass(frozen=True)
class Compared:
    """A figure by both methods."""

    figure: Figure
    ours: iga.Solution
    paper: iga.Solution | None

    def rows(self) -> Iterable[str]:
        """Lines of a table: a measure by the paper's method, ours and the relative difference."""
        name = self.figure.name
        ours = self.ours.cpu_seconds["solve"]
        for measure in self.figure.measures:
            own = self.ours.measures[measure]
            if self.paper is None:
                yield f"| {name} | {measure} | n/a | {own:.6g} | n/a | n/a | {ours:.2f} |"
                continue
            other, seconds = self.paper.measures[measure], self.paper.cpu_seconds["solve"]
            off = f"{other / own - 1.0:+.1e}"
            yield f"| {name} | {measure} | {other:.6g} | {own:.6g} | {off} | {seconds:.1f} | " + (
                f"{ours:.2f} |"
            )

    def draw(self, folder: Path) -> None:
        """Pictures of both."""
        stem = folder / f"figure_{self.figure.name}"
        self.ours.plot(f"{stem}_ours.png", **self.figure.view)
        if self.paper is not None:
            self.paper.plot(f"{stem}_paper.png", **self.figure.view)


def compared(figure: Figure) -> Compared:
    """A figure computed by both methods."""
    paper = None
    if figure.paper:
        paper = iga.solve(figure.scene(**figure.paper))
    return Compared(figure, iga.solve(figure.scene()), paper)


def main(
    radius: float = 0.05, load_steps: int = 20, elements: int = 80, only: Iterable[str] = ()
) -> list[Compared]:
    """Figures by both methods; all, or those with the names ``only``."""
    chosen = set(only)
    return [
        compared(figure)
        for figure in figures(radius, load_steps, elements)
        if not chosen or figure.name in chosen
    ]


def draw_forces(found: list[Compared], path: Path) -> None:
    """Figure 11: our curve, and markers of the paper's method at the angles of figure 10."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    angles = np.linspace(5.0, 175.0, 35)
    curve = [iga.solve(sheet(angle)).forces[0].effective[2] for angle in angles]
    pane, axis = plt.subplots(figsize=(6, 4), layout="constrained")
    axis.plot(angles, curve, "k-", label="ours")
    for one in found:
        if one.paper is not None and one.figure.name.startswith("10"):
            angle = one.paper.scene.substrate.contact_angle
            axis.plot(angle, one.paper.forces[0].effective[2], "ro", label="the paper's method")
    handles, labels = axis.get_legend_handles_labels()
    axis.axhline(0.0, color="0.7", lw=0.8)
    axis.set(xlabel="contact angle (degrees)", ylabel=r"effective force / ($\gamma\, r_p$)")
    axis.legend(handles[:2], labels[:2], frameon=False)
    pane.savefig(path, dpi=150)


if __name__ == "__main__":
    results = main()
    print("| figure | measure | the paper's method | ours | difference | CPU s, paper's | ours |")
    print("|---|---|---|---|---|---|---|")
    for result in results:
        print("\n".join(result.rows()))
        result.draw(Path())
    try:
        draw_forces(results, Path("figure_11.png"))
    except ImportError:
        print("figure_11.png needs matplotlib: pip install matplotlib")
