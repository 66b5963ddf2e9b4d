#!/usr/bin/env python3
"""`hapticd plugin check`: every plugin that ships passes, and broken ones fail by the test that names what is wrong.

Usage: check_plugins.py HAPTICD SOURCE_DIR SHIPPED_FOLDER BROKEN_FOLDER TEST_SHAPES.so     exit 1 when one is off
"""
import glob
import json
import os
import re
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import LONG, check, finish, program

HAPTICD, SOURCE, SHIPPED, BROKEN, SHAPES = sys.argv[1:6]
hapticd = program(HAPTICD)


def examined(file, *more):
    done = hapticd("plugin", "check", file, "--json", *more)
    try:
        tests = json.loads(done.stdout)["tests"]
    except ValueError:
        tests = []
    failed = {(t["plugin"], t["name"]) for t in tests if t["result"] == "fail"}
    return done.returncode, tests, failed, done.stderr


shipped = sorted(glob.glob(os.path.join(SHIPPED, "*.so")))
check("plugins ship", len(shipped) >= 4, shipped)
# Several surfaces (the teapot has 32): what a search told one probe reached another that came there, by 11 N.
SURFACES = "geometry=" + os.path.join(SOURCE, "config", "models", "teapot.yaml" if LONG else "goblet.yaml")
RUBS = ("--set", "friction_static=0.4", "--set", "friction_dynamic=0.3")  # a stuck point outlived a jump: 0.16 N
NURBS = os.path.join(SHIPPED, "nurbs_rigid.so")
BODY = os.path.join(SHIPPED, "mat_deformable.so")  # the pebble drove a hand that strokes it, the lump one that leaves over it
FLESH = [(BODY, "--set", "geometry=" + os.path.join(SOURCE, "config", "models", model + ".yaml"), "--set", "dynamics=" + dynamics)
         for model in ("pebble", "palpation") for dynamics in ("off", "felt")]
for file, *more in [(file,) for file in shipped] + [(NURBS, "--set", SURFACES), (NURBS, *RUBS)] + FLESH:
    code, tests, failed, err = examined(file, "--timeout", "120", *more)  # a loaded machine is no hang
    why = [(t["plugin"], t["name"], t["why"]) for t in tests if t["result"] == "fail"]
    check(f"{os.path.basename(file)} {' '.join(more)} passes", len(tests) >= 25 and not failed, (code, why, err[-300:]))

for name, test in (("bad_crash", "descriptor-complete"), ("bad_no_symbol", "descriptor-complete"),
                   ("bad_magic", "descriptor-complete"), ("bad_no_step", "descriptor-complete")):
    code, tests, failed, err = examined(os.path.join(BROKEN, name + ".so"))
    check(f"{name} fails by {test}", code == 1 and any(t == test for _, t in failed), (code, failed, err[-300:]))

# JSON is UTF-8, whatever the bytes of a file's name: what can't be read in them is replaced.
with tempfile.TemporaryDirectory() as folder:
    odd = os.path.join(os.fsencode(folder), b"\xff.so")
    shutil.copy(os.path.join(BROKEN, "bad_no_symbol.so"), odd)
    code, tests, failed, err = examined(odd)
    check("a file whose name is not UTF-8 is checked like others", code == 1 and any(t == "descriptor-complete" for _, t in failed), (code, failed, err[-300:]))

code, tests, failed, err = examined(SHAPES)
for shape, test in (("allocating", "no-allocation-in-step"), ("rude", "no-lock-in-step"), ("misbehaving", "finite-outputs"),
                    ("pulling", "force-outward")):
    check(f"{shape} fails by {test}", code == 1 and (shape, test) in failed, (code, sorted(failed), err[-300:]))

# A wrong sign is found wherever the shape can be touched, whatever its size; and each lack by the test that names it.
code, tests, failed, err = examined(os.path.join(BROKEN, "wrong_signs.so"), "--timeout", "60")
WRONG = {"ring_right": None, "ball_right": None, "floor_right": None, "ring_steps": "force-from-zero", "ring_steps_far": "force-from-zero", "ring_no_contact": "contact-flags",
         "ring_no_traced": "contact-flags", "ring_no_claim": "stiffness-vs-claim", "ring_small_claim": "stiffness-vs-claim",
         "bad_id": "descriptor-complete", "ring_silent": "contact-found", "ring_never_deep": "contact-found"}
