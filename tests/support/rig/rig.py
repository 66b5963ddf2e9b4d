"""Reads and controls the test arm `rig` from a script, through the page that rig_page.hpp describes.

    arm = Rig(folder)                  # before the daemon starts; arm.device is a device file
    ... run a scene with --device arm.device ...
    arm.motors_on(), arm.entries(), arm.commands_after(time.monotonic_ns()), arm.wish(LOST)
"""
import mmap
import os
import struct
import time

OPENED, STARTED, COMMAND, CUT, STOPPED, CLOSED = range(6)
LOST, HARDWARE_FAULT, UNCALIBRATED, SILENT, HANG_IN_READ, HANG_IN_WRITE, HANG_IN_WAIT, WRITE_FAILS = (1 << i for i in range(8))

HEADER, ENTRY, CAPACITY = 160, struct.Struct("<QQII3d"), 1 << 18
COUNT, MOTORS_ON, TORQUE, POSITION, STAMP, FAULTS, BUTTONS = 16, 32, 40, 64, 144, 152, 156


class Entry:
    """An entry of the log: time_ns (as of time.monotonic_ns()), given_ns, kind, on, force [N] in the device frame."""

    def __init__(self, raw):
        self.time_ns, self.given_ns, self.kind, self.on, *self.force = ENTRY.unpack(raw)


class Rig:
    def __init__(self, folder, limits="{ramp_in: 0.02}", **parameters):
        self.file = os.path.join(folder, "rig.page")
        self.device = os.path.join(folder, "rig.yaml")
        lines = "".join(f"  {key}: {value}\n" for key, value in parameters.items())
        with open(self.device, "w") as out:
            out.write(f"hapticd-device: 1\nmodule: rig\nname: rig\nlimits: {limits}\nparameters:\n"
                      f"  page: {self.file}\n{lines}")
        self._map = None

    def page(self, timeout=20):
        """Returns the page. Waits until the daemon has opened the arm."""
        end = time.monotonic() + timeout
        while self._map is None:
            if os.path.exists(self.file) and os.path.getsize(self.file) >= HEADER + CAPACITY * ENTRY.size:
                with open(self.file, "r+b") as file:
                    self._map = mmap.mmap(file.fileno(), 0)
            elif time.monotonic() > end:
                raise TimeoutError("the daemon never opened the rig")
            else:
                time.sleep(0.01)
        return self._map

    def _read(self, form, at):
        return struct.unpack_from("<" + form, self.page(), at)

    def count(self):
        return self._read("Q", COUNT)[0]

    def motors_on(self):
        return self._read("I", MOTORS_ON)[0] != 0

    def force(self):
        """Returns the force [N] that the motors hold now."""
        return self._read("3d", TORQUE)

    def entries(self):
        count, page = self.count(), self.page()
        begin = max(0, count - CAPACITY)
        return [Entry(page[at:at + ENTRY.size]) for at in (HEADER + i % CAPACITY * ENTRY.size for i in range(begin, count))]

    def commands_after(self, time_ns):
        """Returns the entries with a torque that are later than time_ns, a value of time.monotonic_ns()."""
        return [e for e in self.entries() if e.time_ns > time_ns and e.on]

    def wait_for_force(self, timeout=20):
        """Waits until the motors push. Returns False if they did not in time."""
        end = time.monotonic() + timeout
        self.page(timeout)
        while not self.motors_on():
            if time.monotonic() > end:
                return False
            time.sleep(0.002)
        return True

    def silent_after(self, seconds):
        """Waits until the motors are free and stay free for 50 ms. Returns the time [ns] until they became free, or None if they
        did not within `seconds`."""
        begun = time.monotonic_ns()
        while time.monotonic_ns() < begun + int(seconds * 1e9):
            if not self.motors_on():
                free = time.monotonic_ns()
                time.sleep(0.05)
                if not self.motors_on():
                    return free - begun
            time.sleep(0.0005)
        return None

    def move(self, x, y, z):
        struct.pack_into("<3d", self.page(), POSITION, x, y, z)

    def wish(self, faults):
        struct.pack_into("<I", self.page(), FAULTS, faults)
