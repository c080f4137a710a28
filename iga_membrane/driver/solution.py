"""A solution is a record: status, state, measures, history."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import checked
from ..arrays import Array
from ..checks import integer, items, mapping, real
from ..lazy import part
from ..overview import Overview, Told
from ..own import complaints
from ..problems.scene import Scene
from ..quantities import DIMENSIONLESS, told_value
from ..results.forces import ParticleForces
from ..solids import Sphere
from ..solvers.load_path import Bracket, LoadStep, Progress
from ..solvers.newton import Iteration
from ..status import Status
from ..surface.kinematics import Kinematics
from ..surface.surface import Surface
from ..tables import dataframe
from ..terms import BodyDensity
from ..verification.evidence import Audit


@dataclass(frozen=True, eq=False, repr=False)
@checked(
    measures=mapping,
    unknowns=partial(integer, least=0),
    multipliers=mapping,
    lambda_min=real,
    hold_force=partial(items, each=real, count=3),
    cpu_seconds=mapping,
    volume_error=real,
)
class Solution(Told):
    """What a solve found.

    Attributes
    ----------
    scene : what was asked.
    status : how the solve ended; message : one sentence with cause and remedy.
    surface : the state, in world coordinates and the user's units.
    measures : energies, areas, heights, pressures, by the names of the result file; None where a
        formula has no value, of which a warning tells.
    multipliers : of the constraints, by name, in the user's units.
    body : energy per volume of the Lagrangian in local, dimensionless units: minus the pressure.
    index : negative eigenvalues; lambda_min : smallest one (tension over squared length). After a
        failed solve both, like the audit, are those of the best state found.
    mode : (count, 3) motion of the control points with that eigenvalue, in world axes, its largest
        one 1, either way; of a saddle or a marginal state, else None.
    audit : relative defects found by the independent check, each None where it was not looked for.
    hold_force : (3,) total force that holds the centroid.
    forces : on each particle.
    contact : wetted area, support force, penetration, by the names of the result file.
    bracket : of the limit point where the status is LIMIT_POINT.
    iterations : the Newton iterations; load_steps : the loads tried.
    cpu_seconds : by what they were spent on.
    volume_error : of a prescribed volume, relative.
    progress : of load stepping that stopped short; a state file keeps it, and a solve that starts
        from that file goes on there.
    unknowns : their number.
    warnings : what the user should know.
    stability_scope : "full" where the stability of the whole body was judged, else the model within
        whose symmetry it was.
    mode_within : the smallest model whose motions include the mode's kind.
    kind : of a status that has several, as TOPOLOGY_CHANGE.
    """

    scene: Scene
    status: Status
    message: str
    surface: Surface = field(repr=False)
    measures: Mapping[str, Any] = field(repr=False)
    multipliers: Mapping[str, float] = field(repr=False)
    body: BodyDensity = field(repr=False)
    index: int | None
    lambda_min: float | None
    audit: Audit | None = field(repr=False)
    hold_force: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), repr=False)
    contact: Mapping[str, Any] = field(default_factory=dict, repr=False)
    forces: tuple[ParticleForces, ...] = ()
    unknowns: int = 0
    iterations: Sequence[Iteration] = field(default=(), repr=False)
    load_steps: Sequence[LoadStep] = field(default=(), repr=False)
    cpu_seconds: Mapping[str, float] = field(default_factory=dict, repr=False)
    bracket: Bracket | None = None
    warnings: Sequence[str] = ()
    kind: str | None = None
    volume_error: float | None = None
    progress: Progress | None = field(default=None, repr=False)
    mode: Array | None = field(default=None, repr=False)
    stability_scope: str = "full"
    mode_within: str | None = None

    @property
    def success(self) -> bool:
        """Converged, audited and stable."""
        return self.status is Status.CONVERGED_STABLE

    @property
    def mode_beyond_model(self) -> bool:
        """Whether the computed part of an unstable body cannot take the motion of its mode."""
        return self.mode is not None and self.mode_within != self.scene.sector.model

    @property
    def last_good_load(self) -> LoadStep | None:
        """The last load step that converged; of a path, with the parameter's value."""
        return next((step for step in reversed(self.load_steps) if step.status is None), None)

    @property
    def newton_iterations(self) -> int:
        """All Newton iterations, of every load."""
        return sum(step.iterations for step in self.load_steps)

    @property
    def dimensionless(self) -> dict[str, float]:
        """Numbers that do not depend on the units.

        ``bond_number`` is ``rho g L^2 / gamma`` with the length of the scene's scale (droplets:
        the radius of a ball of the volume; sheets: the particle's radius). Of a droplet also
        ``apparent_angle`` in degrees, on smooth solids the measured contact angle, and
        ``wetted_fraction``, the wetted area over that of a disc of the contact radius.
        """
        scene = self.scene
        terms = scene.by_form
        weights = [t.density_of_liquid * np.array(t.acceleration) for t in terms.weights]
        weights = weights or [scene.liquid_density * np.array(scene.acceleration)]
        gamma = sum(t.gamma for t in terms.surface_tensions)
        weight, length = float(np.linalg.norm(np.sum(weights, axis=0))), scene.units.length
        if scene.kind == "sessile_droplet" and terms.volume is not None:
            length = float(np.cbrt(3.0 * terms.volume.value / (4.0 * np.pi)))
        elif scene.kind == "liquid_sheet" and isinstance(scene.substrate, Sphere):
            length = scene.substrate.radius
        found = {"bond_number": weight * length**2 / gamma}
        if scene.kind == "sessile_droplet":
            for name in ("contact_angle_measured", "apparent_angle"):
                if self.measures.get(name) is not None:
                    found["apparent_angle"] = self.measures[name]
            if self.contact.get("wet_fraction") is not None:
                found["wetted_fraction"] = float(self.contact["wet_fraction"])
        return found

    def pressure(self, points: Array) -> Array:
        """Pressure, liquid minus gas, at world points (..., 3): paper eq. (21)."""
        scale = self.scene.units
        local = scale.to_local(points)
        density = self.body.constant + local @ np.array(self.body.gradient)
        return np.asarray(-density * scale.pressure)

    def laplace_residual(self, kinematics: Kinematics) -> Array:
        """Out-of-plane balance ``2 H gamma + p``, eq. (20), zero at equilibrium.

        H is exact from the spline's second derivatives; it converges two orders slower than the
        shape, so this is an error indicator.
        """
        return np.asarray(
            2.0 * kinematics.mean_curvature * self._tension + self.pressure(kinematics.position)
        )

    def mean_curvature(self, kinematics: Kinematics) -> Array:
        """H from the pressure, ``-p / (2 gamma)``: converges faster than the spline's own H."""
        return np.asarray(-self.pressure(kinematics.position) / (2.0 * self._tension))

    def in_plane_residual(self, kinematics: Kinematics) -> Array:
        """In-plane balance ``sigma^ab_;b``, eq. (18), as contravariant components (..., 2).

        ``sigma^ab = gamma a^ab`` and the metric is covariantly constant, so this is rounding for
        any shape; it tests the Christoffel symbols of the geometry.
        """
        inverse, gamma = kinematics.inverse_metric, kinematics.christoffel
        second = kinematics.second
        assert second is not None
        # a^ab_,c = -a^ad (a_de,c) a^eb
        slope = np.einsum("...aci,...bi->...abc", second, kinematics.tangents)
        metric_slope = slope + np.swapaxes(slope, -3, -2)
        change = -np.einsum("...ad,...dec,...eb->...abc", inverse, metric_slope, inverse)
        divergence = (
            np.einsum("...abb->...a", change)
            + np.einsum("...bda,...db->...a", gamma, inverse)
            + np.einsum("...bdb,...ad->...a", gamma, inverse)
        )
        return np.asarray(self._tension * divergence)

    @property
    def _tension(self) -> float:
        """Energy per area of the membrane."""
        return self.scene.by_form.tension

    def overview(self) -> Overview:
        """Its status, measures with units, stability and effort."""
        system = self.scene.unit_system
        rows = [(name, told_value(name, value, system)) for name, value in self.measures.items()]
        rows += [(name.replace("_", " "), f"{v:.6g}") for name, v in self.dimensionless.items()]
        if self.lambda_min is not None:
            verdict = f"index {self.index}, smallest eigenvalue {self.lambda_min:.4g}"
            rows.append(("stability", verdict))
        seconds = self.cpu_seconds.get("solve", 0.0)
        effort = f"{self.unknowns} unknowns, {self.newton_iterations} iterations, {seconds:.2f} s"
        rows += [("effort", effort), *(("warning", text) for text in self.warnings)]
        kind = self.scene.kind.replace("_", " ")
        return Overview(f"{self.status.name}, {kind}, {system}: {self.message}", rows)

    def portrait(self) -> bytes | None:
        """A small picture of it (PNG), where this machine can draw."""
        return part("view.portrait", "portrait")(self)

    def summary(self) -> str:
        """Status, measures, effort, in a few lines."""
        lines = [f"{self.status.name}: {self.message}"]
        lines += [
            f"  {name:<24} {told_value(name, value, self.scene.unit_system, 10)}"
            for name, value in self.measures.items()
        ]
        if self.scene.unit_system == DIMENSIONLESS:
            lines.append(f"  {'units':<24} dimensionless: the numbers given had none")
        numbers = ", ".join(
            f"{name.replace('_', ' ')} {value:.6g}" for name, value in self.dimensionless.items()
        )
        lines.append(f"  {'without units':<24} {numbers}")
        if self.lambda_min is not None:
            lines.append(
                f"  {'stability':<24} index {self.index}, smallest eigenvalue "
                f"{self.lambda_min:.4g} (of the {self.stability_scope} body)"
            )
        checks = self.audit.checks() if self.audit else ()
        lines.append(f"  {'audit':<24} {', '.join(map(str, checks)) or 'n/a'}")
        seconds = ", ".join(f"{k} {v:.3f}" for k, v in self.cpu_seconds.items())
        lines.append(
            f"  {'effort':<24} {self.unknowns} unknowns, {self.newton_iterations} iterations, "
            f"{len(self.load_steps)} load steps; CPU s: {seconds}"
        )
        lines += [f"  warning: {text}" for text in self.warnings]
        return "\n".join(lines)

    def plot(self, path: str | Path | None = None, **options: Any) -> Any:
        """Picture of the solution (:func:`iga_membrane.view.picture.plot`)."""
        return part("view.picture", "plot")(self, path, **options)

    def save(self, path: str | Path) -> None:
        """Write a file by its ending (:func:`iga_membrane.view.export.save`)."""
        part("view.export", "save")(self, path)

    def row(self) -> dict[str, Any]:
        """The result as one row of a table (:func:`.result_file.row`)."""
        return dict(part("driver.result_file", "row")(self))

    def to_dataframe(self) -> Any:
        """``pandas.DataFrame`` of one row: status, measures, numbers without units, forces.

        Raises
        ------
        OutputError
            If pandas is not installed.
        """
        return dataframe([self.row()])

    def to_xarray(self, resolution: int = 65) -> Any:
        """``xarray.Dataset`` of position, normal and fields on a regular grid of the parameters.

        Raises
        ------
        OutputError
            If xarray is not installed.
        """
        return part("view.tables", "field_dataset")(self, resolution)


def blamed(solution: Solution) -> Solution:
    """A solution that is no success, with what was noted of the user's own functions."""
    noted = complaints()
    if solution.success or not noted or noted in solution.message:
        return solution
    return replace(solution, message=solution.message + noted)


def with_effort(solution: Solution, attempts: Sequence[Solution]) -> Solution:
    """A solution with the iterations, load steps and CPU seconds of all attempts, itself one."""
    seconds = {
        part: sum(one.cpu_seconds[part] for one in attempts) for part in solution.cpu_seconds
    }
    return replace(
        solution,
        iterations=tuple(step for one in attempts for step in one.iterations),
        load_steps=tuple(step for one in attempts for step in one.load_steps),
        cpu_seconds=seconds,
    )
