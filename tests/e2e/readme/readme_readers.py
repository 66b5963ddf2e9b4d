#!/usr/bin/env python3
"""What the README shows to a researcher with a shape, an engineer with an arm and a developer of an application, done.

Usage: readme_readers.py HAPTICD SOURCE_DIR CXX       exit 1 when one is off
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, write

HAPTICD, SOURCE, CXX = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
README = open(os.path.join(SOURCE, "README.md")).read()
SHAPES = open(os.path.join(SOURCE, "driver/docs/writing_a_shape.md")).read()
SCENES = open(os.path.join(SOURCE, "driver/docs/scenes.md")).read()


FLOOR = re.search(r"```cpp\n(#include <hapticd/shape.hpp>.*?)```", README, re.S)[1]
PUSHES = "report.flags |= HSP_R_PUSHES;"


def run(*command, environment=None, **more):
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=200, **more)
    return done.returncode, done.stdout + done.stderr


def built(folder, code):
    """Compiles a floor by the README's line. Returns what the compiler says; "": it is built."""
    write(folder, "floor.cpp", code)
    line = re.search(r"^    (g\+\+ .* -o my-plugins/floor.so)$", README, re.M)[1].replace("-I driver/include", f"-I {SOURCE}/driver/include")
    code, said = run("sh", "-c", line.replace("g++", CXX, 1), cwd=folder)
    return said[-800:] if code else ""


def syntax(folder, code, standard="c++20"):
    """What the compiler says of a source without building it; "": nothing."""
    file = write(folder, "syntax.cpp", code)
    code, said = run(CXX, f"-std={standard}", "-fsyntax-only", "-I", f"{SOURCE}/driver/include", file)
    return said[:1500] if code else ""


def own_shape(folder):
    """The floor of the README, compiled with its line, found, checked and felt in its scene."""
    os.mkdir(os.path.join(folder, "my-plugins"))
    said = built(folder, FLOOR)
    check("the README's floor compiles with the README's line", said == "", said)
    environment = dict(os.environ, HAPTICD_PLUGIN_PATH=os.path.join(folder, "my-plugins"))
    check("plugin list finds it", "floor" in run(HAPTICD, "plugin", "list", environment=environment)[1])
    code, said = run(HAPTICD, "plugin", "check", os.path.join(folder, "my-plugins/floor.so"), "--timeout", "60")
    check("plugin check passes it", code == 0, said)
    scene = re.search(r"^    hapticd: 1\n    hand:.*?\n    models:\n      - \{name: ground.*?\n", README, re.M)[0]
    file = write(folder, "floor.yaml", re.sub(r"^    ", "", scene, flags=re.M))
    report = os.path.join(folder, "report.json")
    code, said = run(HAPTICD, "run", file, "--for", "5", "--virtual-time", "--report", report, environment=environment)
    touched = os.path.exists(report) and json.load(open(report))["models"]["ground"]["contact_ticks"]
    check("check has nothing against it", "warning" not in run(HAPTICD, "check", file, environment=environment)[1])
    check("and it is felt in the README's scene", code == 0 and touched and touched > 100, (touched, said))
    wrong_sign(folder, file, environment)
    drives(folder, file, environment)
    forgets(folder, file, environment)
    shape_in_c(folder, environment)
    code, said = run(HAPTICD, "check", file, "--plugin-path", os.path.join(folder, "my-plugins"))
    check("--plugin-path may stand after the subcommand", code == 0, said)
    code, said = run(HAPTICD, "check", "--plugin-path", os.path.join(folder, "my-plugins"), file)
    check("and before the file", code == 0, said)


def wrong_sign(folder, file, environment):
    wrong, report = FLOOR.replace("stiffness * out.depth_m", "-stiffness * out.depth_m"), os.path.join(folder, "report.json")
    built(folder, wrong)
    code, said = run(HAPTICD, "plugin", "check", os.path.join(folder, "my-plugins/floor.so"), "--timeout", "60")
    check("with the wrong sign the check says so", code == 1 and "pull the hand in" in said, said)
    code, said = run(HAPTICD, "run", file, "--for", "2", "--virtual-time", "--report", report, environment=environment)
    pulled = json.load(open(report))["models"]["ground"]["force_n"]["max"]
    check("and the run silences it before it pulls with 2 N", "wrong sign" in said and pulled < 2, (pulled, said))
    check("and says when, with what force and how deep", re.search(r"at \d+\.\d+ s with [\d.]+ N at a depth of [\d.]+ mm", said), said)
    code, told = run(HAPTICD, "check", file, environment=environment)
    check("and check warns in the same words before any run", code == 0 and "models[0].plugin: warning: model ground: its plugin pulled the probe" in told
          and "its force has the wrong sign, although it reports to push only" in told, told)
    built(folder, wrong.replace(PUSHES, ""))
    code, unclaimed = run(HAPTICD, "run", file, "--for", "2", "--virtual-time", environment=environment)
    check("one that claims nothing pulls, and the run says so", re.search(r"warning   ground pulled the hand in during \d+ % of its contact", unclaimed), unclaimed)
    code, told = run(HAPTICD, "check", file, environment=environment)
    check("and check, too, without a word about the limits that such a pull meets", code == 0 and "cuts the force" not in told
          and re.search(r"models\[0\].plugin: warning: ground pulled the hand in during \d+ % of its contact", told), told)