WRONG.update({shape + "_pulls": "force-outward" for shape in ("ring", "large_ring", "ball", "middle_ball", "large_ball", "far_ball", "floor")})
WRONG["ring_pulls_inside"] = "force-outward"
WRONG.update({"box_right": None, "box_left_pulls": "force-outward", "box_under_pulls": "force-outward"})  # one side of six
WRONG.update({"box_damps": None, "ring_damps": None, "box_drives": "damping-sign", "ring_damper_pulls": "damping-sign"})
for shape, test in WRONG.items():
    mine = {t for p, t in failed if p == shape}
    check(f"{shape}: {test or 'passes'}", {t["plugin"] for t in tests} >= {shape} and (test in mine if test else not mine), mine)
why = [t["why"] for t in tests if (t["plugin"], t["name"]) == ("ring_pulls", "force-outward")]
check("the sign is named, with depth and force", all(w in why[0] for w in ("sign", "0.5 N", "depth of 1 mm", "turn the sign")), why)
damped = {t["plugin"]: t for t in tests if t["name"] == "damping-sign"}
check("a damper that drives is told by depth, speed and force", "at 1 mm, moving out at 0.3 m/s it pushes 2 N more than moving in: the sign of the damping is wrong"
      in damped["box_drives"]["why"], damped["box_drives"])
check("a damper that pulls gets a message with the fix", all(w in damped["ring_damper_pulls"]["why"] for w in ("at 0.3 m/s outward it pulls with", "clamp the force at zero")),
      damped["ring_damper_pulls"])
check("a right damper is tested", [damped[shape]["result"] for shape in ("box_damps", "ring_damps")] == ["pass", "pass"], damped)
for shape in ("ring_right", "ball_right", "floor_right"):
    skipped = [t["name"] for t in tests if t["plugin"] == shape and t["result"] == "skip"]
    check(f"{shape}: nothing about contact is skipped", not {"force-outward", "force-continuous", "contact-flags", "stiffness-vs-claim"} & set(skipped), skipped)
untested = [t["why"] for t in tests if (t["plugin"], t["name"]) == ("ring_silent", "contact-found")]
check("what was never touched is said to be untested", "NOT TESTED" in untested[0], untested)

# A hang is found once: not by each of 26 tests in turn.
done = hapticd("plugin", "check", os.path.join(BROKEN, "hanging.so"), "--timeout", "1.5")
check("a plugin that hangs fails", done.returncode == 1 and "took longer than 1.5" in done.stdout, done.stdout)
check("only once, and the rest is not run", done.stdout.count("took longer") == 1 and "stopped at the first hang" in done.stdout, done.stdout)
code, tests, failed, err = examined(os.path.join(BROKEN, "hanging.so"), "--timeout", "1")
check("as JSON too", code == 1 and len(failed) == 1, failed)

# Slow steps are told by their time, not by a test of something else that takes too long for it.
for microseconds, least in ((100, 0.1), (5000, 5)):
    file = os.path.join(BROKEN, f"sleeping_{microseconds}.so")
    code, tests, failed, err = examined(file)
    why = [t["why"] for t in tests if t["result"] == "fail"]
    check(f"usleep({microseconds}) fails by its time alone", code == 1 and [t for _, t in failed] == ["steps-end-in-time"], (failed, why))
    took = float(re.search(r"takes about ([0-9.e+]+) ms a step", why[0])[1])
    check("and says how long, and that it waits", took >= least and "waits in" in why[0], why)

