"""A deterministic simulation of the Bell XV-15 tilt-rotor, and its flight logs.

The engine of the command ``tiltrotor``, with the same bits: what is recorded here is verified there, and the other way
round. A tick is 4 ms. Numbers are in SI units and radians where their names end so (``_mps``, ``_rad``); a pilot's
units are in the names too (``_kt``, ``_deg``).

>>> import tiltrotor
>>> xv15 = tiltrotor.Aircraft()
>>> xv15.trim(nacelle_deg=0, speed_kt=180, altitude_ft=5000)["pitch_deg"] < 5
True
"""

from __future__ import annotations

from ._native import BUILD, STARTS, STEP_S, NoSteadyFlight, TiltrotorError, Verdict, __version__
from .aircraft import Aircraft, Condition, Linear, Mode, Trim
from .flight import Flight
from .logs import Channel, Response, channels, facts, identify, read, refly, verify, whatif

__all__ = [
    "BUILD",
    "STARTS",
    "STEP_S",
    "Aircraft",
    "Channel",
    "Condition",
    "Flight",
    "Linear",
    "Mode",
    "NoSteadyFlight",
    "Response",
    "TiltrotorError",
    "Trim",
    "Verdict",
    "__version__",
    "channels",
    "facts",
    "identify",
    "read",
    "refly",
    "verify",
    "whatif",
]
