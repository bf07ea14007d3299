#!/usr/bin/env python3
"""Makes the mesh headers of the demo and of the benchmark.

    firmware/apps/make_meshes.py                      demo/meshes, from nothing but the modules in mesh_sources
    firmware/apps/make_meshes.py --bench scenes.npz   bench/meshes, from the benchmark's scenes
    ... --bench scenes.npz --clusters -o FOLDER       the same in the order of clusters, for comparison
    ... -o FOLDER                                     into another folder, for comparison

The headers are committed; a test makes them again and compares byte for byte.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path

from header_files import write_headers
from mesh_sources.headers import bench_headers, demo_headers

APPS = Path(__file__).resolve().parent


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the mesh headers of the demo, or of the benchmark.")
    parser.add_argument("--bench", type=Path, metavar="FILE.npz", help="the benchmark's scenes; makes its headers")
    parser.add_argument("--clusters", action="store_true", help="with --bench: meshes with clusters")
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="default: the meshes folder in the tree")
    args = parser.parse_args()
    if args.clusters and not (args.bench and args.output):
        parser.error(
            "--clusters goes with --bench and -o: the meshes in the tree are as the benchmark's scenes have them"
        )
    folder = args.output or APPS / ("bench" if args.bench else "demo") / "meshes"
    make = partial(bench_headers, args.bench, args.clusters) if args.bench else demo_headers
    return write_headers("make_meshes", folder, make)


if __name__ == "__main__":
    sys.exit(main())
