"""`python -m edgeline` is the command `edgeline`."""

import sys

from edgeline.cli import main

sys.exit(main())
