#!/usr/bin/env python3
"""What people write by mistake is named, with what they meant: files of other programs, units, endings, words.

Usage: slips_of_users.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import os
import pty
import resource
import signal
import struct
import subprocess
import sys
import tempfile

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
from e2e import check, finish, program, write

SCENE = """hapticd: 1
device: {source}/config/devices/simulated-premium15.yaml
clients: {clients}
models:
  - name: part
    plugin: nurbs_rigid
    parameters: {{geometry: {geometry}, stiffness: {stiffness}}}
"""
SPHERE = os.path.join(SOURCE, "config", "models", "sphere.yaml")
STL = struct.pack("<80sI12f2x", b"", 1, *[0.0] * 3, 0, 0, 0, 1, 0, 0, 0, 1, 0)


def scene(folder, geometry=SPHERE, stiffness=800, clients="off"):
    return write(folder, "scene.yaml", SCENE.format(source=SOURCE, geometry=geometry, stiffness=stiffness, clients=clients))


def foreign(folder, ask):
    for name, content, kind in (("cube.stl", STL, "a mesh (STL)"), ("block.step", "ISO-10303-21;\nHEADER;\n", "a STEP file"),
                                ("cube.obj", "v 0 0 0\n", "a mesh (OBJ)")):
        file = write(folder, name, content)
        code, out, err = ask("check", scene(folder, geometry=name))
        part = name.split(".")[0] + ".hpart"
        check(f"geometry: {name} is told how to come in", code == 2 and f"{kind}, expected YAML" in out + err
              and f"hapticd import {file} -o {part}" in out + err, (code, out, err))
    code, out, err = ask("check", write(folder, "a.h5", b"\x89HDF\r\n\x1a\n"))
    check("a recording is no scene", code == 2 and "a recording (HDF5)" in out + err and "hapticd replay" in out + err, (code, out, err))
    code, out, err = ask("check", write(folder, "a.hpart", b"\3\0\0"))
    check("a part is no scene", code == 2 and "hapticd import" in out + err, (code, out, err))
    named = write(folder, "cubestl", STL)
    code, out, err = ask("import", named, "-o", os.path.join(folder, "x.hpart"))
    check("a mesh without an ending is told the one that it needs", code == 2 and f"rename it to {named}.stl" in err, (code, out, err))
    code, out, err = ask("import", write(folder, "cube", b"no model"), "-o", os.path.join(folder, "x.hpart"))
    check("any other file without an ending is asked for it", code == 2 and "expected the ending .bpt, .stl" in err, (code, out, err))
    code, out, err = ask("import", write(folder, "short.stl", STL[:-1]), "-o", os.path.join(folder, "x.hpart"))
    check("a short STL is told its length", code != 0 and "1 triangle has 134 bytes, but this file has 133" in err, (code, out, err))


def cube(at, size=0.04):
    """The twelve triangles of a cube, as an STL has them."""
    corner = [[at[k] + (size if i >> k & 1 else 0) for k in range(3)] for i in range(8)]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return [[corner[q[0]], corner[q[k]], corner[q[k + 1]]] for q in quads for k in (1, 2)]


def stl(triangles):
    body = b"".join(struct.pack("<12f2x", 0, 0, 0, *[v for p in t for v in p]) for t in triangles)
    return struct.pack("<80sI", b"", len(triangles)) + body


def on_a_terminal(*words):
    """Returns what a command writes as errors and progress on a terminal."""
    ours, theirs = pty.openpty()
    subprocess.run([HAPTICD, *words], stdout=subprocess.DEVNULL, stderr=theirs, timeout=120, check=True)
    os.close(theirs)
    said = os.read(ours, 65536).decode()
    os.close(ours)
    return said


def meshes(folder, ask):
    out_file = os.path.join(folder, "x.hpart")
    for name, second, crosses in (("over.stl", (0.02, 0.02, 0.02), True), ("through.stl", (0.01, -0.005, 0.013), True),
                                  ("apart.stl", (0.05, 0, 0), False), ("stacked.stl", (0, 0.04, 0), False),
                                  ("inside.stl", None, False)):
        more = cube(second) if second else cube((0.01, 0.01, 0.01), 0.02)
        code, out, err = ask("import", write(folder, name, stl(cube((0, 0, 0)) + more)), "-o", out_file)
        told = "shells pass through each other" in out
        check(f"{name}: shells that cross are told, others not", code == 0 and told == crosses, (code, out, err))
    code, out, err = ask("part", "info", out_file)
    ask("import", write(folder, "a.stl", stl(cube((0, 0, 0), 40))), "-o", out_file, "--scale", "0.001")
    code, out, err = ask("part", "info", out_file)
    check("the unit is the scale that was given", "unit mm" in out, out)
    ask("import", write(folder, "a.stl", stl(cube((0, 0, 0), 40))), "-o", out_file, "--fit", "0.05")
    code, out, err = ask("part", "info", out_file)
    check("or what it was made to fit", "unit whatever makes it fit into 0.05 m" in out, out)
    code, out, err = ask("import", write(folder, "a.stl", stl(cube((0, 0, 0), 40))), "-o", out_file)
    code, out, err = ask("part", "info", out_file)
    check("a large part is given in m", "size: 40 x 40 x 40 m" in out, out)
    code, out, err = ask("import", os.path.join(folder, "a.stl"), "-o", out_file, "--scale", "1e-9")
    check("a part too small to be felt is warned of", "too small to be felt" in err, err)
    code, out, err = ask("import", os.path.join(folder, "a.stl"), "-o", out_file, "--scale", "1mm")
    check("a scale that is no number is told so", code == 2 and '"1mm" is not a number' in err, err)
    steps = on_a_terminal("import", write(folder, "cube.stl", stl(cube((0, 0, 0)))), "-o", os.path.join(folder, "y.hpart"))
    check("a terminal shows what a long import does, a log does not", all(step in steps for step in ("reading ", "joining the corners", "writing the part"))
          and "joining" not in ask("import", os.path.join(folder, "cube.stl"), "-o", os.path.join(folder, "y.hpart"))[2], steps)
    code, out, err = ask("import", out_file, "-o", os.path.join(folder, "y.hpart"))
    check("a part is no file to import", code == 2 and "is a part already" in err, err)
    model = os.path.join(SOURCE, "config", "models", "box.yaml")
    code, out, err = ask("import", model, "--fit", "0.02", "-o", os.path.join(folder, "cap.yaml"))
    check("nor is a model file", code == 2 and "is a model file already, whose size and place stay" in err and f"hapticd view {model} shows it" in err, err)


def outputs(folder, ask):
    """What would be written over what is read is refused, and the file stays as it was."""
    recording, path, file = os.path.join(folder, "r.h5"), os.path.join(folder, "p.csv"), scene(folder)
    code, out, err = ask("run", file, "--for", "0.5", "--virtual-time", "--record", recording)
    check("a recording is made", code == 0, err)
    write(folder, "p.csv", "t,x,y,z\n0,0,0.2,0\n0.001,0,30,0\n")
    for words, kept, what in ((("plot", recording, "--out", recording), recording, "the recording itself"),
                              (("trace", file, "--probe", path, "--out", file), file, "the scene itself"),
                              (("trace", file, "--probe", path, "--out", path), path, "the probe path itself"),
                              (("trace", file, "--probe", path, "--out", SPHERE), SPHERE, "a file of the scene's models itself")):
        before = open(kept, "rb").read()
        code, out, err = ask(*words)
        check(f"{words[0]} does not write over {what}", code == 2 and what in err and open(kept, "rb").read() == before, (code, out, err))
    code, out, err = ask("export", recording, "--csv", os.path.join(folder, "t.csv"))
    check("a folder that is named as a file is not made", code == 2 and "--stream STREAM, with one of ticks" in err
          and not os.path.exists(os.path.join(folder, "t.csv")), (code, out, err))
    others(folder, ask, recording, path, file)
    standard_output(folder, recording, path, file)
    of_a_recording(folder, ask, recording)
    where_nothing_can_be_written(folder, ask, recording)
    on_a_full_disk(folder, recording, path, file)
    code, out, err = ask("trace", file, "--probe", path, "--out", os.path.join(folder, "feet.csv"))
    check("a path in mm is warned of", code == 0 and "row 2 is 30 m from the world's origin" in err, err)
    whole = open(recording, "rb").read()
    middle = len(whole) // 2
    blocks = int.from_bytes(whole[568:576], "little")  # where the rows begin, after the descriptions (driver/docs/recording.md)
    code, out, err = ask("replay", write(folder, "stump.h5", whole[:blocks]))
    check("of a recording that was cut before its first rows replay tells why it has no ticks", code == 2 and f"has no ticks, because it ends at byte {blocks}" in err, (code, out, err))
    for name, bytes_of_it in (("cut.h5", whole[:middle]), ("hurt.h5", whole[:middle] + bytes(200_000) + whole[middle + 200_000:])):
        code, out, err = ask("replay", write(folder, name, bytes_of_it))
        check(f"{name}: a damaged recording is not the same to the last bit", code != 0 and ("lost" in err or "difference" in out), (code, out, err))
        ask_plot = ask("plot", os.path.join(folder, name), "--out", os.path.join(folder, "x.svg"))
        check(f"{name}: nor is it drawn without a word", name != "cut.h5" or "it ends at byte" in ask_plot[2] and "are lost" in ask_plot[2], ask_plot)


def standard_output(folder, recording, path, file):
    """- is standard output, whatever file has this name; where nothing goes there, it is refused."""
    write(folder, "-", "something else")
    here = lambda *words: subprocess.run([HAPTICD, *words], cwd=folder, capture_output=True, text=True, timeout=120)
    done = here("trace", file, "--probe", path, "--out", "-")
    check("trace writes to standard output beside a file -", done.returncode == 0 and done.stdout.startswith("t,model,"), done)
    for words in (("run", file, "--for", "0.1", "--virtual-time", "--report", "-"), ("run", file, "--for", "0.1", "--virtual-time", "--record", "-"),
                  ("plot", recording, "--out", "-")):
        done = here(*words)
        check(f"{words[0]} {words[-2]} -: is no file", done.returncode == 2 and "not to standard output" in done.stderr, done)
    os.remove(os.path.join(folder, "-"))


def where_nothing_can_be_written(folder, ask, recording):
    """Is bad input to each command, as to run, and told before the work begins."""
    mesh = write(folder, "cube.stl", stl(cube((0, 0, 0))))
    for words in (("plot", recording, "--out", "/nonexist/x.svg"), ("import", mesh, "-o", "/nonexist/x.hpart"), ("device", "new", "x", "--out", "/nonexist/x.yaml"),
                  ("plugin", "new", "x", "--dir", "/dev/null/x"), ("trace", scene(folder), "--probe", os.path.join(folder, "p.csv"), "--out", "/nonexist/x.csv")):
        code, out, err = ask(*words)
        check(f"{words[0]} {words[1]} where nothing can be written is bad input", code == 2 and words[-1] in err and " cannot be " in err, (code, out, err))


def on_a_full_disk(folder, recording, path, file):
    """What was begun and could not be completed is not left behind, so that the next try is not refused. The disk is a limit of 100 bytes a file."""
    def limited():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

    new = os.path.join(folder, "new")
    for words, left in ((("plot", recording, "--out", new + ".svg"), ".svg"), (("export", recording, "--mcap", new + ".mcap"), ".mcap"),
                        (("export", recording, "--csv", new + ".csv", "--stream", "ticks"), ".csv"), (("export", recording, "--csv", new), ""),
                        (("trace", file, "--probe", path, "--out", new + ".feet"), ".feet"), (("plugin", "new", "my_shape", "--dir", new), ""),
                        (("tune", file, "--motion-seconds", "0.2", "--limit-seconds", "1", "--write"), None)):
        done = subprocess.run([HAPTICD, *words], capture_output=True, text=True, timeout=120, preexec_fn=limited)
        name = new + left if left is not None else file.replace(".yaml", ".tuned.yaml")
        check(f"{words[0]} leaves nothing on a full disk", done.returncode == 1 and not os.path.exists(name) and not os.path.exists(name + ".part")
              and "written" in done.stderr, (done, os.listdir(folder)))


def of_a_recording(folder, ask, recording):
    """What is asked of a recording that has no such part, or is to go where nothing can be written."""
    svg = write(folder, "rec.svg", "<svg/>")
    write(folder, "part.hpart", "hapticd-part/1"), write(folder, "seen.yaml", "hapticd: 1\nmodels: []\n")
    for words, meant in ((("replay", recording, "--set", "part.stiffness=abc"), '"abc" is not a number, expected MODEL.PARAMETER=NUMBER'),
                         (("replay", recording, "--set", "stiffness=3"), "no model is named, expected MODEL.PARAMETER=NUMBER; did you mean part.stiffness=3?"),
                         (("replay", recording, "--set", "part.stiffness"), "no value is given, expected MODEL.PARAMETER=NUMBER"),
                         (("replay", recording, "--set", "prat.stiffness=3"), 'no model "prat", expected one of part (did you mean "part"?)'),
                         (("plot", recording, "--arm", "1"), "has no ticks of arm 1, expected --arm 0 (the recording has 1 arm)"),
                         (("export", recording, "--csv", svg), "names a file, but each stream has a table of its own; expected a folder"),
                         (("export", recording, "--csv", os.path.join(folder, "run.xlsx")), "names a file, but each stream has a table of its own; expected a folder"),
                         (("view", os.path.join(folder, "part.hpart")), "part.hpart"),
                         (("run", os.path.join(folder, "seen.yaml"), "--virtual-time", "--for", "0.01", "--record", os.path.join(folder, "run.csv")), "recordings are HDF5, expected a name that ends in .h5"),
                         (("export", recording, "--csv", "/nonexist/x", "--stream", "ticks"), "expected a file in a folder that you may write to"),
                         (("export", recording, "--mcap", "/nonexist/x"), "expected a file in a folder that you may write to")):
        code, out, err = ask(*words)
        check(f"{words[0]} {' '.join(words[2:])} is told what there is", code == 2 and meant in err, (code, out, err))


def others(folder, ask, recording, path, file):
    """A file of another kind is not written over; an earlier output is."""
    for words, kind in ((("plot", recording, "--out"), "a picture (SVG)"), (("export", recording, "--mcap"), "an MCAP file"),
                        (("export", recording, "--stream", "ticks", "--csv"), "a table of this command"),
                        (("run", file, "--for", "0.05", "--virtual-time", "--report"), "a report"),
                        (("run", file, "--for", "0.05", "--virtual-time", "--picture"), "a picture (SVG)"),
                        (("run", file, "--for", "0.05", "--virtual-time", "--record"), "a recording"),
                        (("trace", file, "--probe", path, "--out"), "a table of this command")):
        for name, content in (("mine.yaml", "a: 1\n"), ("cube.stl", STL), ("mine.csv", "t,x,y,z\n0,0,0,0\n"), ("mine.json", "{}\n")):
            mine = write(folder, name, content)
            before = open(mine, "rb").read()
            code, out, err = ask(*words, mine)
            check(f"{words[0]} {words[-1]} leaves {name} alone", code == 2 and f"is not {kind}" in err and open(mine, "rb").read() == before, (code, out, err))
        again = write(folder, "again", "")
        codes = [ask(*words, again)[0] for _ in range(2)]
        check(f"{words[0]} {words[-1]} fills an empty file and replaces its own", codes == [0, 0] and os.path.getsize(again) > 0, codes)
    write(folder, "p2.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0.2,0,1,0,0,0\n0.001,0,0.2,0,0.9999,0,0,0\n0.002,nan,nan,nan,nan,nan,nan,nan\n# x\n0.003,0,0.2,0,0,0,0,0\n")
    code, out, err = ask("trace", file, "--probe", os.path.join(folder, "p2.csv"), "--out", "-")
    check("an orientation without its length is refused at its line, others are taken", code == 2 and "p2.csv:6: " in err and "has the length 0; expected a unit quaternion" in err, err)


def everything(folder, ask):
    """All problems at once, whatever stage finds them."""
    two = """hapticd: 1
