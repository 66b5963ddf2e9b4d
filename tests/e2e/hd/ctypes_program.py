"""What Python bindings of the HDAPI do by ctypes: a struct of 12 bytes by value, a callback from a thread that Python did
not start. Prints a line a case; exit 1 when one is off."""
import ctypes
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "support"))
from e2e import check, finish, until


class ErrorInfo(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint), ("internal", ctypes.c_int), ("device", ctypes.c_uint)]


hd = ctypes.CDLL("libHD.so")
hd.hdInitDevice.restype = ctypes.c_uint
hd.hdInitDevice.argtypes = [ctypes.c_char_p]
hd.hdGetError.restype = ErrorInfo
hd.hdGetString.restype = ctypes.c_char_p
hd.hdScheduleAsynchronous.restype = ctypes.c_ulong
hd.hdUnschedule.argtypes = [ctypes.c_ulong]
CALLBACK = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)
POSITION, FORCE, FORCE_OUTPUT = 0x2050, 0x2700, 0x4000
seen, devices = [], set()


@CALLBACK
def callback(_):
    hd.hdBeginFrame(hd.hdGetCurrentDevice())
    position = (ctypes.c_double * 3)()
    hd.hdGetDoublev(POSITION, position)
    hd.hdSetDoublev(FORCE, (ctypes.c_double * 3)(*(-0.05 * x for x in position)))
    hd.hdEndFrame(hd.hdGetCurrentDevice())
    seen.append(tuple(position))
    devices.add(hd.hdGetCurrentDevice())
    return 1


before = hd.hdGetCurrentDevice()
device = hd.hdInitDevice(b"Default Device")
check("the handle is that of the current device before", device == before == 0, (device, before))
hd.hdEndFrame(device)
error = hd.hdGetError()
check("an error comes by value", (error.code, error.device) == (0x0401, device), (error.code, error.device))
check("a string is bytes", hd.hdGetString(0x2504) is not None)
hd.hdEnable(FORCE_OUTPUT)
handle = hd.hdScheduleAsynchronous(callback, None, ctypes.c_ushort(65535))
hd.hdStartScheduler()
check("callbacks come from a thread of the library", until(lambda: len(seen) > 200), len(seen))
time.sleep(0.1)
hd.hdStopScheduler()
hd.hdUnschedule(handle)
check("each in its device", devices == {device}, devices)
check("the arm moved", len(set(seen)) > 50, len(set(seen)))
check("without an error", hd.hdGetError().code == 0)
hd.hdDisableDevice(device)
finish()
