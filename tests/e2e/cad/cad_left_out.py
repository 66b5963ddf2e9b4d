#!/usr/bin/env python3
"""STEP files with what Open CASCADE leaves out without a word: mirrored and scaled copies, and solids that are no boundary.

Usage: cad_left_out.py HAPTICD MAKE_PARTS     prints one line per check; exit 1 when one fails.
"""
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, write

run = program(sys.argv[1], timeout=100)
folder = tempfile.mkdtemp(prefix="hapticd-left-out-")
subprocess.run([sys.argv[2], folder], check=True, timeout=300)
bracket = open(os.path.join(folder, "bracket.step")).read()
shape = re.search(r"#(\d+) = ADVANCED_BREP_SHAPE_REPRESENTATION\('',\((#\d+),#\d+\),\s*(#\d+)\)", bracket)
whole, axes, context = f"#{shape[1]}", shape[2], shape[3]
definition = re.search(r"SHAPE_DEFINITION_REPRESENTATION\(#\d+,(#\d+)\)", bracket)


def reported(name, text, entities):
    """The report of the text with more entities."""
    end = text.rindex("ENDSEC")
    code, out, err = run("import", write(folder, name, text[:end] + entities + text[end:]), "--check")
    check(f"{name} is read", code == 0 and "8 faces" in out, out + err)
    return out


def copied(name, x, y, z, scale):
    """The bracket as a copy of itself, with these axes."""
    used = definition[0].replace(definition[1], "#9007")
    return reported(name, bracket.replace(definition[0], used), f"""#9001=CARTESIAN_POINT('',(100.,0.,0.));
#9002=DIRECTION('',({x}));
#9003=DIRECTION('',({y}));
#9004=DIRECTION('',({z}));
#9005=REPRESENTATION_MAP({axes},{whole});
#9006=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#9002,#9003,#9001,{scale},#9004);
#9008=MAPPED_ITEM('',#9005,#9006);
#9007=SHAPE_REPRESENTATION('',({axes},#9008),{context});
""")


out = copied("turned.step", "0.,1.,0.", "-1.,0.,0.", "0.,0.,1.", "1.")
check("a turned copy is no loss", "nothing was lost" in out, out)
for name, axes_of_copy in (("mirrored_x.step", ("-1.,0.,0.", "0.,1.,0.", "0.,0.,1.")), ("mirrored_z.step", ("1.,0.,0.", "0.,1.,0.", "0.,0.,-1."))):
    out = copied(name, *axes_of_copy, "1.")
    check(f"{name}: the copy is told", "lost: copy #9006: it was to be mirrored" in out and "nothing was lost" not in out, out)
out = copied("scaled.step", "1.,0.,0.", "0.,1.,0.", "0.,0.,1.", "2.")
check("a scaled copy is told", "lost: copy #9006: it was to be scaled" in out, out)

held = shape[0].replace(f"({axes},", f"({axes},#9003,")
out = reported("block.step", bracket.replace(shape[0], held), f"#9003=BLOCK('lid',{axes},10.,20.,30.);\n")
check("a primitive is told", "lost: solid #9003 'lid': it is made of primitives" in out, out)
finish()
