"""The house keeps its floors: who may import whom, and what a bare import loads."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import iga_membrane

ROOT = Path(iga_membrane.__file__).parent
FLOORS = {
    "arrays": 0, "errors": 0, "checks": 0, "deadline": 0, "_kernels": 0,
    "arguments": 0, "fields": 0, "files": 0, "records": 0, "progress": 0, "tables": 0, "units": 0,
    "threads": 0, "own": 0, "optional": 0, "output_folder": 0,
    "status": 0, "lazy": 0, "overview": 0, "quantities": 0, "quadrature": 0,
    "splines": 1, "solids": 1, "linalg": 1,
    "surface": 2,
    "dofs": 3,
    "terms": 4,
    "initial": 5,
    "problems": 6,
    "io": 7, "contact": 7,
    "assembly": 8,
    "results": 9,
    "verification": 10,
    "solvers": 11,
    "driver": 12,
    "photograph": 12.2,
    "reference": 12.5,  # pictures may show the witness, no solve may lean on it
    "view": 13, "analysis": 13,
    "command_line": 0,
    "cli": 14, "__main__": 15,
}  # fmt: skip
DOORS = {("driver/solution.py", "view")}
FILES = sorted(ROOT.rglob("*.py"))


def room(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imports(path):
    """(package name or None for outside, top-level module) of every import in a file."""
    tree = ast.parse(path.read_text())
    depth = len(path.relative_to(ROOT).parts) - 1
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((None, alias.name.split(".")[0]) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield None, (node.module or "").split(".")[0]
        elif isinstance(node, ast.ImportFrom):
            inside = depth - (node.level - 1)
            parts = list(path.relative_to(ROOT).parts[:inside])
            parts += (node.module or node.names[0].name).split(".")
            yield parts[0], None


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_run_downward(path):
    name = str(path.relative_to(ROOT))
    here = room(path)
    if here in ("__init__", "reference"):
        return
    for inside, _ in imports(path):
        if inside is None or inside == "__version__":
            continue
        assert FLOORS[inside] <= FLOORS[here], f"{name} imports {inside} from a floor above"
        same_floor = FLOORS[inside] == FLOORS[here] and inside != here
        assert not same_floor or FLOORS[here] == 0, f"{name} imports its neighbour {inside}"


@pytest.mark.parametrize(
    ("library", "allowed"),
    [
        ("numba", ("_kernels.py",)),
        ("geomdl", ("surface/exchange.py",)),
        ("pyvista", ("view/",)),
        ("cloudpickle", ("analysis/portable.py",)),
    ],
)
def test_optional_library_is_named_in_one_place(library, allowed):
    for path in FILES:
        name = str(path.relative_to(ROOT))
        used = any(outside == library for _, outside in imports(path))
        assert not used or name.startswith(allowed), f"{name} imports {library}"


def test_reference_imports_nothing_of_ours():
    for path in (ROOT / "reference").glob("*.py"):
        assert all(inside in (None, "reference") for inside, _ in imports(path)), path


def test_bare_import_loads_no_heavy_library():
    code = (
        "import sys, iga_membrane; heavy = {'vtk', 'vtkmodules', 'pyvista', 'matplotlib', 'numba', "
        "'geomdl', 'scipy.optimize', 'scipy.interpolate'} & set(sys.modules); print(sorted(heavy))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_a_plain_droplet_is_solved_without_a_heavy_library():
    """Each takes longer to load than the droplet to solve, in every worker of a sweep again."""
    code = (
        "import sys, iga_membrane as iga; mesh = iga.Discretization(elements=8);"
        "plane = iga.Plane(contact_angle=120);"
        "drop = iga.sessile_droplet(plane, volume=1.0, gravity=9.0, discretization=mesh);"
        "assert iga.solve(drop).success; heavy = {'vtk', 'vtkmodules', 'pyvista', 'matplotlib', "
        "'numba', 'geomdl', 'scipy.optimize', 'scipy.interpolate'} & set(sys.modules);"
        "print(sorted(heavy))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_every_public_name_loads():
    for name in iga_membrane.__all__:
        assert getattr(iga_membrane, name) is not None


def test_solve_stays_the_function_after_submodules_are_loaded():
    code = "import iga_membrane as iga; iga.Status; iga.Solution; assert callable(iga.solve)"
    subprocess.run([sys.executable, "-c", code], check=True)
