#!/usr/bin/env python3
"""The bundle of the page is small and comes from this server alone. Usage: bundle.py BUNDLE"""
import gzip
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish

BUNDLE = sys.argv[1]
files = {name: open(os.path.join(BUNDLE, name), "rb").read() for name in sorted(os.listdir(BUNDLE))}
size = sum(len(data) for data in files.values())
packed = sum(len(gzip.compress(data, 9, mtime=0)) for data in files.values())
print(f"bundle: {size} bytes, {packed} with gzip")
check("at most 1 MB", size <= 1_000_000, size)
check("at most 200 kB with gzip", packed <= 200_000, packed)
page = files["index.html"].decode()
check("no script or style in the page itself", not re.search(r"<script(?![^>]*\bsrc=)|<style|\son\w+=|style=", page))
check("nothing from elsewhere", not re.search(r"(?:src|href)=\"(?:https?:)?//", page))
check("no evaluation", not re.search(rb"\beval\(|new Function\(", files["app.js"]))
for holder in ("three.js authors", "Leon Sorokin"):
    check(f"the licence of {holder} is kept", re.search(holder + r"\s+Permission is hereby granted", files["app.js"].decode()))
finish()
