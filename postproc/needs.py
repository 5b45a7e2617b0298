"""Imported before numpy: one sentence where the Python that runs a script lacks what the scripts need."""

import importlib.util
import sys

missing = [name for name in ("numpy", "scipy", "matplotlib", "h5py", "yaml") if importlib.util.find_spec(name) is None]
if missing:
    sys.exit(f"{sys.executable} has no {', '.join(missing)}: start the script itself, or with Debian's /usr/bin/python3 (app/packages.txt)")
