# SPDX-License-Identifier: MIT
"""The runtime folder of a daemon."""
from __future__ import annotations

import fcntl
import glob
import os
import stat

from ._error import HapticdError


def _in_memory(folder: str) -> bool:
    """Returns whether the folder is on a file system in memory, as the daemon requires for its runtime folder."""
    try:
        with open("/proc/self/mountinfo", encoding="utf-8") as mounts:
            best, kind = "", ""
            real = os.path.realpath(folder)
            for line in mounts:
                fields = line.split()
                point, rest = fields[4], fields[fields.index("-") + 1]
                if (real + "/").startswith(point.rstrip("/") + "/") and len(point) >= len(best):
                    best, kind = point, rest
            return kind in ("tmpfs", "ramfs")
    except OSError:
        return False


def _running(folders: list[str]) -> list[str]:
    """Returns the names of the daemons that run: each holds the lock on its name."""
    names = []
    for folder in folders:
        for lock in glob.glob(os.path.join(glob.escape(folder), "*.lock")):
            try:
                with open(lock, "rb") as file:
                    fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                names.append(os.path.basename(lock)[:-len(".lock")])
            except OSError:
                continue
    return sorted(names)


def runtime_folder(name: str) -> str:
    """Returns the runtime folder of the daemon of this name; see control.md."""
    folders = []
    if os.environ.get("RUNTIME_DIRECTORY"):
        folders.append(os.environ["RUNTIME_DIRECTORY"].split(":")[0])
    if os.environ.get("XDG_RUNTIME_DIR") and _in_memory(os.environ["XDG_RUNTIME_DIR"]):
        folders.append(os.path.join(os.environ["XDG_RUNTIME_DIR"], "hapticd"))
    folders += ["/run/hapticd", f"/dev/shm/hapticd-{os.geteuid()}"]
    for folder in folders:
        try:
            if stat.S_ISSOCK(os.stat(os.path.join(folder, name + ".sock")).st_mode):
                return folder
        except OSError:
            continue
    others, option = _running(folders), "" if name == "hapticd" else f" --name {name}"
    raise HapticdError(f"no daemon named {name} runs; "
                       + (f"these run: {', '.join(others)}" if others else f"none runs in {' or '.join(folders)}")
                       + f"\n  fix: start it with hapticd run SCENE{option}"
                       + (", or name one of these: hapticd.connect(NAME)" if others else ""), "gone")
