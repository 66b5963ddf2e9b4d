# SPDX-License-Identifier: MIT
"""For programs that use a running hapticd: they read the data of every tick, move models, and push on arms.

    import hapticd

    with hapticd.connect() as daemon:
        print(daemon.models["teapot"].parameters["stiffness"].value)
        rows = daemon.rows("ticks", last=1000)            # a numpy array; rows["arm0_sent_fx"] in N
        with daemon.lead_model("door") as door:
            door.put([0.1, 0, 0])                         # m; at most 1 m/s and 20 m/s^2

SI units; vectors in the world frame: x to the right, y up, z toward the user; quaternions are w, x, y, z. Needs nothing
but Python; with numpy, rows are structured arrays, without it lists of tuples.
"""
from ._client import Client, Events, connect
from ._error import HapticdError, NoForceWarning, Refused
from ._lead import ForceLead, Lead, PoseLead
from ._models import Model, Parameter
from ._push import ForceThread
from ._rows import Column, Stream
from ._state import FAULTS, State

CAME_OUT, WENT_IN = 2, 1  #: `code` of an event `click`, in rows of the stream `events`
HIGHEST, LOWEST = 2, 1  #: `code` of an event `end_stop`

__all__ = ["CAME_OUT", "FAULTS", "Client", "Column", "Events", "ForceLead", "ForceThread", "HIGHEST", "HapticdError", "LOWEST", "Lead",
           "Model", "NoForceWarning", "Parameter", "PoseLead", "Refused", "State", "Stream", "WENT_IN", "connect"]
