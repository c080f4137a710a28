"""Scenes and checks that several tests share."""

from __future__ import annotations

import gc
import importlib.util
import json
import sys
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import thread_time

import numpy as np
import pytest

import iga_membrane as iga
from iga_membrane.assembly.lagrangian import Assembly

EXAMPLES = Path(__file__).parents[1] / "examples"
UNIT_VOLUME = 4.0 * np.pi / 3.0
EPS = np.finfo(float).eps
MEASURES = ("height", "contact_radius", "p_base", "energy", "A_LG", "A_wet")


def example(name):
    """An example as a module."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # where dataclasses look for their annotations
    spec.loader.exec_module(module)
    return module


@contextmanager
def within(seconds):
    """At most these CPU seconds of the thread. To collect what other tests have left can take
    longer than what is timed: it waits."""
    collecting = gc.isenabled()
    gc.disable()
    began = thread_time()
    try:
        yield
    finally:
        spent = thread_time() - began
        if collecting:
            gc.enable()
        assert spent <= seconds


def some(members, quick):
    """Members of a family as parameters: those with the numbers ``quick`` are among the default
    tests, the others run with ``-m slow``."""
    members = list(members)
    assert set(quick) <= set(range(len(members)))
    several = [one if isinstance(one, tuple) else (one,) for one in members]
    return [
        pytest.param(*one, marks=[] if k in quick else [pytest.mark.slow])
        for k, one in enumerate(several)
    ]


def droplet(contact_angle, bond=0.0, *, quadrature=None, hold="none", **mesh):
    """Drop of unit radius on a plane."""
    return iga.sessile_droplet(
        iga.Plane(contact_angle=contact_angle),
        volume=UNIT_VOLUME,
        gravity=bond,
        hold=hold,
        discretization=iga.Discretization(**mesh),
    )


def solved(contact_angle, bond=0.0, options=None, **mesh):
    return iga.solve(droplet(contact_angle, bond, **mesh), options)


def droplet_file(contact_angle, bond=0.0, more="", **mesh):
    """Text of a scene file (TOML) with the drop of :func:`droplet`; ``more`` stands at its end."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in mesh.items()]
    return "\n".join([
        'scene = "sessile_droplet"',
        "[liquid]",
        f"volume = {UNIT_VOLUME!r}",
        "[gravity]",
        f"acceleration = {bond!r}",
        "[substrate]",
        f"contact_angle = {contact_angle!r}",
        "[discretization]",
        *lines,
        more,
    ])  # fmt: skip


def rounded_by(seed):
    """``Assembly.system`` as on another processor: forces off by one rounding of their parts, the
    Hessian by one of its entries, the same ones whenever a state is assembled again."""
    exact = Assembly.system

    def rounded(self, surface, directions, multipliers):
        system = exact(self, surface, directions, multipliers)
        sign = np.random.default_rng(seed).choice([-EPS, EPS], len(system.matrix.data))
        system.matrix.data *= 1.0 + sign
        sign = sign[: len(system.gradient)]
        part = np.abs(system.gradient) + system.scale / np.sqrt(len(system.gradient))
        return replace(system, gradient=system.gradient + sign * part)

    return rounded


def path_file(parameter, values):
    """Text of the table of a scene file that walks a path."""
    return f'[[path]]\nparameter = "{parameter}"\nvalues = {values}\n'


def worst(measures, exact, names=MEASURES):
    """Largest relative error among measures."""
    return max(abs(measures[name] / exact[name] - 1.0) for name in names)


def slopes(errors):
    """Rates between successive halvings."""
    errors = np.abs(np.asarray(errors, float))
    return np.log2(errors[:-1] / errors[1:])


def pinned_cap(opening, terms, model="full", *, rim=1.0, kind="bspline", degree=3, elements=8):
    """Spherical cap pinned on a circle; ``opening`` is its half angle in radians."""
    from iga_membrane.surface.ring import axisymmetric, drop_space

    radius = rim / np.sin(opening)

    def profile(t):
        u = opening * (1.0 - t)
        return (
            radius * np.sin(u),
            radius * (np.cos(u) - np.cos(opening)),
            -radius * opening * np.cos(u),
        )

    surface = axisymmetric(drop_space(kind, degree, elements, angle=opening), profile)
    return iga.Scene(surface, terms, [iga.Fixed("xi2=0"), iga.Sector(model)])


def particle_sheet(
    angle, *, center=(0.0, 0.0, -1.0), boundary="circle", size=5.0, density=1.0, **options
):
    """Sheet on a particle of radius 1 whose top just reaches it."""
    named = ("space", "degree", "elements", "model")
    mesh = {name: options.pop(name) for name in named if name in options}
    particle = iga.Sphere(contact_angle=angle, radius=1.0, center=center, density=density)
    return iga.liquid_sheet(
        particle,
        size=size,
        boundary=boundary,
        discretization=iga.Discretization(**mesh),
        **options,
    )