def drives(folder, file, environment):
    """A damper of the wrong sign, in a shape that is stiff and in one that deforms."""
    driving = FLOOR.replace("stiffness * out.depth_m", "stiffness * out.depth_m + 5 * probe.velocity[1]").replace(PUSHES, "report.flags |= HSP_R_VELOCITY;")
    flesh = driving.replace('"A horizontal floor."', '"A horizontal floor.", HSP_C_DEFORMS')
    for name, code in (("a damper that drives is told by check", driving), ("also of a shape that deforms", flesh)):
        built(folder, code)
        code, told = run(HAPTICD, "check", file, environment=environment)
        check(name, flesh != driving and code == 0 and re.search(r"ground gave the hand \S+ mJ more than it took", told), told)


def forgets(folder, file, environment):
    """What a floor leaves out of its answer is told by the run."""
    depthless = re.sub(r"out\.depth_m", "depth", re.sub(r"out\.depth_m = ([^;]*);", r"const double depth = \1;", FLOOR, count=1))
    for name, code, words in (
            ("a floor that forgets HSP_OUT_TRACED is felt, and the run says so", FLOOR.replace("out.flags = HSP_OUT_TRACED;", ""),
             r"ground pushed in \d+ ticks without HSP_OUT_TRACED"),
            ("a floor that leaves depth_m at 0 and only pushes is silenced, and the run says why", depthless, "its depth_m was left at 0 inside"),
            ("one that claims nothing is felt, and the run says so", depthless.replace(PUSHES, ""), r"ground pushed in \d+ ticks with depth_m left at 0")):
        built(folder, code)
        said = run(HAPTICD, "run", file, "--for", "5", "--virtual-time", environment=environment)[1]
        check(name, re.search(words, said) and "touched no model" not in said, said)


def shape_in_c(folder, environment):
    new, line = re.search(r"^    hapticd (plugin new c_ball .*)\n    (gcc .* -o my-plugins/c_ball.so -lm)$", README, re.M).groups()
    code, said = run(HAPTICD, *new.split(), "--dir", os.path.join(folder, "c_ball"))
    check("the README's shape in C is written", code == 0, said)
    line = line.replace("my-plugins", os.path.join(folder, "my-plugins")).replace(" c_ball/", f" {folder}/c_ball/")
    code, said = run("sh", "-c", line.replace("gcc", "cc", 1), cwd=SOURCE)
    check("the README's shape in C compiles with its line", code == 0, said[-800:])
    code, said = run(HAPTICD, "plugin", "check", os.path.join(folder, "my-plugins/c_ball.so"), "--timeout", "60")
    check("and passes the check", code == 0, said)
    check("and is found", "c_ball" in run(HAPTICD, "plugin", "list", environment=environment)[1])


def other_sources(folder):
    """The floor of the manual page, slips that the compiler names, and the table lines of writing_a_shape.md in a plugin."""
    page = open(os.path.join(SOURCE, "driver/docs/man/hapticd-shape.7")).read().split(".SH EXAMPLE\n.nf\n")[1].split("HAPTICD_SHAPES(Floor)")[0]
    page = page.replace("\\-", "-") + "HAPTICD_SHAPES(Floor)\n"
    said = syntax(folder, page)
    check("the manual page's floor compiles, and claims to push only", said == "" and "HSP_R_PUSHES" in page, said)
    said = syntax(folder, FLOOR.replace("hsp_status touch(", "hsp_status tuoch("))
    check("a misspelt touch() is named", "neither hsp_status touch" in said, said)
    said = syntax(folder, page, "c++17")
    check("an old standard is named", "-std=c++20" in said, said)
    block = re.search(r"```cpp\n(    F::choice.*?)```", SHAPES, re.S)[1]
    members = "  int law = 0;\n  std::vector<double> profile;\n  std::array<double, 3> axis{};\n  std::string heights;\n"
    code = FLOOR.replace("  double stiffness = 0;\n", "  double stiffness = 0;\n" + members + '  static constexpr const char* kLaws[] = {"linear", "table"};\n')
    said = syntax(folder, code.replace("return std::array{F::real(", "return std::array{\n" + re.sub(r"//.*", "", block) + "F::real("))
    check("the other lines of a table compile", said == "", said)


