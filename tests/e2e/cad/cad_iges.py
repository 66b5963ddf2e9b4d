#!/usr/bin/env python3
"""IGES files with what Open CASCADE leaves out without a word: the report names it.

Usage: cad_iges.py HAPTICD     prints one line per check; exit 1 when one fails.
The files are written here, entity by entity: a sheet of 40 x 40 mm, and subfigures that copy it.
"""
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

run = program(sys.argv[1], timeout=100)
folder = tempfile.mkdtemp(prefix="hapticd-iges-")

NURBS, DEFINITION, SUBFIGURE, CIRCULAR_ARRAY = 128, 308, 408, 414
CORNERS = (-20, -20, 0, 20, -20, 0, -20, 20, 0, 20, 20, 5)
SHEET = (NURBS, 1, 1, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 1, 1, *CORNERS, 0, 1, 0, 1)
SHEET_TO_COPY = (DEFINITION, 0, "5Hsheet", 1, 1)  # its entity is that of directory line 1
DEFINED = 2  # the status of an entity that stands only in a definition


def text_of(value):
    return value if isinstance(value, str) else str(float(value)) if isinstance(value, float) else str(value)


def lines_of(entity):
    """The parameter lines of an entity, of at most 64 columns."""
    lines, texts = [""], [text_of(value) for value in entity]
    for i, text in enumerate(texts):
        text += ";" if i + 1 == len(texts) else ","
        if len(lines[-1]) + len(text) > 64:
            lines.append("")
        lines[-1] += text
    return lines


def iges(name, entities, unit=2, unit_name="2HMM", scale=1.0):
    """Writes a file of (entity, status) and returns its path. A third number is the directory line of its transformation."""
    header = f"1H,,1H;,1Hp,5Hp.igs,1Hx,1Hx,32,38,6,308,15,1Hp,{scale},{unit},{unit_name},1,0.01,15H20260101.000000,1E-6,1000.,1Ha,1Hb,11,0;"
    sections = {"S": ["sheets"], "G": [header[i:i + 72] for i in range(0, len(header), 72)], "D": [], "P": []}
    for number, (entity, status, *move) in enumerate(entities):
        at, lines = 2 * number + 1, lines_of(entity)
        sections["D"] += [f"{entity[0]:8d}{len(sections['P']) + 1:8d}" + f"{0:8d}" * 4 + f"{sum(move):8d}{0:8d}00{status:02d}0000",
                          f"{entity[0]:8d}{0:8d}{0:8d}{len(lines):8d}{0:8d}" + " " * 24 + f"{0:8d}"]
        sections["P"] += [f"{line:64s}{at:8d}" for line in lines]
    path = os.path.join(folder, name)
    with open(path, "w") as out:
        for letter, lines in sections.items():
            out.writelines(f"{line:72s}{letter}{i + 1:7d}\n" for i, line in enumerate(lines))
        counts = "".join(f"{letter}{len(lines):7d}" for letter, lines in sections.items())
        out.write(f"{counts:72s}T{1:7d}\n")
    return path


def told(*arguments, **header):
    return run("import", iges(*arguments, **header), "--check")


copied = [(SHEET, DEFINED), (SHEET_TO_COPY, DEFINED)]
here, there = ((SUBFIGURE, 3, x, 0.0, 0.0, 1.0) for x in (0.0, 100.0))
code, out, err = told("copies.igs", copied + [(here, 0), (there, 0)])
check("two copies of a sheet are read", code == 0 and "2 faces" in out and "nothing was lost" in out, out + err)
larger = (SUBFIGURE, 3, 100.0, 0.0, 0.0, 2.0)
code, out, err = told("larger.igs", copied + [(here, 0), (larger, 0)])
check("one of another size is lost", code == 0 and "lost: subfigure D7: its scale is 2" in out and "nothing was lost" not in out, out + err)
code, out, err = told("only_larger.igs", copied + [(larger, 0)])
check("and is the reason if nothing else is there", code == 2 and "its scale is 2" in err, out + err)
array = (CIRCULAR_ARRAY, 3, 4, 0.0, 0.0, 0.0, 100.0, 0.0, 1.5707963, 0, 0)
code, out, err = told("array.igs", copied + [(here, 0), (array, 0)])
check("an array of copies is lost", code == 0 and "lost: array of subfigures D7: only single subfigures" in out, out + err)
cube = (150, 10.0, 10.0, 10.0)
code, out, err = told("cube.igs", [(SHEET, 0), (cube, 0)])
check("a solid of primitives is lost", code == 0 and "lost: solid D3: it is made of primitives" in out, out + err)

right = (124, 1.0, 0.0, 0.0, 100.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
code, out, err = told("moved.igs", [(right, 0), (SHEET, 0, 1)])
check("an open sheet is told where the file moves it", code == 0 and "around (100, 0, 2.5) mm" in out, out + err)

code, out, err = told("inch.igs", [(SHEET, 0)], unit=3, unit_name="4HINCH")
check("a unit by its name", code == 0 and "1.016 x 1.016 x 0.127 m, unit in\n" in out, out + err)
code, out, err = told("unit.igs", [(SHEET, 0)], unit=3, unit_name="4HFURL")
check("a unit that is not known is assumed", code == 0 and "unit mm (assumed)" in out and "millimetres were assumed" in out, out + err)
code, out, err = told("number.igs", [(SHEET, 0)], unit=12)
check("a unit that does not exist is refused", code == 2 and "its unit has the number 12; expected 1 to 11" in err, out + err)
code, out, err = told("scale.igs", [(SHEET, 0)], scale=0.5)
check("a scale of the model is told", code == 0 and "a scale of 0.5" in out and "--scale 2" in out, out + err)
code, out, err = told("plain.igs", [(SHEET, 0)])
check("a plain file is read without a word", code == 0 and "scale" not in out and "assumed" not in out and "nothing was lost" in out, out + err)
finish()
