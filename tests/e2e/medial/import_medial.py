#!/usr/bin/env python3
"""A soft body has the size, place, material and number of spheres that its user asks for; what is wrong with a surface is repaired or
refused, and a full disk spoils nothing.

Usage: import_medial.py HAPTICD     prints one line per case; exit 1 when one is off.
"""
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from bodies import box, capsule, ellipsoid, obj, read, torus
from e2e import LONG, check, finish, program, write

HAPTICD = sys.argv[1]
hapticd = program(HAPTICD, together=True)
FEWER = [] if LONG else ["--samples", "6000"]  # 20,000 unless given, which take three times as long


def save(name, text):
    return write(*os.path.split(name), text)


def tissue(folder):
    """The stiffness of a layer of tissue under a flat tip, by the formula of deformable.md: kappa is 1 on a thick layer."""
    young, poisson, tip = 10e3, .45, .003
    mesh = save(os.path.join(folder, "capsule.obj"), capsule(.06, .01))
    code, text = hapticd("import", "--medial", mesh, os.path.join(folder, "tissue.yaml"), "--young", f"{young}",
                         "--poisson", f"{poisson}", "--thickness", "1", *FEWER)
    check("tissue is imported", code == 0, text)
    scene = save(os.path.join(folder, "scene.yaml"), "hapticd: 1\nmodels:\n  - {name: body, plugin: mat_deformable, "
                 f"parameters: {{geometry: tissue.yaml, probe_radius: {tip}}}}}\n")
    code, text = hapticd("explain", scene)
    said = re.search(r"felt ([\d.]+) N/m 1 mm deep.*young for a flat tip of radius 3 mm", text)
    expected = 2 * young * tip / (1 - poisson**2)
    check("it is felt as stiff as the formula says", said and abs(float(said[1]) / expected - 1) < .01, (expected, text))


def options(folder):
    """The numbers that are asked for are those of the file."""
    mesh = save(os.path.join(folder, "egg.obj"), ellipsoid(.03, .02, .012, 20, 20))
    whole, few, body = (os.path.join(folder, name) for name in ("whole.ma", "few.ma", "egg.yaml"))
    for out, more in ((whole, []), (few, ["--spheres", "4"])):
        code, text = hapticd("import", "--medial", mesh, out, "--tolerance", "0.0005", "--samples", "3000", *more)
        check(f"{os.path.basename(out)} is imported", code == 0, text)
    check("no more spheres than were asked for, and a word about them", len(read(few)[0]) == 4 < len(read(whole)[0]) and "more --spheres may help" in text, text)
    code, text = hapticd("import", "--medial", mesh, body, "--samples", "3000", "--mass", "0.03", "--damping", "0.7")
    written = open(body, encoding="utf-8").read()
    check("mass and damping are written", code == 0 and "\n  mass: 0.03\n" in written and "\n  damping: 0.7\n" in written, written[-200:])
    check("and felt", written.splitlines()[1] == "format: hapticd-model/2" and "0.7 N s/m and 30 g for each sphere" in text, text)


def place(folder):
    """A mesh far off, in millimetres and with z up comes to the hand as a part does."""
    points, faces = capsule(.06, .01), os.path.join(folder, "far.obj")
    moved = "".join(f"v {float(x) * 1e3 + 300} {float(y) * 1e3 - 40} {float(z) * 1e3 + 7}\n" if kind == "v" else line + "\n"
                    for line in points.splitlines() for kind, x, y, z in [(line.split() + [""] * 4)[:4]])
    out = os.path.join(folder, "far.ma")
    spheres = {}
    for name, options in (("centred", ["--scale", "0.001", "--center"]), ("fitted", ["--fit", "0.04", "--center"]), ("turned", ["--scale", "0.001", "--center", "--up", "z"])):
        code, text = hapticd("import", "--medial", save(faces, moved), "-o", out, *options, *FEWER)
        check(f"a mesh far off is imported and {name}", code == 0, text)
        spheres[name] = read(out)[0]
    ends = {name: [max(s[k] for s in all) for k in range(3)] for name, all in spheres.items()}
    middle = {name: [(max(s[k] for s in all) + min(s[k] for s in all)) / 2 for k in range(3)] for name, all in spheres.items()}
    check("its middle is the origin", all(abs(m) < 1e-3 for one in middle.values() for m in one), middle)
    check("its length is along the axis that it had", ends["centred"][2] > .02 > 5e-3 > abs(ends["centred"][1])
          and ends["turned"][1] > .02 > 5e-3 > abs(ends["turned"][2]), ends)
    check("it has the size that was asked for", abs(ends["fitted"][2] + max(s[3] for s in spheres["fitted"]) - .02) < 1e-3, ends)


