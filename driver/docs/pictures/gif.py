#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Puts pictures together to a GIF that loops: one palette for all of them, no dithering, so that what rests stays the same.

Usage: gif.py OUT.gif WIDTH FRAMES_A_SECOND PICTURE.png...     needs python3-pil and gifsicle
"""
import os
import subprocess
import sys
import tempfile

from PIL import Image

COLORS, SAMPLES = 128, 12


def shrunk(file, width):
    picture = Image.open(file).convert("RGB")
    return picture.resize((width, round(width * picture.height / picture.width)), Image.LANCZOS)


def palette_of(pictures):
    """Colours of some of the pictures, one below the other."""
    some = pictures[:: max(1, len(pictures) // SAMPLES)]
    sheet = Image.new("RGB", (some[0].width, some[0].height * len(some)))
    for i, picture in enumerate(some):
        sheet.paste(picture, (0, i * picture.height))
    return sheet.quantize(COLORS, method=Image.MEDIANCUT)


def main(out, width, rate, files):
    pictures = [shrunk(file, width) for file in files]
    palette = palette_of(pictures)
    with tempfile.TemporaryDirectory() as folder:
        frames = []
        for i, picture in enumerate(pictures):
            frames.append(os.path.join(folder, f"{i:04}.gif"))
            picture.quantize(palette=palette, dither=Image.NONE).save(frames[-1])
        subprocess.run(["gifsicle", "-O3", "--lossy=60", "--loopcount=0", f"--delay={round(100 / rate)}", *frames, "-o", out], check=True)


main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), sys.argv[4:])
