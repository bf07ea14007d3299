"""The meshes' C headers as text, by name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from edgeline.convert.clusters import with_clusters
from edgeline.convert.header import c_header
from mesh_sources import bench, demo


def demo_headers() -> dict[str, str]:
    """The headers of the demo."""
    made_by = "Made by firmware/apps/make_meshes.py; do not edit."
    return {name: c_header(name, [demo.ABOUT[name], made_by], [mesh]) for name, mesh in demo.all_meshes().items()}


def bench_headers(scenes: Path, clusters: bool = False) -> dict[str, str]:
    """The headers of the benchmark; in the order of clusters if they shall have some. Raises EdgelineError when
    `scenes` cannot be read."""
    made_by = f"Made by firmware/apps/make_meshes.py --bench{' --clusters' if clusters else ''}; do not edit."
    meshes_of = bench.all_scenes(bench.load(scenes))
    if clusters:
        meshes_of = {
            name: [replace(named, mesh=with_clusters(named.mesh)) for named in meshes]
            for name, meshes in meshes_of.items()
        }
    return {name: c_header(name, [bench.ABOUT[name], made_by], meshes) for name, meshes in meshes_of.items()}
