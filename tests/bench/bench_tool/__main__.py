"""`python -m bench_tool`, which tests/bench/run calls."""

import sys

from .command import main

sys.exit(main())
