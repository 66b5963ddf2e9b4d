#!/usr/bin/env python3
"""`hapticd device check`, `check`, `doctor` and `run` name the slips of a device module, each before a force flows.

Usage: device_check.py HAPTICD SOURCE_DIR MODULE_FOLDER PLUGIN_FOLDER     exit 1 when one is off
"""
import json
import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, program, write

HAPTICD, SOURCE, MODULES, PLUGINS = sys.argv[1:5]
run, folder = program(HAPTICD, together=True), tempfile.mkdtemp()
os.environ["HAPTICD_PLUGIN_PATH"] = ":".join((MODULES, PLUGINS, os.path.join(os.path.dirname(PLUGINS.rstrip("/")), "devices")))
os.environ["XDG_STATE_HOME"] = folder


def put(name, text):
    return write(folder, name, text)


def arm(slip):
    return put(slip + ".yaml", f"hapticd-device: 1\nmodule: slips_arm\nlimits: {{force: 3}}\nparameters: {{slip: {slip}}}\n")


def examined(slip, *more):
    code, text = run("device", "check", arm(slip), "--json", *more)
    try:
        return code, {t["name"]: (t["result"], t["what"]) for t in json.loads(text[: text.rindex("}") + 1])["tests"]}
    except ValueError:
        return code, {"": ("", text)}


code, tests = examined("none")
check("an arm without a slip passes", code == 0 and len(tests) == 8 and all(r in ("ok", "skip") for r, _ in tests.values()), (code, tests))
code, tests = examined("absent")
check("of an arm that is absent the kinematics are tried", code == 0 and tests["kinematics"][0] == "ok" and tests["open"][0] == "skip", tests)

scene = put("scene.yaml", f"hapticd: 1\ndevice: {os.path.basename(arm('absent'))}\nmodels: []\n")
code, text = run("run", scene, "--virtual-time", "--for", "0.2")
check("an absent arm in virtual time is told that only simulated ones run so", code not in (0, -11) and "no arm on the bus" in text and "--virtual-time allows simulated" in text, (code, text[-400:]))

# What no run may begin with: the same is said by check, doctor and run.
REFUSED = {
    "no_joints": ("kinematics", "joint_count"),
    "no_jacobian": ("kinematics", "without a function jacobian"),
    "jacobian_sign": ("kinematics", "not the derivative"),
    "jacobian_beyond": ("kinematics", "beyond the 12 numbers"),
    "jacobian_status": ("kinematics", "HSP_E_NUMERIC"),
    "orientation_0": ("kinematics", "length 0"),
    "forward_nan": ("kinematics", "not finite"),
    "far": ("kinematics", "the position must be in m"),
    "weight_nan": ("kinematics", "gravity()"),
}
OPENED = {
    "forward_status": ("open", "HSP_E_NUMERIC"),
    "forward_nan_at_stop": ("open", "not finite"),
    "info_joints": ("open", "3 joints, but its kinematics have 2"),
    "product": ("open", "hdv_info.product"),
    "buttons": ("open", "99 buttons"),
    "weight": ("open", "asks joint 1 for 50 N m"),
}
for slip, (test, words) in {**REFUSED, **OPENED}.items():
    code, tests = examined(slip)
    result, what = tests.get(test, ("", tests))
    check(f"{slip} fails by {test}", code == 1 and result == "fail" and words in what, (code, tests))
    scene = put("scene.yaml", f"hapticd: 1\ndevice: {slip}.yaml\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 300}}}}\n")
    code, text = run("run", scene, "--virtual-time", "--for", "0.2")
    check(f"{slip}: run refuses it", code not in (0, -11) and words in text, (code, text[-400:]))
    check(f"{slip}: and does not blame the virtual time", "--virtual-time allows" not in text, text[-400:])
    if slip in REFUSED:
        for file in (arm(slip), scene):
            code, text = run("check", file)
            check(f"{slip}: check {os.path.basename(file)} tells", code == 2 and words in text and "slips_arm" in text, (code, text))
        code, text = run("doctor", arm(slip), "--seconds", "0")
        check(f"{slip}: doctor tells", code == 2 and words in text, (code, text[-400:]))

# Crashes and hangs name the module and the call.
for slip, words in (("jacobian_crash", "crashed: Segmentation fault, in jacobian()"), ("jacobian_hangs", "in jacobian()")):
    code, tests = examined(slip, "--timeout", "1")
    check(f"{slip} is named", code == 1 and words in tests["kinematics"][1], tests)
code, text = run("check", arm("jacobian_crash"))
check("check survives a crash", code == 2 and "slips_arm" in text and "in jacobian()" in text, (code, text))

