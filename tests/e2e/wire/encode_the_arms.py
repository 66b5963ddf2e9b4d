#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What encode makes of positions, decode reads as the same positions: for each arm that ships, as text and as raw bytes.

Usage: encode_the_arms.py HAPTICD SOURCE       exit 1 when one is off
"""
import glob
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish
from wire import fed, table_of

run = fed(sys.argv[1], "device")
files = [f for f in sorted(glob.glob(os.path.join(sys.argv[2], "config/devices/*.yaml"))) if "wire:" in open(f).read()]
check("there are arms with a wire format", len(files) > 4, files)
for file in files:
    name = os.path.basename(file)
    joints = max(int(n) for n in re.findall(r"is: position, joint: (\d+)", open(file).read()))
    rows = [[round(0.3 + 0.01 * i + 0.02 * j, 3) for j in range(joints)] for i in range(8)]
    numbers = "\n".join(",".join(map(str, row)) for row in rows) + "\n"
    for form in ([], ["--raw"]):
        code, made, err = run("encode", "--from-arm", file, *form, given=numbers.encode())
        decoded, out, told = run("decode", file, *form, given=made)
        table = table_of(out)
        good = [row for row in table if row["verdict"] == "good"]
        worst = max((abs(float(row[f"position{j + 1}"]) - rows[i][j]) for i, row in enumerate(good) for j in range(joints)), default=1)
        check(f"{name} {' '.join(form)}", code == 0 and decoded == 0 and len(good) == len(rows) and worst < 1e-2, (err, told, len(good), worst))
finish()
