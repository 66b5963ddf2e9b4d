#!/usr/bin/env python3
"""Models that come around the tip, and scenes that are loaded again: nobody is thrown, and no permission outlives its scene.

Usage: change_a_scene.py HAPTICD SOURCE     prints one line per case; exit 1 when one is off.
"""
import atexit
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings

import numpy

HAPTICD, SOURCE = sys.argv[1], sys.argv[2]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
sys.path.insert(0, os.path.join(SOURCE, "driver", "doors", "client", "python"))
import hapticd
from e2e import check, finish, refused, until

HEAD = """hapticd: 1
servo: {{rate: {rate}}}
device: {source}/config/devices/simulated-premium15.yaml
hand: {{script: {script}, tremor: 0, wander: 0}}
clients: {clients}
"""
BALL = """  - name: {name}
    plugin: nurbs_rigid
    pose: {{position: [{x}, 0, 0]}}
    parameters: {{geometry: {source}/config/models/sphere.yaml, stiffness: 800}}
"""
ARM = "simulated Premium 1.5"


def write(folder, name, models, rate=1000, script="guided", clients="add"):
    file = os.path.join(folder, name + ".yaml")
    with open(file, "w") as out:
        out.write(HEAD.format(source=SOURCE, rate=rate, script=script, clients=clients))
        out.write("models:\n" + "".join(BALL.format(source=SOURCE, name=n, x=x) for n, x in models) if models else "models: []\n")
    return file


def largest(client, rows):
    ticks = client.rows("ticks", last=rows)
    return float(numpy.sqrt(sum(ticks["arm0_sent_f" + axis] ** 2 for axis in "xyz")).max())


def around_the_tip(client, ball):
    with client.lead_hand(ARM) as hand:
        hand.put([0.09, 0, 0])
        check("the hand is where the ball will be", until(lambda: abs(client.state(ARM).position[0] - 0.09) < 0.002))
        first = client.streams["ticks"].written
        answer = client.ask(do="add", file=ball)
        check("the answer names the model that waits", answer.get("waiting") == ["ball"], answer)
        check("and list says so", client.ask(do="list")["models"][-1]["waits"] is True, client.ask(do="list"))
        client.wait(first + 500, timeout=30)
        check("nothing pushes the hand that is inside", largest(client, 400) == 0, largest(client, 400))
        hand.put([0.03, 0, 0])
        check("outside it waits no more", until(lambda: not client.ask(do="list")["models"][-1]["waits"], 30))
        hand.put([0.055, 0, 0])
        check("and pushes who comes back", until(lambda: largest(client, 20) > 1, 30), largest(client, 20))
        client.ask(do="disable", model="ball")
        hand.put([0.09, 0, 0])
        until(lambda: abs(client.state(ARM).position[0] - 0.09) < 0.002)
        answer = client.ask(do="enable", model="ball")
        check("enable names the model that waits, too", answer.get("waiting") == ["ball"], answer)
        first = client.streams["ticks"].written
        client.wait(first + 300, timeout=30)
        check("the same when it is enabled around the tip", largest(client, 200) == 0, largest(client, 200))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            felt = client.models["ball"].enable()
        check("enable() of a model tells its program so", felt is False and [w.category for w in told] == [hapticd.NoForceWarning]
              and "draw the hand back" in str(told[0].message) and told[0].filename == __file__, (felt, told))
        check("and so does the model", client.models["ball"].waits)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            check("a program may wait until the model is felt, and is told if it is not", client.models["ball"].enable(wait=0.2) is False and len(told) == 1, told)
            hand.put([0.03, 0, 0])
            check("it goes on when the tip was outside", client.models["ball"].enable(wait=30) is True and len(told) == 1 and not client.models["ball"].waits, told)
        hand.put([0.055, 0, 0])
        check("and the next press is felt", until(lambda: largest(client, 20) > 1, 30), largest(client, 20))


def away_from_the_tip(client):
    """A model that no tip is in does not wait, whether it is traced (near) or not (far)."""
    with client.lead_hand(ARM) as hand:
        for x in (0.03, -0.06):
            hand.put([x, 0, 0])
            check("the hand is elsewhere", until(lambda: abs(client.state(ARM).position[0] - x) < 0.002))
            client.ask(do="disable", model="ball")
            answer = client.ask(do="enable", model="ball")
            check(f"nobody is told to leave a model that is elsewhere, x = {x}", "waiting" not in answer, answer)
            check("nor by list", client.ask(do="list")["models"][-1]["waits"] is False, client.ask(do="list"))
            check("nor by enable() of a model", client.models["ball"].enable() is True and not client.models["ball"].waits)


