"""`python -m sweep_and_prune` is the command line `sap`."""

import sys

from ._command import program

if __name__ == "__main__":
    sys.exit(program())
