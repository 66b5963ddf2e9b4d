#!/usr/bin/env python3
"""`hapticd import` of a CAD file where hapticd-import was not built: the message says what is missing.

Usage: cad_missing.py HAPTICD
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

file = os.path.join(tempfile.mkdtemp(prefix="hapticd-missing-"), "part.step")
open(file, "w").close()
code, out, err = program(sys.argv[1])("import", file, "-o", "part.hpart")
check("the package is named", code == 2 and "install the package hapticd-import" in err, err)
check("so is the way without it", "hapticd import PART.stl -o PART.hpart" in err, err)
finish()