# One slip each, told by the test that names it, with the place, the amount, and the cure.
code, tests, failed, err = examined(os.path.join(BROKEN, "slips.so"), "--timeout", "15")
SLIPS = {"prints": ("no-system-call-in-step", "it prints in"), "asks": ("no-system-call-in-step", "system calls (number"),
         "reads_velocity": ("asks-for-what-it-reads", "report.flags |= HSP_R_VELOCITY in activate()"),
         "millimetres": ("force-continuous", "look for a length that is not in m"),
         "throws": ("steps-end-in-time", "it threw an exception: vector::_M_range_check"),
         "crashes": ("steps-end-in-time", "Segmentation fault, in step() with the probe at "),
         "nan": ("finite-outputs", "contact.force[1] is "),
         "shares": ("determinism-bitwise", "static or global variables"),
         "no_invalid": ("bad-sample", "return HSP_OK"), "computes": ("steps-end-in-time", "all of it computing"),
         "leaks": ("create-destroy-leak", "bytes in each life, from create() to destroy()"),
         "claims": ("step-cost-vs-claim", "the claimed worst is 1 (report.worst_ns)"),
         "allocates": ("no-allocation-in-step", "::keepDepth"),
         "four_places": ("eight-probes", "it reads or writes byte 128 of a block of 128 bytes; with 8 probes"),
         "four_shared": ("eight-probes", "of eight in one step gets another force than alone"),
         "depth_mm": ("depth-falls-outward", "depth_m changes by 1000 m where the probe moves by 1 m along the normal"),
         "foot_mm": ("depth-falls-outward", "times as far from the probe as depth_m says"),
         "flat_outside": ("depth-falls-outward", "depth_m is 0 outside of the shape"),
         "locks": ("no-lock-in-step", "another thread that holds the lock would make the servo wait"),
         "clicks": ("deep-press", "the force jumps by 2.05 N within 100 um at a depth of 3.1 mm"),
         "torque_at_once": ("force-from-zero", "the torque jumps by 0.3 N m where the surface is met"),
         "live_path": ("descriptor-complete", 'parameter "file": it is a path, a text or a list and has HSP_P_LIVE'),
         "crashes_early": ("activate", "it crashed: Segmentation fault, in activate()"),
         "one_member": ("param-roundtrip", "expected a member of its own for each line of the table")}