servo: {rate: fast}
limits: {force: 3}
hand: {kind: sine}
models:
  - {name: a, plugin: nurbs_rigid, parameters: {geometry: cube.stl}}
  - {name: b, plugin: nurbs_rigid, parameters: {geometry: %s, stiffness: soft}}
  - {name: c, plugin: nurbs_rigid, parameters: {geometry: %s, friction_static: 0.2, friction_dynamic: 0.5}}
  - {name: d, plugin: nurbs_rigid, pose: {position: [50, 0, 0]}, parameters: {geometry: %s, stiffness: 0.8}}
""" % (SPHERE, SPHERE, SPHERE)
    write(folder, "cube.stl", STL)
    code, out, err = ask("check", write(folder, "two.yaml", two))
    for what in ("servo.rate", "limits belongs in the device file", "a mesh (STL), expected YAML", "stiffness: the text \"soft\"",
                 "friction", "50 m from the world's origin", "0.8 N/m cannot be felt"):
        check(f"in one check: {what}", what in out, out)
    check("what kept checks from running is said", "some checks can run only after these are corrected" in err, err)
    check("a name of another group is not proposed", "arm.kind" not in out, out)
    code, out, err = ask("check", write(folder, "empty.yaml", ""))
    check("an empty file is told what to begin with", 'a scene begins with "hapticd: 1"' in out, out)
    for wrong, meant in ((("ctl", "stopp"), 'there is no subcommand "ctl stopp"'), (("device", "lst"), '(did you mean "list"?)'),
                         (("plugin", "chek", "x.so"), '(did you mean "check"?)'),
                         (("ctl", "set", "ball.stiffness", "600"), '`hapticd ctl set MODEL PARAMETER VALUE`; did you mean "ball stiffness"?')):
        code, out, err = ask(*wrong)
        check(f"{' '.join(wrong)} is told", code == 2 and meant in err, err)
    code, out, err = ask("import", "a.stl", "--unit", "mm", "-o", "x.hpart")
    check("an option that is not there is named, with the one that was meant", code == 2 and "there is no option --unit" in err and "--scale" in err, err)
    code, out, err = ask("run", "a.yaml", "--reprot", "r.json")
    check("and the nearest one", code == 2 and '(did you mean "--report"?)' in err, err)
    medial = "format: hapticd-model/2\nmedial:\n  points: [[[0, 0, 0], [0.1, 0]], [[0, 0, 0.1], [0.1, 0, 0.1]]]\n" \
             "  radius: [[0.01, -0.012], [0.01]]\n  stiffness: soft\n  mass: -1\n  dampng: 1\n"
    body = "hapticd: 1\nmodels:\n  - {name: m, plugin: mat_deformable, parameters: {geometry: m.yaml}}\n"
    write(folder, "m.yaml", medial)
    code, out, err = ask("check", write(folder, "body.yaml", body))
    for what in ("dampng", "points[0][1]", "radius[0][1]", "radius[1]", "stiffness", "mass"):
        check(f"of a model file too: {what}", what in out, out)
    file = os.path.join(folder, "m.yaml")
    for what in (f"{file}:5:14: medial.stiffness: the text \"soft\"", f"{file}:6:9: medial.mass: -1, expected", f"{file}:7:11: medial.dampng: unknown key",
                 '(did you mean "damping"?)'):
        check(f"each at its own place: {what}", any(line.startswith(what) or "did you mean" in what and what in line for line in out.splitlines()), out)


def numbers(folder, ask):
    code, out, _ = ask("check", scene(folder, stiffness=0.8))
    check("a stiffness in N/mm is warned of", code == 0 and "0.8 N/m cannot be felt" in out and "1 N/mm is 1000 N/m" in out, out)
    code, out, _ = ask("check", scene(folder, clients="{mode: add, max_force: 40}"))
    check("so is a bound beyond the arm's", code == 0 and "clients.max_force" in out and "8.5 N at most" in out, out)
    code, out, _ = ask("check", scene(folder, stiffness="800, friction: 0.5"))
    check("a friction is told of which it may be, and where all parameters are", code == 2 and '(did you mean "friction_dynamic" or "friction_static"?)' in out
          and "; see hapticd plugin info nurbs_rigid" in out, out)
    code, out, _ = ask("check", scene(folder))
    check("a good scene is not", code == 0 and "warning" not in out, out)


def words(folder, ask):
    code, _, err = ask("run", scene(folder), "--for", "0.1", "--virtual-time", "--picture", os.path.join(folder, "run.png"))
    check("a picture is no PNG", code == 2 and "ends in .svg" in err and not os.path.exists(os.path.join(folder, "run.png")), err)


TORQUE_ARM = os.path.join(SOURCE, "config/devices/simulated-premium15.yaml")
BOX = os.path.join(SOURCE, "config/models/box.yaml")


def at_the_number(folder, ask):
    """A warning stands at the number that it is about."""
    one = f"device: {TORQUE_ARM}\n"
    text = "hapticd: 1\nservo: {rate: 200}\n" + one + f"models:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SPHERE}, stiffness: 20000}}}}\n"
    code, out, err = ask("check", write(folder, "doubt.yaml", text))
    check("a stiffness that cannot be stable is told at its number", "models[0].parameters.stiffness: warning: ball pushes" in out, out)
    button = f"  - {{name: b, plugin: push_button, parameters: {{geometry: {BOX}, axis: [0, 0, -1], stiffness: 2000, detent: [[0, 0], [4, 0.003], [2, 0.004]], end_stiffness: 3000}}}}\n"
    code, out, err = ask("check", write(folder, "doubt.yaml", "hapticd: 1\n" + one + "models:\n" + button))
    check("rows of a detent turned round are told with the order", "row 3: a travel of 2 m" in out and "[travel in m, force in N]" in out, out)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    ask = program(HAPTICD, dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch))
    foreign(scratch, ask)
    meshes(scratch, ask)
    outputs(scratch, ask)
    everything(scratch, ask)
    numbers(scratch, ask)
    at_the_number(scratch, ask)
    words(scratch, ask)
finish()
