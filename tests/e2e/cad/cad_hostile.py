#!/usr/bin/env python3
"""Files that are no CAD files, or damaged ones: an error that names the file, or a part with its losses; never a crash.

Usage: cad_hostile.py HAPTICD MAKE_PARTS
"""
import os
import random
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG, check, finish, program, write

HAPTICD, MAKE_PARTS = sys.argv[1:3]
run = program(HAPTICD, timeout=800)
folder = tempfile.mkdtemp(prefix="hapticd-hostile-")
join = lambda name: os.path.join(folder, name)
part = join("out.hpart")
source = random.Random(3)


def put(name, content):
    return write(folder, name, content)


def refused(what, file, *arguments):
    code, out, err = run("import", file, "-o", part, *arguments)
    check(what, code == 2 and err.startswith("error: ") and file in err and not os.path.exists(part), f"exit {code}: {out}{err}")


def survived(what, file):
    """Read or refused, but told; what is written can be read."""
    if os.path.exists(part):
        os.remove(part)
    code, out, err = run("import", file, "-o", part, "--time", "20")
    good = code == 0 or (code == 2 and err.startswith("error: ") and file in err)
    if good and code == 0:
        good = run("part", "info", part)[0] == 0
    check(what, good, f"exit {code}: {out}{err}")
    if os.path.exists(part):
        os.remove(part)
    return code


subprocess.run([MAKE_PARTS, folder], check=True, timeout=300)
step, iges, brep = (open(join(name), "rb").read() for name in ("bracket.step", "box.iges", "loose.brep"))
refused("there is no such file", join("nowhere.step"))
for ending in ("step", "iges", "brep"):
    refused(f"an empty .{ending}", put(f"empty.{ending}", b""))
    refused(f"noise in a .{ending}", put(f"noise.{ending}", source.randbytes(20000)))
    refused(f"text in a .{ending}", put(f"text.{ending}", b"a part it is not\n" * 50))
refused("STEP without shapes", put("bare.step", re.sub(rb"(?s)DATA;.*ENDSEC;", b"DATA;\nENDSEC;", step)))
refused("an IGES file that is called .step", put("other.step", iges))


def told(what, words, file, *arguments):
    """Refused with these words."""
    code, out, err = run("import", file, "-o", part, *arguments)
    check(what, code == 2 and err.startswith("error: ") and file in err and words in err, f"exit {code}: {out}{err}")


def read_with(what, words, file):
    """Read, with these words in the report."""
    code, out, err = run("import", file, "-o", part)
    check(what, code == 0 and words in out, f"exit {code}: {out}{err}")
    if os.path.exists(part):
        os.remove(part)


for name, content, words in (("step.stl", step, "is a STEP file, by its first bytes, and its name ends in '.stl'"),
                             ("step.p21", step, "fix: rename it to"), ("iges.step", iges, "is an IGES file"),
                             ("brep.iges", brep, "is a BREP file of Open CASCADE"),
                             ("lfs.step", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "git lfs pull"),
                             ("page.stl", b"<!DOCTYPE html>\n<html></html>\n", "download the file itself"),
                             ("packed.step", b"\x1f\x8b\x08" + step[:100], "unpack it")):
    told(f"{name} is told what it holds", words, put(name, content))