for shape, (test, words) in SLIPS.items():
    mine = [t for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    check(f"{shape} fails by {test} first", mine and mine[0]["name"] == test and words in mine[0]["why"], mine)
for shape in ("throws", "crashes", "nan", "shares", "computes", "asks", "no_invalid", "reads_velocity", "leaks", "claims", "allocates", "four_places", "four_shared", "flat_outside", "locks", "clicks", "live_path", "crashes_early", "torque_at_once"):
    mine = [t["name"] for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    check(f"{shape} fails by one test alone", len(mine) == 1, mine)
inward = {t["name"]: t["why"] for t in tests if t["plugin"] == "normal_inward" and t["result"] == "fail"}
check("a normal that points inward is told, not the force that follows it", "turn the sign of normal first" in inward.get("force-outward", ""), inward)
leak = [t["why"] for t in tests if t["plugin"] == "leaks" and t["result"] == "fail"][0]
check("a leak is told by its size", 1000 <= float(re.search(r"about ([0-9]+) bytes", leak)[1]) < 1100, leak)
for shape in ("right", "unit", "sawtooth", "sawtooth_late", "vibrates", "live", "steepens", "filters"):  # sawtooth: memory that comes and goes is no leak; vibrates: a claimed jump is no stiffness
    check(f"{shape} passes", not [t for p, t in failed if p == shape], failed)
unit = [t for t in tests if t["plugin"] == "unit" and t["result"] == "warn"]
check("a unit that is not SI is warned of", len(unit) == 1 and 'the unit is "N/mm", expected m for mm' in unit[0]["why"], unit)
live = [t for t in tests if t["plugin"] == "live" and t["result"] == "warn"]
check("a stiffness that may change without consent is warned of", len(live) == 1 and "expected HSP_P_LIVE | HSP_P_SAFETY" in live[0]["why"], live)
check("no other shape is warned of", {t["plugin"] for t in tests if t["result"] == "warn"} == {"unit", "live", "steepens", "foot_mm"})
steep = {t["name"]: t["why"] for t in tests if t["plugin"] == "steepens"}
check("a law that turns steep below the surface is warned of", "at a depth of 2." in steep["deep-press"] and "its force grows by" in steep["deep-press"], steep)
measured = [t["why"] for t in tests if (t["plugin"], t["name"], t["result"]) == ("right", "stiffness-vs-claim", "pass")]
check("what was measured stands beside the claim", measured == ["it claims 500 N/m, and its force grows by 500 N/m at most"], measured)
said = hapticd("plugin", "check", "slips.so", "--timeout", "15", cwd=BROKEN).stdout
check("a bare name finds the same locks", "another thread that holds the lock would make the servo wait" in said, said[-500:])
jump = [t["why"] for t in tests if (t["plugin"], t["name"]) == ("millimetres", "force-continuous")][0]
check("a jump has its place in m and its size in N", re.search(r"^at [-0-9.e, ]+ m: the force jumped by [0-9.e+]+ N while", jump), jump)
for shape in ("throws", "no_invalid", "allocates"):
    why = [t["why"] for t in tests if t["plugin"] == shape and t["result"] == "fail"][0]
    check(f"{shape}: the place of the probe is told", re.search(r"at [-0-9.e]+, [-0-9.e]+, [-0-9.e]+ m", why), why)
check("an exception is told once, and the rest is counted", said.count("vector::_M_range_check") == 1 and "tests were not run: first fix steps-end-in-time" in said, said)
check("a number that is not one is told alone", "nan J" not in said and "-0 N at" not in said, said)

# A force, a foot or a normal that goes astray by a little, and what is honest though it rubs, damps, clicks or pulls.
code, tests, failed, err = examined(os.path.join(BROKEN, "strays.so"), "--timeout", "60")
STRAYS = {"swirls": ("force-along-normal", "lies 11.3099 degrees off its normal; expected force = normal times a size"),
          "swirls_unsaid": ("loops-give-no-energy", "a hand that moves in loops would be driven"),
          "swirls_round": ("loops-give-no-energy", "along below the surface, and out gave"),
          "swirls_a_little": ("loops-give-no-energy", "along below the surface, and out gave"),
          "foot_off": ("foot-and-normal", "point is not on the surface: a probe at the point that is named"),
          "foot_slipped": ("foot-and-normal", "expected the nearest point of the surface"),
          "normal_tilted": ("foot-and-normal", "degrees off the line from point to the probe"),
          "depth_short": ("foot-and-normal", "outside, depth_m is minus the distance to point"),
          "pulls_outside": ("force-outward", "reports to push only (HSP_R_PUSHES), and pulls with 0.2 N, "),
          "allocates_deep": ("no-allocation-in-step", "allocations in"),
          "snaps_on": ("jump-flag", "expected that the shape forgets the state of a probe at HSP_IN_JUMP"),
          "told_wrong": ("stiffness-vs-claim", "contact.stiffness is -500 N/m, but the force grows by 500 N/m there")}
for shape, (test, words) in STRAYS.items():
    mine = [(t["name"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    check(f"{shape} fails by {test} first", mine and mine[0][0] == test and words in mine[0][1], mine)
for shape in ("straight", "rubs", "drags", "magnet", "snaps"):
    mine = [(t["name"], t["result"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] in ("fail", "warn")]
    check(f"{shape} passes", {t["plugin"] for t in tests} >= {shape} and not mine, mine)
over = [(t["name"], t["why"]) for t in tests if t["plugin"] == "overruns" and t["result"] == "fail"]
check("memory that was overrun is named beside the crash that it caused", over and "first correct what fails in eight-probes" in over[0][1] and
      over[1][0] == "eight-probes" and any(text in over[1][1] for text in (
          "it writes behind its hsp_contact (152 bytes)",  # told by the room behind the record, or earlier by a guarded block
          "of a block of 1216 bytes; with 8 probes a step has 8 records")), over)

# A stiffness that changes along the surface needs a force along it too; arrays that are empty by default are told.
SOFT, LONG_LOOP = os.path.join(BROKEN, "soft_places.so"), "long-loops-give-no-energy"
for dents, softer in (("dents=[0.2]", True), ("dents=[-1.5707963, 0.5]", True), ("dents=[]", False)):
    code, tests, failed, err = examined(SOFT, "--timeout", "60", "--set", dents)
    for shape in ("softer", "softer_flesh", "much_softer", "wrong_slope", "right_slope", "right_slope_rubs", "bumps"):
        wrong = softer and shape in ("softer", "softer_flesh", "much_softer", "wrong_slope")
        mine = [(t["name"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] == "fail"]
        good = [name for name, _ in mine][-1:] == [LONG_LOOP] and "N/m stiff here" in mine[-1][1] if wrong else not mine
        check(f"{shape} with {dents} {'gives energy in long loops' if wrong else 'passes'}", tests and good, mine)
said = hapticd("plugin", "check", SOFT).stdout
check("an array that is empty by default is told, with what to try", said.count("dents is empty by default") == 7 and "--set 'dents=[0]'" in said, said[-300:])

# Mistakes of a first shape. Each is told by one test, which says what to do.
code, tests, failed, err = examined(os.path.join(BROKEN, "first_shapes.so"), "--timeout", "60")
FIRST = {"pushes_and_rubs": ("force-along-normal", "expected no HSP_R_PUSHES in activate() of a shape that has friction"),
         "empty_reset": ("reset-equals-fresh", "expected reset() to forget what earlier steps have left"),
         "long_normal": ("normal-unit-length", "expected a normal of length 1"), "origin_torque": ("torque-about-probe", "about the probe"),
         "at_once": ("force-from-zero", "where the surface is met; expected it to grow from 0"),
         "no_centre": ("denormals", "with a probe at 0 m contact."), "clock": ("no-system-call-in-step", "(clock_gettime)"),
         "gives_more": ("energy-non-increasing", "a closed path gave"), "no_doc": ("descriptor-complete", 'parameter "number": its doc is empty'),
         "turns": ("asks-for-what-it-reads", "report.flags |= HSP_R_ORIENTATION in activate()"),
         "diameter": ("contact-found", "look at the sign of depth_m and at point"),
         "plain_index": ("layout-golden", "expected HSP_AT with step.in_stride and step.out_stride instead of in[i] and out[i]")}
for shape, (test, words) in FIRST.items():
    mine = [(t["name"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    check(f"{shape} fails by {test}", mine and mine[0][0] == test and words in mine[0][1], mine)
WARNED = {"damps_odd": ("units", 'number: the unit is "Ns/m", expected "N s/m"'), "thin_plate": ("contact-found", "the shape is thin here"),
          "slab": ("contact-found", "from a depth of about 2 mm on (0.99 N at the claimed stiffness)"),
          "far_plate": ("contact-found", "5 mm is 0.005 m")}
for shape in ("first_right", *WARNED):
    mine = [(t["name"], t["result"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] in ("fail", "warn")]
    want = WARNED.get(shape)
    check(f"{shape}: {want[0] + ' warns' if want else 'passes'}", len(mine) == (1 if want else 0) and
          (not want or (mine[0][:2] == (want[0], "warn") and want[1] in mine[0][2])), mine)

# A shape that moves: its class says so, and its contacts belong to the pose that it writes.
code, tests, failed, err = examined(os.path.join(BROKEN, "moving_slips.so"), "--timeout", "60")
MOVING = {"lift_right": None, "lift_late": ("contacts-of-new-pose", "off by 1e-05 m; expected point and depth in the frame of the pose that step() writes"),
          "lift_unsaid": ("contacts-of-new-pose", "expected HSP_C_MOVES in the flags of the class"),
          "lift_steep": ("stiffness-vs-claim", "1500 N/m"), "lift_aside": ("depth-falls-outward", "expected the foot on the surface"),
          "lift_counting": ("rests-in-no-time", "in steps that take no time (step.dt_s is 0); expected a motion that follows step.dt_s"),
          "lift_silent": ("rests-in-no-time", "expected report.flags |= HSP_R_MOVES in activate()"), "lift_both": None,
          "lift_mute": ("contacts-of-new-pose", "expected its velocities in the world frame"), "gives_way": None,
          "comes_up": ("goes-with-a-press", "it moves against the hand: a probe was held still 0.5 mm deep")}
for shape, want in MOVING.items():
    mine = [(t["name"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    right = not mine if want is None else len(mine) == 1 and mine[0][0] == want[0] and want[1] in mine[0][1]
    check(f"{shape}: {'passes' if want is None else 'fails by ' + want[0] + ' alone'}", right, mine)
check("the plate on a spring was judged", ("gives_way", "goes-with-a-press", "pass") in {(t["plugin"], t["name"], t["result"]) for t in tests})
code, tests, failed, err = examined(os.path.join(BROKEN, "moving_ball.so"), "--timeout", "60")
check("the moving ball of the guide passes, and its motion was judged", code == 0 and
      any(t["name"] == "contacts-of-new-pose" and t["result"] == "pass" for t in tests), tests)

# What is drawn is compared with what is felt.
code, tests, failed, err = examined(os.path.join(BROKEN, "drawn.so"), "--timeout", "60")
DRAWN = {"drawn_small_bounds": "a vertex at ", "drawn_millimetres": "lie away from the surface that is felt", "drawn_turned": "lie away from the surface",
         "drawn_inside_out": "the triangles are inside out", "drawn_wrong_index": "there are only 2401 vertices"}
for shape, words in DRAWN.items():
    mine = [(t["name"], t["why"]) for t in tests if t["plugin"] == shape and t["result"] == "fail"]
    check(f"{shape} fails by its drawing alone", [name for name, _ in mine] == ["drawing-where-felt"] and words in mine[0][1], mine)
for shape in ("drawn_right", "drawn_in_contact"):
    mine = [(t["name"], t["result"], t["why"]) for t in tests if t["plugin"] == shape and (t["result"] == "fail" or t["name"] == "drawing-where-felt")]
    check(f"{shape} passes", [m[:2] for m in mine] == [("drawing-where-felt", "pass")], mine)

warned = [t["why"] for t in tests if (t["plugin"], t["name"], t["result"]) == ("only_bounds", "bounds-where-felt", "warn")]
check("bounds that leave out what is felt are warned of, without a drawing too", warned and "mm outside" in warned[0], warned)

# Random parameters and probes come after the tests, for as long as is asked for.
for more in ((), ("--fuzz", "1")):
    code, tests, _, err = examined(os.path.join(SHIPPED, "template.so"), *more)
    runs = [int(re.match(r"(\d+) runs of 500 steps", t["why"])[1]) for t in tests if t["name"] == "fuzz"]
    check(f"{' '.join(more) or 'no --fuzz'}: {'some' if more else 'no'} random runs", code == 0 and (runs != [] and runs[0] > 0 if more else runs == []), (code, runs, err))

# Parameters are checked as those of a scene, before any test runs, and all of them at once.
NEEDY = os.path.join(BROKEN, "needy.so")


def refused(*options):
    done = hapticd("plugin", "check", *options, NEEDY)
    return done.returncode, done.stdout + done.stderr


code, said = refused()
check("required parameters are asked for", code == 2 and "give --set heights=FILE" in said and "give --set geometry=FILE" in said, said)
code, said = refused("--set", "stiffnes=3", "--set", "stiffness=soft", "--set", "rows=2.5", "--set", "law=cubic", "--set", "felt=perhaps",
                     "--set", "axis=[0, 1]", "--set", "heights=/no/such/file", "--set", "empty")
for words in ('did you mean "stiffness"', "stiffness=soft", "rows=2.5", "law=cubic", "felt=perhaps", "expected 3 numbers", "/no/such/file",
              "expected ID=VALUE"):
    check(f"--set: {words} is refused", code == 2 and words in said, said)
scene = os.path.join(SOURCE, "config/scenes/teapot.yaml")
done = hapticd("plugin", "check", scene)
check("a scene is no plugin", done.returncode == 2 and "hapticd check FILE" in done.stderr and "ELF" not in done.stderr, done.stderr)
code, said = refused("--set", "stiffness=50000")
check("a value out of range is bad input", code == 2 and "expected 0 to 5000 N/m" in said and "tests" not in said, said)
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "hills.csv")
    open(path, "w").write("heights 1 2 3\n")
    code, tests, failed, err = examined(NEEDY, "--set", "heights=" + path, "--set", "geometry=" + path, "--set", "axis=[0, 1, 0]", "--timeout", "60")
    check("with paths and arrays it passes", code == 1 and not [t for p, t in failed if p == "needy"], (failed, err))
    code, tests, failed, err = examined(NEEDY, "--set", "heights=" + path, "--set", "geometry=" + path, "--timeout", "60")
    refusals = [t for t in tests if t["plugin"] == "needy" and "axis is zero" in t["why"]]
    check("what activate() refuses is told once", code == 1 and [t["name"] for t in refusals] == ["activate"], refusals)
    check("a depth of the wrong sign is found", ("upside_down", "depth-falls-outward") in failed, failed)
finish()
