"""What the second simulator is held to. Stated before it was compared, and not moved since."""

# Trims: nacelle deg, true airspeed kt; flap deg and rotor rpm as `tiltrotor trim` chooses them; a first guess of
# pitch deg, collective deg, stick in forward.
TRIMS = (
    {"nacelle_deg": 90, "speed_kt": 0, "flap_deg": 40, "rpm": 589, "start": (1, 13, 0.5)},
    {"nacelle_deg": 90, "speed_kt": 40, "flap_deg": 40, "rpm": 589, "start": (-3, 9, 0.8)},
    {"nacelle_deg": 90, "speed_kt": 80, "flap_deg": 40, "rpm": 589, "start": (-8, 9, 1)},
    {"nacelle_deg": 60, "speed_kt": 80, "flap_deg": 20, "rpm": 589, "start": (8, 8, 0)},
    {"nacelle_deg": 30, "speed_kt": 120, "flap_deg": 20, "rpm": 589, "start": (3, 17, 1)},
    {"nacelle_deg": 0, "speed_kt": 160, "flap_deg": 0, "rpm": 458, "start": (4, 40, 0.3)},
    {"nacelle_deg": 0, "speed_kt": 200, "flap_deg": 0, "rpm": 458, "start": (2, 50, 0.5)},
)
PITCH_DEG = 2.0
POWER_PERCENT = 15.0

# The task.
END_M = 5.0

# Modes are shown, not limited: rotor speed is held there and not here, and theory's dampings part from flight's.
MODES = ((90, 0), (0, 180))

# Windows of recorded inputs: where they begin, s after the beginning of a phase of the demonstration.
WINDOW_S = 3.0
WINDOWS = (
    ("hover", 1.0), ("acceleration", 6.0), ("acceleration", 20.0), ("conversion", 3.0), ("climb", 3.0),
    ("left turn", 8.0), ("left turn", 20.0), ("approach", 20.0), ("approach", 35.0), ("hover", 0.0),
)  # fmt: skip

# For so long the hands of the pitch-forward take-off are played into ours.
HANDS_S = 12.0
