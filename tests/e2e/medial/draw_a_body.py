#!/usr/bin/env python3
"""A soft body of a running daemon is drawn as it is pressed: `hapticd ctl geometry`, once and followed.

Usage: draw_a_body.py HAPTICD CONFIG     prints one line per case; exit 1 when one is off.
"""
import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
from functools import partial

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program

HAPTICD, CONFIG = sys.argv[1], os.path.abspath(sys.argv[2])


with tempfile.TemporaryDirectory() as folder:
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder)
    ctl = partial(program(HAPTICD, environment), "ctl", "--name", "drawn")

    def seconds():
        return json.loads(ctl("status")[1])["seconds"]

    def followed():
        """Frames come 60 times a second of the servo's time, with the vertices of the triangles, and move."""
        viewer = subprocess.Popen([HAPTICD, "ctl", "--name", "drawn", "geometry", "plate", "--follow"],
                                  env=environment, stdout=subprocess.PIPE, text=True)
        try:
            drawn = json.loads(viewer.stdout.readline())
            first = json.loads(viewer.stdout.readline())
            begun, frames = seconds(), [first]
            while frames[-1]["frame"] < first["frame"] + 180:
                frames.append(json.loads(viewer.stdout.readline()))
            took = seconds() - begun
        finally:
            viewer.kill()
            viewer.wait()
        count = len(first["xyz"])
        check("every frame has the vertices of the triangles", count == len(drawn["xyz"]) > 300 and
              all(len(frame["xyz"]) == count for frame in frames), count)
        check("frames are numbered", all(a["frame"] < b["frame"] for a, b in zip(frames, frames[1:])))
        rate = (frames[-1]["frame"] - first["frame"]) / took
        check("they are made 60 times a second", 50 < rate < 66, rate)
        moved = [max(abs(a - b) for a, b in zip(first["xyz"], frame["xyz"])) for frame in frames]
        check("they show the body move", max(moved) > 1e-3, max(moved))
        steps = [max(abs(a - b) for a, b in zip(one["xyz"], two["xyz"])) for one, two in zip(frames, frames[1:])]
        check("little by little", max(steps) < 0.5 * max(moved), (max(steps), max(moved)))

    def in_memory():
        """The same triangles as memory, with the plugin's normals."""
        with socket.socket(socket.AF_UNIX) as client:
            client.settimeout(30)
            client.connect(os.path.join(folder, "drawn.sock"))
            client.sendall(b'{"do":"geometry","model":"teapot","as":"memory"}\n{"do":"geometry","model":"teapot","as":"paper"}\n')
            line, descriptors, _, _ = socket.recv_fds(client, 1 << 16, 4)
            answer = json.loads(line.split(b"\n")[0])
        text = json.loads(ctl("geometry", "teapot")[1])
        check("as memory it has as many", (answer["vertices"], answer["triangles"], len(descriptors)) == (len(text["xyz"]) // 3, len(text["triangles"]) // 3, 1), answer)
        data = os.pread(descriptors[0], answer["bytes"], 0)
        places, corners = 3 * answer["vertices"], 3 * answer["triangles"]
        numbers = struct.unpack(f"<{2 * places}f", data[:8 * places])
        check("the same places", max(abs(a - b) for a, b in zip(numbers, text["xyz"])) < 1e-7)
        normals = numbers[places:]
        check("unit normals", answer["normals"] and all(abs(sum(n * n for n in normals[i:i + 3]) - 1) < 1e-5 for i in range(0, places, 3)))
        check("the same triangles", list(struct.unpack(f"<{corners}I", data[8 * places:])) == text["triangles"])
        try:
            os.ftruncate(descriptors[0], 0)
            sealed = False
        except OSError:
            sealed = True
        check("which nobody makes shorter", sealed)
        os.close(descriptors[0])
        with socket.socket(socket.AF_UNIX) as client:
            client.settimeout(30)
            client.connect(os.path.join(folder, "drawn.sock"))
            client.sendall(b'{"do":"geometry","model":"teapot","as":"memory","triangles":80000}\n')
            fine = json.loads(socket.recv_fds(client, 1 << 16, 4)[0])
        check("for a client with room for more it is finer", abs(text["tolerance"] / fine["tolerance"] - 5) < 1e-3 and
              answer["triangles"] < fine["triangles"] <= 20000 and "note" not in fine, fine)

    scene = os.path.join(folder, "pressed.yaml")  # the front of the plate is at z = 30 mm
    with open(scene, "w", encoding="utf-8") as out:
        out.write(f"hapticd: 1\nservo: {{rate: 1000}}\nhand: {{script: press, radius: 0.033, rise: 0.01, rate: 0.5}}\n"
                  f"models:\n  - name: plate\n    plugin: mat_deformable\n    pose: {{position: [0, 0, 0.02]}}\n"
                  f"    parameters: {{geometry: {os.path.join(CONFIG, 'models', 'soft-plate.yaml')}, display_tolerance: 0.001}}\n"
                  f"  - name: branch\n    plugin: mat_deformable\n    pose: {{position: [0.5, 0, 0]}}\n"
                  f"    parameters: {{geometry: {os.path.join(CONFIG, 'models', 'branch.ma')}, display_tolerance: 0.001}}\n")
    said = os.path.join(folder, "said.txt")
    run = subprocess.Popen([HAPTICD, "run", scene, "--for", "100", "--name", "drawn"],
                           env=environment, stdout=open(said, "w", encoding="utf-8"), stderr=subprocess.STDOUT)
    try:
        end = time.monotonic() + 60
        while time.monotonic() < end and run.poll() is None and ctl("status")[0] != 0:
            time.sleep(0.1)
        check("the daemon answers", run.poll() is None and ctl("status")[0] == 0, ctl("status"))
        end = time.monotonic() + 30
        seen, moved, drawn = None, 0, {"xyz": [], "triangles": [0]}
        while time.monotonic() < end and moved < 5e-4:
            code, out, err = ctl("geometry", "plate", "--tolerance", "0.001")
            if code != 0:
                check("the body is drawn", False, err)
                break
            drawn = json.loads(out)
            seen = seen or drawn
            moved = max(abs(a - b) for a, b in zip(seen["xyz"], drawn["xyz"]))
            time.sleep(0.05)
        check("its vertices move when it is pressed", moved >= 5e-4, moved)
        seen = seen or drawn
        check("its triangles stay and join its vertices",
              drawn["triangles"] == seen["triangles"] and max(drawn["triangles"]) < len(drawn["xyz"]) // 3)
        file = os.path.join(folder, "plate.obj")
        code, out, err = ctl("geometry", "plate", "--tolerance", "0.001", "--obj", file)
        lines = open(file, encoding="utf-8").read().splitlines() if code == 0 else []
        check("an OBJ file holds the same triangles", sum(line[0] == "v" for line in lines) == len(seen["xyz"]) // 3 and
              [int(w) - 1 for line in lines if line[0] == "f" for w in line.split()[1:]] == seen["triangles"], err)
        followed()
        check("a rigid model is added", ctl("add", os.path.join(CONFIG, "scenes", "teapot.yaml"))[0] == 0)
        check("it is drawn as well", len(json.loads(ctl("geometry", "teapot")[1] or "{}").get("triangles", [])) > 1000)
        in_memory()
        check("the list says which deform", {m["name"]: m["deforms"] for m in json.loads(ctl("list")[1])["models"]} == {"plate": True, "branch": True, "teapot": False})
        code, out, err = ctl("geometry", "teapot", "--follow")
        check("following what does not deform is refused with its cure", code == 1 and "display_tolerance" in err, err)
        for arguments, why, fails in ((("geometry", "nobody"), "no model", 2), (("geometry", "plate", "--tolerance", "2"), "from 0.00001 to 1 m", 2),
                                      (("geometry", "teapot", "--tolerance", "0.00001"), "larger", 1)):
            code, out, err = ctl(*arguments)
            check(" ".join(arguments) + " is refused with its reason", code == fails and why in err, (code, out[:200], err))
        code, out, err = ctl("geometry", "branch", "--tolerance", "0.00001")
        works = re.search(r"larger tolerance, such as ([0-9.e-]+) m", err)
        check("a tolerance that needs too many triangles of it is refused with one that works", code == 1 and works is not None, err)
        code, out, err = ctl("geometry", "branch", "--tolerance", works[1] if works else "1")
        check("which works, without a reduction: its frames belong to its own triangles", code == 0 and "note" not in json.loads(out), err)
        code, out, err = ctl("stop")
        check("the run ends in order", code == 0 and run.wait(timeout=30) == 0, err + open(said, encoding="utf-8").read())
    finally:
        run.kill()
finish()
