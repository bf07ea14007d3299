"""What the converter's tests share: the command as a function, an OBJ's triangles in one step."""

from __future__ import annotations

import argparse
import importlib
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest

from edgeline.convert import command, preview
from edgeline.convert.mesh import Soup
from edgeline.convert.model import source_from
from edgeline.convert.obj import Material, ObjModel
from edgeline.convert.source import Picture, soup_of, with_normals
from edgeline.convert.texels import Texture
from edgeline.errors import EdgelineError
from needs import missing


def _run(*words: object) -> int:
    parser = argparse.ArgumentParser()
    subparsers = parser.add_subparsers(required=True)
    command.add_parser(subparsers)
    preview.add_parser(subparsers)
    args = parser.parse_args([*map(str, words)])
    return int(args.func(args))


def convert(*words: object) -> int:
    return _run("convert", *words)


def run_preview(*words: object) -> int:
    return _run("preview", *words)


def library(name: str) -> ModuleType:
    """A library of host/requirements-dev.txt that the package itself does without."""
    try:
        return importlib.import_module(name)
    except ImportError:
        missing(f"the package {name}")
        raise


def refused(*words: object) -> str:
    """The message of a command that has to fail."""
    with pytest.raises(EdgelineError) as caught:
        _run(*words)
    assert caught.value.exit_code == 2
    assert "\n" not in str(caught.value)
    return str(caught.value)


def soup_from(
    model: ObjModel,
    materials: dict[str, Material],
    texture: Texture | None,
    *,
    crease_degrees: float = 60.0,
    normals: bool = True,
) -> Soup:
    """An OBJ's triangles as they are quantised."""
    source = source_from(model, materials, lambda name: Picture(name, Path(name))).in_one(None)
    return soup_of(with_normals(source, crease_degrees) if normals else replace(source, normals=None), texture)