def words_of_answers(client, folder):
    status = client.ask(do="status")
    check("status says where the daemon is found", status.get("name") == "changed" and status.get("socket") == os.path.join(folder, "changed.sock"), status)
    answer = client.ask(do="add", file=write(folder, "far", [("far", 50)]))
    warned = answer.get("warnings", [])
    check("add warns of what check warns of", any("50 m from the world's origin" in text for text in warned), answer)
    values = client.ask(do="get", model="far")["values"]
    check("no parameter that has a default is null", isinstance(values.get("ripples", []), list) and [k for k, v in values.items() if v is None and k in ("center", "inertia", "velocity")] == [], values)
    client.ask(do="remove", model="far")
    client.ask(do="add", file=write(folder, "next", [("next", 60)]))
    client.ask(do="remove", model="next")
    told = [(e["event"], e["model"]) for e in client.ask(do="events")["events"] if e.get("model") in ("far", "next")]
    check("events name a model that has left, although another one took its place", told == [(what, who) for who in ("far", "next") for what in ("came", "left")], told)
    try:
        client.ask(do="add", file=os.path.join(folder, "ball.yaml"), model="bal")
        told = ""
    except hapticd.HapticdError as error:
        told = str(error)
    check("a model that the scene does not have is met with those that it has", 'no model "bal", expected one of ball' in told, told)


def sorted_lines(environment, client, folder):
    """top has the models in the order that --sort asks for."""
    top = lambda *words: [m["name"] for m in json.loads(subprocess.run([HAPTICD, "top", "--name", "changed", "--once", "--json", *words], env=environment,
                                                                       capture_output=True, text=True, timeout=60).stdout)["models"]]
    with client.lead_hand(ARM) as hand:
        hand.put([0.03, 0, 0])
        for name, x in (("a_far", 0.6), ("z_near", -0.07)):
            client.ask(do="add", file=write(folder, name, [(name, x)]))
        hand.put([0.055, 0, 0])  # in the ball
        check("the ball is pressed", until(lambda: largest(client, 20) > 0.5, 30))
        for by, order in (("name", ["a_far", "ball", "z_near"]), ("depth", ["ball", "z_near", "a_far"])):
            check(f"top sorts by {by}", until(lambda: top("--sort", by) == order, 30), top("--sort", by))
        check("top sorts by force", until(lambda: top("--sort", "force")[0] == "ball", 30), top("--sort", "force"))
        hand.put([0.03, 0, 0])
        for name in ("a_far", "z_near"):
            client.ask(do="remove", model=name)


def stopped(run, environment, client):
    """A daemon that was stopped looks alive by its files."""
    top = lambda: subprocess.run([HAPTICD, "top", "--name", "changed", "--once"], env=environment, capture_output=True, text=True, timeout=60)
    run.send_signal(signal.SIGSTOP)
    still = top()
    run.send_signal(signal.SIGCONT)
    check("top tells that it stands still", still.returncode == 1 and "stands still" in still.stderr, (still.returncode, still.stderr))
    check("and that it goes on", until(lambda: top().returncode == 0), "")
    stalls = lambda: [e for e in client.ask(do="events")["events"] if e["event"] == "stalled"]
    check("the standstill is an event, with its length", until(stalls) and stalls()[-1]["value"] > 0.3, stalls())


def permission(client, folder):
    off = write(folder, "off", [], rate=4000, script="stroke", clients="off")
    on = write(folder, "on", [])
    pushes = lambda: float(client.rows("ticks", last=1)["arm0_client_fx"][-1])
    push = client.push(ARM, lambda state: (0.7, 0, 0))
    check("a program pushes", until(lambda: pushes() == 0.7), pushes())
    answer = client.ask(do="reload", file=off)
    check("what a reload cannot change is named", answer.get("kept") == ["servo.rate", f"{ARM}: hand.script"], answer)
    check("and the permission is gone with the scene that gave it", until(lambda: pushes() == 0), pushes())
    check("whatever the program answers", largest(client, 20) == 0, largest(client, 20))
    try:
        push.end()
    except hapticd.HapticdError:
        pass
    check("who asks anew is refused", refused(lambda: client.lead_force(ARM), "does not let programs push"))
    answer = client.ask(do="reload", file=on)
    check("a scene as at the start has nothing that is kept", "kept" not in answer, answer)
    with client.push(ARM, lambda state: (0.7, 0, 0)):
        check("and gives the permission back", until(lambda: pushes() == 0.7), pushes())