def twin_of_an_arm(folder):
    """The twin that the guide to devices shows presses the sphere."""
    page = open(os.path.join(SOURCE, "driver/docs/devices.md")).read()
    file, report = os.path.join(folder, "twin.yaml"), os.path.join(folder, "twin.json")
    open(file, "w").write(re.search(r"### A twin of.*?```yaml\n(.*?)```", page, re.S)[1])
    code, said = run(HAPTICD, "check", file)
    check("the twin of the guide is in order", code == 0 and "warning" not in said, said)
    code, said = run(HAPTICD, "run", os.path.join(SOURCE, "config/scenes/sphere.yaml"), "--device", file, "--for", "3", "--virtual-time", "--report", report)
    touched = os.path.exists(report) and json.load(open(report))["models"]["sphere"]["contact_ticks"]
    check("and presses the sphere", code == 0 and touched and touched > 100, (touched, said))


def own_scene(folder):
    """The scenes that the README and the guide to scenes ask a reader to save."""
    for name, page in (("README", README), ("guide", SCENES)):
        scene = re.search(r"Save this as `config/scenes/mine.yaml`:\n\n((?:    .*\n)+)", page)[1]
        file, report = os.path.join(folder, f"{name}.yaml"), os.path.join(folder, f"{name}.json")
        open(file, "w").write(re.sub(r"^    ", "", scene, flags=re.M).replace("../", os.path.join(SOURCE, "config") + "/"))
        code, said = run(HAPTICD, "check", file)
        check(f"check has nothing against the scene of the {name}", code == 0 and "warning" not in said, said)
        code, said = run(HAPTICD, "run", file, "--for", "5", "--virtual-time", "--report", report)
        check("and its hand touches the teapot", code == 0 and json.load(open(report))["models"]["teapot"]["contact_ticks"] > 100, said)
    shown = set(re.findall(r"`([\w/-]+)`", SCENES.split("## The scenes that ship")[1]))
    folder = pathlib.Path(SOURCE, "config/scenes")
    there = {str(file.relative_to(folder).with_suffix("")) for file in folder.rglob("*.yaml")}
    there -= {"mine"}  # the scene that the README lets its reader save there
    check("the guide lists every scene that ships, and no other", there == shown, there ^ shown)


CLIENT = r"""
set -eu
until hapticd ctl --name reader status >/dev/null 2>&1; do sleep 0.2; done
hapticd ctl --name reader get ball stiffness
hapticd ctl --name reader set ball stiffness 300 --consent
hapticd ctl --name reader get ball stiffness
hapticd ctl --name reader disable ball
hapticd ctl --name reader list
hapticd ctl --name reader stop
"""