def cracked(text):
    """The same surface as CAD programs write it: each face with points of its own, which differ by rounding, and every
    seventh face turned round."""
    points = [[float(c) for c in line.split()[1:]] for line in text.splitlines() if line[0] == "v"]
    faces = [[int(i) - 1 for i in line.split()[1:]] for line in text.splitlines() if line[0] == "f"]
    lines, count = [], 0
    for n, face in enumerate(faces):
        for i in face:
            lines.append("v " + " ".join(repr(c + n % 3 * 1e-12) for c in points[i]))
        corners = [count + k + 1 for k in range(len(face))]
        lines.append("f " + " ".join(map(str, corners[::-1] if n % 7 == 0 else corners)))
        count += len(face)
    return "\n".join(lines) + "\n"


def repairFirst(folder):
    """What is repaired for a part is repaired for a soft body as well."""
    mesh, out = save(os.path.join(folder, "cracked.obj"), cracked(torus(.05, .012, 24, 12))), os.path.join(folder, "cracked.ma")
    code, text = hapticd("import", "--medial", mesh, "--tolerance", "0.002", out, *FEWER)
    check("a surface with cracks of rounding and turned faces is imported", code == 0, text)
    check("and what was repaired is told", "points were joined" in text and "triangles were reversed" in text, text)


def refuse(folder):
    def refused(name, text, expected, *more):
        code, said = hapticd("import", "--medial", save(os.path.join(folder, name), text),
                             os.path.join(folder, "out.ma"), *more)
        check(f"{name} is refused with its reason", code == 2 and expected in said, said)

    refused("open.obj", obj([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [[0, 1, 2]]), "expected a closed surface")
    refused("bad.obj", "v 0 0 zero\n", "bad.obj:1: 'v 0 0 zero' is not a point")
    refused("index.obj", "v 0 0 0\nf 1 2 3\n", "index.obj:2: the face names the point '2'; expected 1 to 1")
    refused("empty.stl", "solid nothing\nendsolid\n", "no triangles")
    refused("what.ply", "ply\n", "the header has no end")
    refused("what.txt", "OFF\n", "expected .obj, .stl, .ply")
    code, said = hapticd("import", "--medial", os.path.join(folder, "none.obj"), os.path.join(folder, "out.ma"))
    check("a file that is not there is refused", code == 2 and "none.obj" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.txt"))
    check("an output of another kind is refused", code == 2 and ".ma or .yaml" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.ma"), "--mass", "0.1")
    check("a material for a file without materials is refused", code == 2 and "--mass has no effect" in said and "ends in .yaml" in said, said)
    for body in (save(os.path.join(folder, "body.ma"), "1 0 0\nv 0 0 0 0.01\n"), os.path.join(folder, "open.obj")):
        code, said = hapticd("import", "--calibrate", save(os.path.join(folder, "presses.csv"), "x,y,z,depth,force\n0,0,0.01,0.001,0.1\n"), body,
                             "-o", os.path.join(folder, "fitted.yaml"))
        check(f"{os.path.basename(body)} is not fitted, and what would be is told", code == 2 and "--medial MESH.stl -o BODY.yaml" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.yaml"), "--poisson", "0.4")
    check("Poisson's ratio alone is refused", code == 2 and "--young" in said, said)
    code, said = hapticd("import", "--medial", os.path.join(folder, "open.obj"), os.path.join(folder, "out.yaml"), "--young", "10e3")
    check("a modulus without the thickness of the layer is refused", code == 2 and "--thickness" in said, said)


def fullDisk(folder):
    """No file may grow, as on a full disk: a body that was made before stays, and nothing incomplete is left."""
    def full():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

    name = save(os.path.join(folder, "small.obj"), box(0.03, 0.02, 0.01))
    for kept, out in (("# made before\n", "kept.ma"), (None, "new.ma"), (None, "new.yaml")):
        file = os.path.join(folder, out)
        if kept:
            save(file, kept)
        done = subprocess.run([HAPTICD, "import", "--medial", name, file, "--samples", "1000"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=300, preexec_fn=full)
        check(f"{out}: a full disk is told", done.returncode == 1 and "cannot be written: File too large" in done.stderr, done)
        check(f"{out}: is as before", (open(file).read() if os.path.exists(file) else None) == kept)
    check("nothing else is left", not [n for n in os.listdir(folder) if n.endswith(".part")], os.listdir(folder))


with tempfile.TemporaryDirectory() as work:
    for case in (tissue, options, place, repairFirst, refuse, fullDisk):
        case(work)
finish()