def scene_without_an_arm(environment, folder):
    """A scene that names no arm has the default one, also for a daemon whose arm is another."""
    shutil.copy(os.path.join(SOURCE, "config", "devices", "simulated-premium15.yaml"), os.path.join(folder, "own-arm.yaml"))
    with open(os.path.join(folder, "no-arm.yaml"), "w") as file:
        file.write("hapticd: 1\nmodels:\n" + BALL.format(source=SOURCE, name="plain", x=0.1))
    with open(os.path.join(folder, "owner.yaml"), "w") as file:
        file.write("hapticd: 1\ndevice: own-arm.yaml\nmodels: []\n")
    log = os.path.join(folder, "owner.log")
    run = subprocess.Popen([HAPTICD, "run", os.path.join(folder, "owner.yaml"), "--name", "owner", "--log-file", log], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    atexit.register(run.kill)
    waited = subprocess.run([HAPTICD, "ctl", "--name", "owner", "--wait", "30", "status"], env=environment, capture_output=True, text=True, timeout=60)
    check("ctl waits for a daemon that starts", waited.returncode == 0 and '"ok": true' in waited.stdout, waited)
    absent = subprocess.run([HAPTICD, "ctl", "--name", "nobody", "--wait", "0.2", "status"], env=environment, capture_output=True, text=True, timeout=60)
    check("but not for ever", absent.returncode == 1 and all(words in absent.stderr for words in ("the daemon nobody does not run yet; waiting for it, at most 0.2 s", "no daemon named nobody runs", "these run: owner", "hapticd run SCENE --name nobody")), absent)
    done = subprocess.run([HAPTICD, "ctl", "--name", "owner", "add", os.path.join(folder, "no-arm.yaml")], env=environment, capture_output=True,
                          text=True, timeout=60)
    check("a scene that names no arm can be added", done.returncode == 0, done)
    with open(os.path.join(folder, "slip.yaml"), "w") as file:
        file.write("hapticd: 1\nmodels:\n" + BALL.format(source=SOURCE, name="slip", x=0.1).replace("sphere.yaml", "sphre.yaml"))
    done = subprocess.run([HAPTICD, "ctl", "--name", "owner", "add", os.path.join(folder, "slip.yaml")], env=environment, capture_output=True,
                          text=True, timeout=60)
    check("a misspelt file is told as check tells it", done.returncode == 2 and "there is no file /" in done.stderr and
          '(did you mean "sphere.yaml"?)' in done.stderr and "passed along" not in done.stderr, done)
    broken = os.path.join(folder, "broken.hpart")
    with open(os.path.join(SOURCE, "config", "models", "dm1.hpart"), "rb") as whole, open(broken, "wb") as part:
        part.write(whole.read(1000))
    with open(os.path.join(folder, "cut.yaml"), "w") as file:
        file.write(f"hapticd: 1\nmodels:\n  - {{name: cut, plugin: nurbs_rigid, parameters: {{geometry: {broken}}}}}\n")
    subprocess.run([HAPTICD, "ctl", "--name", "owner", "add", os.path.join(folder, "cut.yaml")], env=environment, capture_output=True, timeout=60)
    with open(log) as lines:
        told = [line for line in lines if "cut: " in line]
    check("the log names the file that a model could not be made of", told and all(broken in line and "/proc/" not in line for line in told), told)
    run.terminate()
    run.wait(timeout=30)


with tempfile.TemporaryDirectory(dir="/dev/shm") as scratch:
    environment = dict(os.environ, RUNTIME_DIRECTORY=scratch, STATE_DIRECTORY=scratch)
    machine = os.path.join(scratch, "machine.yaml")  # what it limits is no difference of a scene that is loaded again
    with open(machine, "w") as out:
        out.write("hapticd-daemon: 1\nlimits: {force: 8}\n")
    run = subprocess.Popen([HAPTICD, "--config", machine, "run", write(scratch, "empty", []), "--name", "changed"], env=environment,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    atexit.register(run.kill)
    until(lambda: os.path.exists(os.path.join(scratch, "changed.sock")), 30)
    with hapticd.connect("changed", folder=scratch) as client:
        around_the_tip(client, write(scratch, "ball", [("ball", 0.1)]))
        away_from_the_tip(client)
        sorted_lines(environment, client, scratch)
        client.ask(do="remove", model="ball")
        words_of_answers(client, scratch)
        permission(client, scratch)
        stopped(run, environment, client)
    run.send_signal(signal.SIGTERM)
    check("the run ends in order", run.wait(timeout=30) == 0)
    scene_without_an_arm(environment, scratch)
finish()