def own_client(folder):
    """A shell script that leads a run by what `ctl --help` and the README say."""
    scene = os.path.join(folder, "client.yaml")
    model = os.path.join(SOURCE, "config/models/sphere.yaml")
    open(scene, "w").write(f"hapticd: 1\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {model}, stiffness: 400}}}}\n")
    environment = dict(os.environ, RUNTIME_DIRECTORY=folder, STATE_DIRECTORY=folder, PATH=os.path.dirname(HAPTICD) + ":" + os.environ["PATH"])
    daemon = subprocess.Popen([HAPTICD, "run", scene, "--name", "reader", "--for", "100"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    code, said = run("bash", "-c", CLIENT, environment=environment)
    check("a shell client reads, sets and stops", code == 0 and '"value": 400' in said and '"value": 300' in said and '"enabled": false' in said, said)
    try:
        daemon.wait(30)
    except subprocess.TimeoutExpired:
        daemon.kill()
    check("and the run ends well", daemon.returncode == 0, daemon.stderr.read()[-500:])
    program_of_the_readme(environment)
    for word in ("status", "list", "socket", "get", "set", "enable", "move", "add", "events", "stop", "hold", "geometry", "reload"):
        code, said = run(HAPTICD, "ctl", word, "--help")
        check(f"ctl {word} --help has an example of its own", code == 0 and re.search(r"Example:\n  hapticd ctl (--name left )?" + word, said), said[-300:])


def program_of_the_readme(environment):
    """The README's lines of a shell and of Python, beside its run."""
    part = README.split("## Write a program")[1].split("\n## ")[0]
    scene = re.search(r"hapticd run (\S+)", part)[1]
    code = re.sub(r"^    ", "", re.search(r"^    python3 -c '\n(.*?)'\n", part, re.M | re.S)[1], flags=re.M)
    move = re.search(r"^    (hapticd ctl move .*)$", part, re.M)[1]
    said = run(HAPTICD, "check", os.path.join(SOURCE, scene))
    check("the scene for programs is in order", said[0] == 0 and "warning" not in said[1], said)
    daemon = subprocess.Popen([HAPTICD, "run", scene, "--for", "100"], cwd=SOURCE, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    begin = daemon.stderr.readline()
    while begin and "runs as" not in begin:
        begin = daemon.stderr.readline()
    check("a run begins with its name, models, arm, and that programs may push",
          "runs as hapticd: model ball on simulated Premium 1.5; programs may push (clients: add); socket /" in begin, begin)
    said = run("bash", "-c", move, environment=environment)
    check("the README's move is obeyed", said[0] == 0 and '"ok": true' in said[1], said)
    said = run(sys.executable, "-c", code.replace("sleep(5)", "sleep(1)"),
               environment=dict(environment, PYTHONPATH=os.path.join(SOURCE, "driver/doors/client/python")))
    check("and its program in Python reads and pushes", said[0] == 0 and said[1].startswith("800.0 "), said)
    daemon.terminate()
    rest = daemon.communicate(timeout=30)[1]
    check("the log tells of the push", "pushes on it" in rest, rest)


def own_arm(folder):
    """An arm of the reader's invention: the README's commands, and one of its fields in a layout of another width."""
    shown = re.search(r"^    (hapticd device new my-arm[^#]*?) *#", README, re.M)[1]
    path = dict(os.environ, PATH=os.path.dirname(HAPTICD) + ":" + os.environ["PATH"])
    code, said = run("sh", "-c", shown + " </dev/null", environment=path, cwd=folder)
    check("device new writes the README's arm", code == 0 and os.path.exists(os.path.join(folder, "my-arm.yaml")), said)
    trip = re.search(r"^    (echo .* \| hapticd device encode .*)$", README, re.M)[1]
    code, said = run("sh", "-c", trip, environment=path, cwd=folder)
    check("and its numbers go to bytes and back", code == 0 and ",good,0.09990" in said, said)
    for words in ("hapticd check config/scenes/sphere.yaml --device", "hapticd device twin", "hapticd run config/scenes/sphere.yaml --device"):
        line = re.search(rf"^    ({words} [^#\n]*?) *(#.*)?$", README, re.M)[1].replace("config/scenes", os.path.join(SOURCE, "config/scenes"))
        code, said = run("sh", "-c", line.replace("--for 10", "--for 3 --virtual-time --report twin.json"), environment=path, cwd=folder)
        check(f"{words} works with the README's arm", code == 0, said)
    report = os.path.join(folder, "twin.json")
    touched = os.path.exists(report) and json.load(open(report))["models"]["sphere"]["contact_ticks"]
    check("whose twin presses the sphere", touched and touched > 100, touched)
    field = re.search(r"`(\{is: position, joint: 1, at: 2, type: i24, scale: 1.7e-5\})`", README)[1]
    text = open(os.path.join(folder, "my-arm.yaml")).read()
    text = re.sub(r"\{is: position, joint: 1, .*?\}", field, text)
    open(os.path.join(folder, "my-arm.yaml"), "w").write(text)
    counts = [100000, -5, 77]
    report = (7).to_bytes(2, "little") + b"".join((c & 0xFFFFFF).to_bytes(3, "little") for c in counts) + b"\1"
    open(os.path.join(folder, "capture.txt"), "w").write(report.hex(" ") + "\n")
    code, said = run("sh", "-c", "hapticd device decode my-arm.yaml capture.txt", environment=path, cwd=folder)
    check("a capture shows the joint of the README's field", code == 0 and ",good,1.7," in said and ",1,7," in said, said)


with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
    own_scene(folder)
    own_shape(folder)
    own_arm(folder)
    other_sources(folder)
    twin_of_an_arm(folder)
    own_client(folder)
finish()