# What only samples show.
for slip, test, words, *more in (
        ("sequence", "samples", "sequence does not grow"),
        ("read_nan", "samples", "position[1] is not a finite number"),
        ("read_beyond", "samples", "in read(): it writes byte 408 of the hdv_sample"),
        ("read_heap", "samples", "byte 32 of a block of 32 bytes"),
        ("read_status", "samples", "HSP_E_IO"),
        ("read_hangs", "samples", "in read()", "--timeout", "1"),
        ("stop_hangs", "samples", "in stop()", "--timeout", "1"),
        ("off_pushes", "off", "HDV_OFF"),
        ("read_allocates", "no-allocation-in-read", "DeviceClass<SlipsArm>::read"),
        ("read_prints", "no-system-call-in-read", "prints"),
        ("read_sleeps", "no-system-call-in-read", "sleeps"),
        ("claims_pacing", "claims", "HDV_C_PACING"),
        ("claims_torque", "samples", "HDV_C_TORQUE"),
        ("inverse_mirrored", "kinematics", "inverse()"),
        ("inverse_nan", "kinematics", "inverse()"),
        ("inverse_refuses", "kinematics", "the module cannot tell which joint positions bring the tip to a place"),
        ("inverse_anywhere", "kinematics", "says HSP_OK for")):
    code, tests = examined(slip, *more)
    result, what = tests.get(test, ("", tests))
    check(f"{slip} fails by {test}", code == 1 and result == "fail" and words in what, (code, tests))
for slip, test, words in (("forgets", "claims", "hdv_info.max_torque is 0 for all joints"), ("forgets", "claims", "position_min and position_max are 0 for all joints"),
                          ("fast", "claims", "rate_hz"), ("read_microseconds", "samples", "more than 0.1 s behind now_ns"), ("no_angular_rows", "kinematics", "rows 3 to 5"), ("weight_pulls", "kinematics", "pull the tip down"),
                          ("weight_aside", "kinematics", "push the tip aside and never up, if gravity is along x"),
                          ("weight_in_grams", "claims", "the torques of gravity() are more than the motors give")):
    code, tests = examined(slip)
    check(f"{slip} is warned of", code == 0 and tests[test][0] == "warn" and words in tests[test][1], (code, tests))
code, tests = examined("weight_right")
check("the weight that an arm has is nothing to be told", code == 0 and all(r in ("ok", "skip") for r, _ in tests.values()), tests)
for slip, words in (("weight_pulls", "pull the tip down"), ("forward_nan_aside", "not finite at")):
    code, text = run("check", arm(slip))
    check(f"check warns of {slip}", code == 0 and "warning" in text and words in text, (code, text))

# What hangs after the last tick ends the run, with its name.
scene = put("scene.yaml", f"hapticd: 1\ndevice: {os.path.basename(arm('stop_hangs'))}\nmodels:\n  - {{name: ball, plugin: nurbs_rigid, parameters: {{geometry: {SOURCE}/config/models/sphere.yaml, stiffness: 300}}}}\n")
for pace in (["--virtual-time"], ["--allow-non-rt"]):
    code, text = run("run", scene, *pace, "--for", "0.1")
    check(f"a stop() that hangs does not keep a run {pace}", code not in (0, 124) and "stop()" in text and "slips_arm" in text, (code, text))
stalls = put("scene.yaml", open(scene).read().replace("stop_hangs", os.path.basename(arm("read_stalls"))[:-5]))
code, text = run("run", stalls, "--allow-non-rt", "--for", "3")
crashes = put("scene.yaml", open(stalls).read().replace("read_stalls", os.path.basename(arm("read_crashes"))[:-5]))
ended, said = run("run", crashes, "--allow-non-rt", "--for", "3")
check("a module that crashes a run is to be examined", ended == 1 and f"repair the module; hapticd device check {MODULES}" in said and "slips_arm.so" in said, (ended, said))
check("a read() that stalls is told of its module", "its module did not return" in text and "hapticd device check" in text and "doctor" not in text, (code, text))
code, text = run("device", "check", arm("forgets"))
check("warnings are counted", text.rstrip().endswith("8 tests, 0 failed, 1 warning"), text)
code, text = run("device", "info", arm("forgets"))
check("device info says what is unknown", "joint 1: range unknown, no bound of its motor is known" in text, text)
code, text = run("device", "info", arm("none"))
check("and the unit of each joint", "joint 1: -1 to 1 rad, its motor up to 1 N m\n" in text, text)
sleeps = put("scene.yaml", open(scene).read().replace("read_crashes", os.path.basename(arm("read_sleeps"))[:-5]))
code, text = run("run", sleeps, "--allow-non-rt", "--for", "4")
check("a read() that sleeps is told as the cause of late ticks", "ticks come late because of the arms: read() and write() of their modules take" in text
      and "hapticd device check FILE" in text, (code, text))
code, text = run("check", arm("inverse_mirrored"))
check("check warns of a wrong inverse", code == 0 and "warning" in text and "the module cannot tell which joint positions" in text and "inverse()" in text, (code, text))

# Tests that were skipped were not run.
code, text = run("device", "check", f"{SOURCE}/config/devices/sarcos.yaml")
if "skip  open" in text:  # no machine of ours has this arm
    check("what was skipped counts as not run", "1 test, 0 failed, 7 not run: they need the arm" in text, (code, text))

# A module alone; the modules that ship.
code, text = run("device", "check", os.path.join(MODULES, "slips_arm.so"))
check("a module file is tried with its defaults", code == 0 and "8 tests, 0 failed" in text, (code, text))
code, text = run("device", "check", os.path.join(PLUGINS, "nurbs_rigid.so"))
check("a plugin of shapes is sent to plugin check", code == 2 and "hapticd plugin check" in text, (code, text))
for name in ("config/devices/simulated-premium15", "config/devices/simulated-sarcos", "devices/template/arm"):
    file = f"{SOURCE}/{name}.yaml"
    if os.path.exists(file):
        code, text = run("device", "check", file)
        check(f"{name} passes", code == 0, (code, text))
finish()
