#!/usr/bin/env python3
"""`hold` and `stop` wait behind no other work, and SIGTERM ends a run that a plugin keeps.

Usage: hold_test.py HAPTICD RIG.so ENDING_SHAPES.so     prints one line per check; exit 1 when one fails.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [here, os.path.join(here, "..", "..", "support"), os.path.join(here, "..", "..", "support", "rig")]
from daemon import Daemon, hear, say
from e2e import check, finish

HAPTICD, *MODULES = (os.path.abspath(argument) for argument in sys.argv[1:4])
PUSHES = "{name: pushes, plugin: ending}"


def daemon(*more):
    run = Daemon(HAPTICD, MODULES, [PUSHES, *more])
    check("a force comes", run.arm.wait_for_force())
    return run


run = daemon("{name: drawn, plugin: slow, parameters: {drawing: 0.2}}")
slow = run.write("slow", ["{name: late, plugin: slow, parameters: {setting_up: 4}}"])
adding = run.started("add", slow)
time.sleep(0.5)
clearing = run.connect()
say(clearing, do="clear", id=7)
time.sleep(0.1)
code, told = run.ctl("hold")
check("a hold does not wait for a model that is set up", code == 0 and adding.poll() is None and run.arm.silent_after(1) is not None,
      (code, told, adding.poll()))
check("the model comes all the same", adding.wait(60) == 0, adding.stdout.read())
answer = hear(clearing)
check("an older clear does not undo it", answer and answer["id"] == 7 and not answer["ok"] and answer["code"] == "held", answer)
check("the force stays off", run.arm.silent_after(1) is not None)
check("a newer clear does", run.ctl("clear")[0] == 0 and run.arm.wait_for_force())

crowd = [run.connect() for _ in range(40)]
for connection in crowd:
    say(connection, do="geometry", model="drawn")
time.sleep(0.2)
code, told = run.ctl("hold")
answered = [connection for connection in crowd if hear(connection, 0.001)]
check("a hold has a seat where 40 clients are busy", code == 0 and run.arm.silent_after(1) is not None and len(answered) < 30,
      (code, told, len(answered)))
for connection in crowd:
    connection.close()
run.ctl("clear", timeout=120)
check("later the force can come back", run.arm.wait_for_force())

several = run.connect()
say(several, do="geometry", model="drawn")
say(several, do="hold", id=1)
say(several, do="clear", id=2)
answers = [hear(several) for _ in range(3)]
check("one client's lines are answered in their order", [a and a.get("id") for a in answers] == [None, 1, 2] and answers[2]["ok"], answers)
check("and the last of them counts", run.arm.wait_for_force())
code, told = run.ctl("stop")
check("stop ends it", code == 0 and run.end()[0] == 0, (code, told))

run = daemon()
run.started("add", run.write("hang", ["{name: never, plugin: slow, parameters: {setting_up: 1000000}}"]))
time.sleep(0.5)
code, told = run.ctl("hold")
check("a hold does not wait for one that never ends", code == 0 and run.arm.silent_after(1) is not None, (code, told))
begun = time.monotonic()
run.process.terminate()
code, said = run.end(30)
check("SIGTERM ends the run all the same, and names what kept it", time.monotonic() - begun < 5 and "plugin 'slow' of model 'never' did not return" in said,
      (time.monotonic() - begun, said))
check("nobody is in quarantine for being slow", run.quarantined() == "")
check("the motors are off", not run.arm.motors_on())

with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w") as file:
        file.write("hapticd: 1\nmodels:\n  - {name: late, plugin: slow, parameters: {setting_up: 60}}\n")
    plugins = os.path.join(folder, "plugins")  # without the other test plugins: some of them hang while they are looked at
    os.mkdir(plugins)
    shutil.copy(MODULES[1], plugins)
    setting_up = subprocess.Popen([HAPTICD, "--plugin-path", plugins, "run", scene], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  env=dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder))
    time.sleep(1)
    setting_up.send_signal(signal.SIGINT)
    said = setting_up.communicate(timeout=30)[0]
check("Ctrl-C during set-up is told as a wish, with what was going on, and blames nobody",
      "ended as asked (SIGINT), while plugin 'slow' of model 'late' was in its activate()" in said and "warning" not in said, said)
finish()
