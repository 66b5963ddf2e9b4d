# SPDX-License-Identifier: MIT
"""Models of a running daemon and their live parameters."""
from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Sequence

from ._error import Named, NoForceWarning, caller, known

if TYPE_CHECKING:
    from ._client import Client


@dataclass(frozen=True)
class Parameter:
    """A parameter that may change while the daemon runs."""

    id: str
    unit: str
    min: float
    max: float
    safety: bool  #: True if a hand may feel the change suddenly, so that setting it needs consent
    value: float
    whole: bool
    doc: str


class Model:
    """A model, with its state at the time of the request."""

    def __init__(self, client: "Client", facts: dict[str, Any]) -> None:
        self._client = client
        self.name: str = facts["name"]
        self.number: int = facts["number"]  #: number of the model in the columns `model` of rows
        self.plugin: str = facts["plugin"]
        self.enabled: bool = facts["enabled"]
        self.waits: bool = facts.get("waits", False)  #: True if it gives no force until no tip has been inside for 50 ms
        self.kinematic: bool = facts["kinematic"]
        self.leader: Optional[int] = facts["leader"]  #: id of the process that leads the model
        self.position: list[float] = facts["pose"]["position"]  #: m, world frame
        self.orientation: list[float] = facts["pose"]["orientation"]  #: w, x, y, z
        self.parameters: dict[str, Parameter] = Named(
            "live parameter", {p["id"]: known(Parameter, p) for p in facts.get("live_parameters", [])})

    def __repr__(self) -> str:
        return f"<hapticd model {self.name!r} of {self.plugin}>"

    def get(self, parameter: str) -> Any:
        """Returns the value of any parameter, including those that cannot change."""
        return self._client.ask(do="get", model=self.name, parameter=parameter)["value"]

    def set(self, parameter: str, value: float, consent: bool = False) -> None:
        """Sets a live parameter. If a hand may feel the change suddenly, the person who holds the arm must agree
        (`consent`)."""
        request: dict[str, Any] = {"do": "set", "model": self.name, "parameter": parameter, "value": value}
        if consent:
            request["consent"] = True
        self._client.ask(**request)

    def enable(self, wait: float = 0) -> bool:
        """Fades the force of the model in. A model that has a tip inside gives no force until the tip has been outside for
        50 ms. Returns as soon as the hand can feel the model, or after `wait` seconds; then it returns False and warns
        (NoForceWarning). `h.models[name].waits` tells whether it still waits."""
        waits = self.name in self._client.ask(do="enable", model=self.name).get("waiting", [])
        end = time.monotonic() + wait
        while waits and time.monotonic() < end:
            time.sleep(0.01)
            waits = self._client.models[self.name].waits
        if waits:
            warnings.warn_explicit(f"{self.name}: a tip is inside this model, so it gives no force until the tip has been "
                                   "outside for 50 ms; draw the hand back", NoForceWarning, *caller())
        return not waits

    def disable(self) -> None:
        """Fades the force of the model out. The model is still traced."""
        self._client.ask(do="disable", model=self.name)

    def move(self, position: Sequence[float], seconds: Optional[float] = None,
             orientation: Optional[Sequence[float]] = None) -> float:
        """Sends a kinematic model to a position [m] and an orientation (a unit quaternion w, x, y, z; it stays as it is
        without one). Returns how many seconds the motion takes."""
        if not hasattr(position, "__len__"):
            raise TypeError(f"move() expects a position [x, y, z] in m, got {position!r}")
        if hasattr(seconds, "__len__"):
            raise TypeError(f"move() expects seconds as its second argument, got {seconds!r}; name an orientation: "
                            "move(position, orientation=[w, x, y, z])")
        request: dict[str, Any] = {"do": "move", "model": self.name, "position": list(position)}
        if orientation is not None:
            request["orientation"] = list(orientation)
        if seconds is not None:
            request["seconds"] = seconds
        return self._client.ask(**request)["seconds"]
