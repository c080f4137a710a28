"""A soap film between two rings, pulled apart until there is none.

Two coaxial rings of radius R at z = +-h carry a catenoid as long as h < 0.66274342 R. The example
solves films up to the limit, compares area, neck and pull with the closed form, and asks for one
film too far: the solver answers LIMIT_POINT with a bracket of the height at which the film is lost.

Run ``python examples/film_limit.py`` to print the table and write ``film.png``.
"""

from __future__ import annotations

from collections.abc import Sequence

import iga_membrane as iga
from iga_membrane.reference import catenoid

HEIGHTS = (0.2, 0.4, 0.6, 0.65, 0.66, 0.6627)


def main(
    heights: Sequence[float] = HEIGHTS, too_far: float = 0.7
) -> tuple[list[dict[str, float]], tuple[float, float]]:
    """Films at each half height, and the bracket of the limit."""
    rows = []
    for height in heights:
        solution = iga.solve(iga.film_between_rings(half_height=height))
        exact = catenoid(height)
        row = {name: solution.measures[name] for name in ("neck_radius", "force", "A_LG")}
        row["half_height"] = height
        row["area_error"] = abs(row["A_LG"] / exact["A_LG"] - 1.0)
        row["smallest_eigenvalue"] = solution.lambda_min
        rows.append(row)
    lost = iga.solve(iga.film_between_rings(half_height=too_far), on_fail="return")
    assert lost.bracket is not None, lost.message
    return rows, (lost.bracket.lo, lost.bracket.hi)


if __name__ == "__main__":
    found, (low, high) = main()
    print("half height  neck radius      pull        area   rel. error  smallest eigenvalue")
    for r in found:
        print(
            f"{r['half_height']:11.4f}{r['neck_radius']:13.6f}{r['force']:10.6f}{r['A_LG']:12.6f}"
            f"{r['area_error']:13.1e}{r['smallest_eigenvalue']:21.4f}"
        )
    print(f"no film beyond a half height between {low:.6f} and {high:.6f} (exact 0.662743)")
    iga.solve(iga.film_between_rings(half_height=0.6)).plot("film.png")
