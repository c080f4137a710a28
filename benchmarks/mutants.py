"""Would the tests notice? Thirty-two faults, each put by hand into a copy of the package.

``python benchmarks/mutants.py`` flips a sign, drops a factor or skips a term of
the energies and of the audit, runs the tests that ought to mind, and prints what caught it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
TERMS = ("terms", "solver/test_derivatives.py", "solver/test_solve.py",
         "verification/test_sheet_on_particle.py",
         "verification/test_droplet_on_plane.py", "robustness/test_audit.py",
         "verification/test_pinned_cap.py", "verification/test_square_sheet.py",
         "verification/test_bridge_between_particles.py",
         "verification/test_whole_membrane.py")  # fmt: skip
SPOTS = ("solids/test_wet_spot.py", "solver/test_point_supports.py")
AUDIT = ("robustness/test_audit.py", "robustness/test_evidence.py",
         "robustness/test_never_wrong_silently.py",
         "verification/test_sheet_on_particle.py")  # fmt: skip

MUTANTS = [
    ("terms/variations.py", "+ 0.5 * ez * x[..., 2]", "+ ez * x[..., 2]"),
    ("terms/variations.py", "conjugate = (tension * w", "conjugate = (-tension * w"),
    ("terms/variations.py", "cross(conjugate, at.a1, rows", "cross(at.a1, conjugate, rows"),
    ("terms/variations.py", "scale = 0.5 * tension", "scale = tension"),
    ("terms/variations.py", "right.append(lift)", "right.append(0.0 * lift)"),
    ("terms/variations.py", "+ 0.5 * ez * dz", "+ ez * dz"),
    ("terms/contact_line.py", "float(-self.gamma * (np.cos", "float(self.gamma * (np.cos"),
    ("terms/contact_line.py", "w = 0.5 * strength", "w = strength"),
    ("terms/contact_line.py", "hessian[:, :, 1, :, 0] = -skew", "hessian[:, :, 1, :, 0] = skew"),
    ("terms/gravity.py", "(-self.density_of_liquid * g", "(self.density_of_liquid * g"),
    ("terms/volume.py", "BodyDensity(-self.pressure)", "BodyDensity(self.pressure)"),
    ("terms/volume.py", "self.value - self.ends", "self.value + self.ends"),
    ("terms/sphere_wetting.py", "-2.0 * v**2 * x", "-v**2 * x"),
    ("terms/sphere_wetting.py", "z * there / 4.0", "z * there / 3.0"),
    ("terms/sphere_wetting.py", "slope = 2.0 * x + along", "slope = x + along"),
    ("terms/sphere_wetting.py", "return -1.0 if EDGES", "return 1.0 if EDGES"),
    ("terms/sphere_wetting.py", "(cosine + self.covered)", "(cosine - self.covered)"),
    ("solids/wet_spot.py", "t * np.sin(2.0 * psi)", "t * np.sin(psi)"),
    ("solids/wet_spot.py", "line -= self._factor", "line += self._factor"),
    ("solids/wet_spot.py", "line + 0.5 * self._pressure", "line - 0.5 * self._pressure"),
    ("solids/wet_spot.py", "before & (depth > lowest)", "before & (depth < lowest)"),
    ("terms/edge_gap.py", "n, n, bend, load", "n, n, bend, -load"),
    ("verification/audit.py", "float(np.linalg.norm(total[:-1])) / size", "0.0 / size"),
    ("verification/audit.py", "abs(loads.push + sum(others))", "abs(loads.push - sum(others))"),
    ("verification/audit.py", "pull = -contact.table", "pull = contact.table"),
    (
        "verification/audit.py",
        "return max(0.0, -lowest) / contact.length",
        "return 0.0 * contact.length",
    ),
    ("verification/audit.py", "abs(inside - held.target) / held.value", "0.0 * held.value"),
    ("verification/audit.py", "cosine_error(line, -term.strength / tension)",
     "cosine_error(line, term.strength / tension)"),
    ("verification/audit.py", "forces.push - forces.line - weight", "forces.push - forces.line"),
    ("verification/balance.py", "return abs(sum(forces))", "return 0.0 * abs(sum(forces))"),
    ("verification/trimmed_audit.py", "abs(loads.push + pulls[1])", "0.0 * abs(loads.push)"),
    ("verification/evidence.py", "not abs(self.value) <= self.limit", "False"),
]  # fmt: skip


def main() -> int:
    for file in ("terms/gravity.py", "solids/wet_spot.py", "verification/audit.py"):
        assert not _caught_by(file, "", ""), "the tests fail without a fault"
    survived = 0
    for number, (file, old, new) in enumerate(MUTANTS, 1):
        caught = _caught_by(file, old, new)
        survived += not caught
        print(f"| {number} | {file} | `{old.strip()}` | `{new.strip()}` | {caught or 'SURVIVED'} |",
              flush=True)  # fmt: skip
    print(f"\n{len(MUTANTS) - survived} of {len(MUTANTS)} caught")
    return survived


def _caught_by(file: str, old: str, new: str) -> str:
    """The first test that fails with a mutant, or nothing."""
    with tempfile.TemporaryDirectory() as folder:
        for part in ("iga_membrane", "tests", "examples"):
            shutil.copytree(ROOT / part, Path(folder) / part,
                            ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
        shutil.copy(ROOT / "pyproject.toml", folder)
        path = Path(folder) / "iga_membrane" / file
        text = path.read_text()
        assert old in text, f"{file} has no {old!r}"
        path.write_text(text.replace(old, new, 1))
        tests = {"terms": TERMS, "solids": SPOTS, "solver": AUDIT}[file.split("/")[0]]
        run = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
             *(f"tests/{name}" for name in tests)],
            cwd=folder, capture_output=True, text=True, check=False,
            env=os.environ | {"PYTHONPATH": folder},
        )  # fmt: skip
        lines = [x for x in run.stdout.splitlines() if x.startswith(("FAILED", "ERROR"))]
        return lines[0].split(" ")[1].removeprefix("tests/") if lines else ""


if __name__ == "__main__":
    sys.exit(main())