told("a STEP file that ends too early is told so", "its last line END-ISO-10303-21; is missing", put("early.step", step[:len(step) // 2]))
told("a damaged STEP file is told so", "it is a damaged STEP file", put("broken.step", step.replace(b"DATA;", b"DATB;", 1)))
told("solids that no product holds are told with a face", "it belongs to no solid, shell or set of surfaces that could be read",
     put("unheld.step", re.sub(rb"(?s)#\d+ = (PRODUCT_DEFINITION_SHAPE|SHAPE_DEFINITION_REPRESENTATION|ADVANCED_BREP_SHAPE_REPRESENTATION)\(.*?\);\n", b"", step)))
told("triangles in STEP are told so", "its tessellated shapes: they are triangles",
     put("triangles.step", re.sub(rb"(?s)DATA;.*?ENDSEC;", b"""DATA;
#1 = COORDINATES_LIST('',3,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));
#2 = TRIANGULATED_FACE('',#1,3,((0.,0.,1.)),$,(1,2,3),((1,2,3)));
ENDSEC;""", step)))
if not os.environ.get("HAPTICD_SANITIZE"):  # a sanitizer needs an address space without a limit, so the importer sets none
    refused("too little memory", put("large.step", step), "--memory", "64")
    told("too little memory is told with the limit", "it needs more than the 64 MB", join("large.step"), "--memory", "64")
read_with("edges that end beside their vertex are told", "the outlines of 3 faces are off, that of face 0 most, by 2 mm: an edge does not end at its vertex",
          join("vertex_off.brep"))
told("a BREP file in binary form is told so", "in binary form", put("binary.brep", b"\nOpen CASCADE Topology V4, (c) Open Cascade\nLocations 0\n" + bytes(100)))
told("a BREP file with a face of triangles alone is told so", "faces of triangles without a surface (1 of 6)",
     put("bare.brep", re.sub(rb"(Fa\n0\s+\S+\s+)\d+", rb"\g<1>0", brep, count=1)))
read_with("FreeCAD's ending of BREP is read", "nothing was lost", put("freecad.brp", brep))
read_with("a mark of UTF-8 before STEP is passed over", "nothing was lost", put("mark.step", b"\xef\xbb\xbf" + step))
read_with("an unknown prefix of a unit is told", "check the size of the part", put("prefix.step", step.replace(b".MILLI.", b".MILLY.")))
read_with("a point without its coordinates is told", "the part may have another shape",
          put("flat.step", step.replace(b"CARTESIAN_POINT('',(", b"CARTESIAN_POINT('',", 1)))
read_with("a STEP file without a unit is told", "millimetres were assumed",
          put("unitless.step", re.sub(rb"(?s)GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\(.*?\)\)", b"", step)))
read_with("the number of an IGES unit decides, not its name", "unit mm", put("named.iges", iges.replace(b"2HMM", b"2HXX")))
code, out, err = run("import", join("cavity.brep"), "-o", part)
check("a solid with a cavity is read without a warning", code == 0 and "faces tried" not in out, out + err)
read_with("a solid whose faces bound no single volume is told", "of 12 faces tried", join("crossing_cavity.brep"))
others = [name for name in os.listdir(folder) if name.startswith("apart_")]
read_with("parts in files beside it are read", "nothing was lost", join("apart.step"))
code, out, err = run("import", os.path.join(os.path.basename(folder), "apart.step"), "-o", part, cwd=os.path.dirname(folder))
check("so they are if the path begins at the working folder", code == 0 and "nothing was lost" in out, out + err)
os.remove(part)
for name in others:
    os.remove(join(name))
told("a part in a file that is not there is told with that file", others[0], join("apart.step"))

refused("an IGES file that ends too early", put("short.iges", iges[:int(0.9 * len(iges))]))
read_with("a BREP file whose last line, the main shape, is missing", "the file names no main shape",
          put("rootless.brep", brep.rstrip().rsplit(b"\n", 1)[0] + b"\n"))
for share in (0.3, 0.6, 0.9, 0.97):  # these waited for words that never came
    refused(f"a BREP file that ends after {share:.0%}", put("short.brep", brep[:int(share * len(brep))]), "--time", "20")
face = re.search(rb"(?s)(#\d+) = ADVANCED_FACE.*?;", step)
code, out, err = run("import", put("faceless.step", step.replace(face[0], b"")), "-o", part)
check("a face that a STEP file refers to and does not have is lost", code == 0 and "nothing was lost" not in out and f"lost: entity {face[1].decode()}:" in out, out + err)

os.remove(part)  # of the faceless file
numbers = [m for m in re.finditer(rb"-?\d+\.\d+|(?<=\s)-?\d+(?=\s)", brep)]
for word in (b"nan", b"-nan", b"inf", b"-INF", b"Infinity", b"1.#QNAN", b"nan(ind)")[::1 if LONG else 3]:  # Open CASCADE would not come back
    at = numbers[len(numbers) // 2]
    file = put("words.brep", brep[:at.start()] + word + brep[at.end():])
    refused(f"{word.decode()} in a BREP file", file, "--time", "60")
    line = brep[:at.start()].count(b"\n") + 1
    check(f"{word.decode()} is told with its line", f"line {line}: '{word.decode()}'" in run("import", file, "-o", part)[2])
for name, whole in (("step", step), ("iges", iges), ("brep", brep)):
    for share in (0.3, 0.6, 0.9):
        survived(f"a .{name} that ends after {share:.0%}", put(f"cut.{name}", whole[:int(share * len(whole))]))
    for trial in range(4 if LONG else 1):  # digits become others: references, counts and coordinates are wrong
        damaged = bytearray(whole)
        digits = [i for i, b in enumerate(damaged) if 48 <= b <= 57]
        for i in source.sample(digits, 12):
            damaged[i] = 48 + source.randrange(10)
        survived(f"a .{name} with wrong digits, {trial}", put(f"wrong.{name}", bytes(damaged)))
survived("huge coordinates", put("huge.step", re.sub(rb"CARTESIAN_POINT\('',\(", b"CARTESIAN_POINT('',(9.E300,", step, count=3)))
survived("no numbers", put("nan.step", step.replace(b"(0.,0.,", b"(NAN,0.,", 3)))
survived("a face of itself", put("loop.step", re.sub(rb"(#\d+) = OPEN_SHELL|(#\d+) = CLOSED_SHELL\('',\((#\d+)", rb"\2 = CLOSED_SHELL('',(\2", step)))
survived("a huge count", put("count.brep", re.sub(rb"Surfaces \d+", b"Surfaces 2000000000", brep)))
finish()
