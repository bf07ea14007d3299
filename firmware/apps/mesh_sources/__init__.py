"""Where the project's own meshes come from: a module computes each of them, `headers` writes them as C.

The converter is the host package's; it need not be installed for this.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "host"))
