"""Every public name says what its arguments are and which errors of ours it raises."""

import ast
import dataclasses
import inspect
import re
import textwrap

import pytest

import iga_membrane as iga
from iga_membrane import errors

NAMES = [name for name in iga.__all__ if not name.startswith("__")]
ENTRY = re.compile(r"(?:^|; )([A-Za-z_]\w*(?:, [A-Za-z_]\w*)*) : ", re.M)
REFERRED = re.compile(r"[Pp]arameters (?:are those|as) (?:of|in) :\w+:`(\w+)`")
OURS = {name for name in vars(errors) if name.endswith("Error")}


def described(text):
    """Names under Parameters and Attributes, and those of a function that is referred to."""
    found = set()
    for title in ("Parameters", "Attributes"):
        section = re.search(rf"^{title}\n-+\n(.*?)(?=^\w+\n-+$|\Z)", text, re.M | re.S)
        for names in ENTRY.findall(section[1]) if section else ():
            found |= set(names.split(", "))
    for other in REFERRED.findall(text):
        found |= described(inspect.getdoc(getattr(iga, other)))
    return found


def arguments(thing):
    """What a caller gives: fields of a record, parameters of a function or a constructor."""
    if dataclasses.is_dataclass(thing):
        return {field.name for field in dataclasses.fields(thing) if field.init}
    if getattr(thing, "_is_protocol", False):
        return set()  # nobody calls it
    if inspect.isclass(thing):
        own = thing.__dict__.get("__init__")
        return set() if own is None or issubclass(thing, Exception) else arguments(own) - {"self"}
    return set(inspect.signature(thing).parameters)


def raised(function):
    """Names of our errors that a function raises itself."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    calls = (n.exc for n in ast.walk(tree) if isinstance(n, ast.Raise) and n.exc is not None)
    names = (c.func if isinstance(c, ast.Call) else c for c in calls)
    return {n.id for n in names if isinstance(n, ast.Name)} & OURS


def members(thing):
    """Methods and properties that a class defines for others."""
    for name, member in vars(thing).items():
        inner = getattr(member, "fget", None) or getattr(member, "func", member)
        inner = getattr(inner, "__func__", inner)
        if not name.startswith("_") and inspect.isfunction(inner):
            yield name, inner


@pytest.mark.parametrize("name", NAMES)
def test_arguments_are_described(name):
    thing = getattr(iga, name)
    text = inspect.getdoc(thing)
    assert text
    assert arguments(thing) <= described(text), arguments(thing) - described(text)


@pytest.mark.parametrize("name", [n for n in NAMES if inspect.isclass(getattr(iga, n))])
def test_members_are_described(name):
    for member, function in members(getattr(iga, name)):
        assert inspect.getdoc(getattr(getattr(iga, name), member)), member
        documented = inspect.getdoc(getattr(getattr(iga, name), member))
        assert all(error in documented for error in raised(function)), member


@pytest.mark.parametrize("name", [n for n in NAMES if inspect.isfunction(getattr(iga, n))])
def test_errors_are_described(name):
    thing = getattr(iga, name)
    assert all(error in inspect.getdoc(thing) for error in raised(thing)), raised(thing)


def test_shapes_of_arrays_are_said():
    """An array among the arguments has its shape in round brackets."""
    for name in NAMES:
        thing = getattr(iga, name)
        if not dataclasses.is_dataclass(thing):
            continue
        text = inspect.getdoc(thing)
        for field in dataclasses.fields(thing):
            if field.init and re.fullmatch(r"(Array|Index|Mask)( \| None)?", str(field.type)):
                entry = re.search(rf"^(?:\w+, )*{field.name}(?:, \w+)* : .*", text, re.M)
                assert entry, (name, field.name)
                assert "(" in entry[0], (name, field.name)
