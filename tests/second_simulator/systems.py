"""Controls, augmentation, actuators, rpm governor, engines and cross-shaft for JSBSim.

# Signs
Stick aft and right, right pedal and lever up positive, as a part of the travel; mast tilt 0 as a helicopter.
Actuators: elevator trailing edge down, rudder and flaperons to the right, positive.

# Left out
The programmed lateral cyclic (both discs inboard), heading hold, the limits of the series actuators' rates.
"""

from sheet import STEP_S

MASTS = (("r", 0, 1), ("l", 1, -1))
RADPS_PER_RPM = 3.14159265 / 30
SLUG_FT2 = 1.355818
PA_PER_PSF = 47.88026

INPUTS = (
    "stick_aft",
    "stick_right",
    "pedal_right",
    "lever",
    "nacelle_aft",
    "flap_lever",
    "gear_lever",
    "rpm_lever",
)


def write(sheet, data):
    """Puts the systems on the sheet."""
    n = data.number

    def let(name, text):
        sheet.let("systems", name, text)

    def table(name, argument, path):
        xs, ys = data.line(path)
        sheet.table("systems", name, [argument], [xs], ys)

    for name in INPUTS:
        sheet.state(name, 0.0)
    sheet.state("scas_on", 1.0)
    sheet.state("running", 0.0)
    sheet.state("shaft_held", 0.0)
    for axis in ("x", "y", "z", "roll", "pitch", "yaw"):
        sheet.state(f"given_{axis}", 0.0)

    # Masts, flaps, gear.
    sheet.state("tilt", 0.0)
    sheet.state("flap", 40.0)
    sheet.state("gear", 1.0)
    table("tilt_rate", "tilt", "actuators.nacelle_degps")
    low, high = 0.0, n("actuators.mast_tilt_deg_max")  # the 5 deg behind upright are not used here
    sheet.next("tilt", f"min({high!r}, max({low!r}, tilt - nacelle_aft * tilt_rate * {STEP_S!r}))")
    a = "actuators."
    sheet.follow(
        "flap", "flap_lever", n(a + "flap.lag_s"), n(a + "flap.rate_degps_max"), 0.0, n(a + "flap.deg_max")
    )
    sheet.follow("gear", "gear_lever", 0.01, 1 / n(a + "gear_s"), 0.0, 1.0)
    let("tilt_rad", "tilt / 57.29578")
    let("sin_tilt", "sin(tilt_rad)")
    let("cos_tilt", "cos(tilt_rad)")

    augmentation(sheet, data, let)
    mixer(sheet, data, let, table)
    power(sheet, data, let, table)

    # The wing's downwash reaches the tail after the way between them.
    sheet.state("eps", 0.0)
    way = n("horizontal_stabilizer.wake_length_ft")
    sheet.path["eps_wing"] = "xv/eps-wing"
    sheet.next("eps", f"eps + (eps_wing - eps) * min(1, {STEP_S / way!r} * max(20, u))")

    # Into JSBSim's own: masts, hubs, tilting masses, blades, speed.
    mast = 12 * n("rotors.mast_length_ft")
    pivot = n("rotors.pivot_in")
    mass = n("weight_balance.tilting_cg_in")
    back, up = mass[0] - pivot[0], mass[2] - pivot[2]
    let("incidence_rad", "1.57079633 - tilt_rad")
    let("hub_x", f"{pivot[0]!r} - {mast!r} * sin_tilt")
    let("hub_z", f"{pivot[2]!r} + {mast!r} * cos_tilt")
    let("mass_x", f"{pivot[0]!r} + {back!r} * cos_tilt - {up!r} * sin_tilt")
    let("mass_z", f"{pivot[2]!r} + {up!r} * cos_tilt + {back!r} * sin_tilt")
    let("rpm", f"rotor_radps / {RADPS_PER_RPM!r}")
    for side, index, _ in MASTS:
        engine = f"propulsion/engine[{index}]/"
        sheet.send("incidence_rad", engine + "pitch-angle-rad")
        sheet.send("hub_x", engine + "x-position")
        sheet.send("hub_z", engine + "z-position")
        sheet.send("rpm", engine + "x-rpm-dict")
        sheet.send(
            f"(root_from_three_quarters + collective_{side}) / 57.29578", engine + "collective-ctrl-rad"
        )
        sheet.send(f"cyclic_{side} / 57.29578", engine + "longitudinal-ctrl-rad")
        sheet.send("mass_x", f"inertia/pointmass-location-X-inches[{index}]")
        sheet.send("mass_z", f"inertia/pointmass-location-Z-inches[{index}]")
    sheet.send("gear", "gear/gear-pos-norm")


def augmentation(sheet, data, let):
    """Rate damping, quickening and attitude hold in series with the stick, in of travel."""
    n = data.number
    s = "fcc.scas."
    travel = {"aft": "longitudinal_stick_in", "right": "lateral_stick_in", "pedal": "pedal_in"}
    stick = {"aft": "stick_aft", "right": "stick_right", "pedal": "pedal_right"}
    let("light", f"1 / (1 + qbar * {PA_PER_PSF / n(s + 'dynamic_pressure_pa')!r})")
    let("turn", "32.174 * sin(phi) * cos(theta) / max(vt, 50) * min(1, vt / 50)")
    axes = (
        ("aft", "pitch", "q", "theta"),
        ("right", "roll", "p", "phi"),
        ("pedal", "yaw", "r - turn", None),
    )
    for name, axis, rate, attitude in axes:
        let(f"in_{name}", f"{n('fcc.travel.' + travel[name])!r} * {stick[name]}")
        sheet.state(f"mean_{name}", 0.0)
        let(f"wash_{name}", f"in_{name} - mean_{name}")
        sheet.next(f"mean_{name}", f"mean_{name} + {STEP_S / n(s + 'washout_s')!r} * wash_{name}")
        gain, quick = n(f"{s}{axis}.rate_gain_in_per_radps"), n(f"{s}{axis}.feed_forward")
        hold = ""
        if attitude:
            sheet.state(f"held_{name}", 0.0)
            moves = (
                f"max(1 - scas_on, min(1, max(0, (abs(wash_{name}) - {n(s + 'hold_stick_in')!r}) * 1000)))"
            )
            sheet.next(
                f"held_{name}",
                f"held_{name} + ({attitude} - held_{name}) * {STEP_S / n(s + 'hold_follow_s')!r} * {moves}",
            )
            most = n(f"{s}{axis}.hold_authority_in")
            keep = n(f"{s}{axis}.attitude_gain_in_per_rad")
            hold = f" - max(-{most!r}, min({most!r}, {keep!r} * light * ({attitude} - held_{name})))"
        most = n(f"{s}{axis}.authority_in")
        added = f"-{gain!r} * light * ({rate}) + {quick - 1!r} * light * wash_{name}{hold}"
        let(f"augmented_{name}", f"in_{name} + scas_on * max(-{most!r}, min({most!r}, {added}))")


def mixer(sheet, data, let, table):
    """Gearing by mast tilt and airspeed, and the actuators after it, deg."""
    n = data.number
    m = "fcc.mixer."
    table("pitch_low", "tilt", "fcc.governor.lever_bottom_deg")
    table("pitch_per_lever", "tilt", m + "collective_per_lever_deg_per_in")
    table("pitch_per_stick", "tilt", m + "collective_per_lateral_stick_deg_per_in")
    table("cyclic_per_stick", "tilt", m + "cyclic_per_longitudinal_stick_deg_per_in")
    axes, values = data.grid(m + "cyclic_per_pedal_deg_per_in", "mast_tilt_deg", "airspeed_kt")
    sheet.table("systems", "cyclic_per_pedal", ["tilt", "knots"], axes, values)
    sheet.state("correction", 0.0)
    let("pitch_both", f"pitch_low + pitch_per_lever * {n('fcc.travel.collective_in')!r} * lever + correction")

    def actuator(name, towards, kind, start=0.0):
        sheet.state(name, start)
        path = "actuators." + kind
        sheet.follow(
            name,
            towards,
            n(path + ".lag_s"),
            n(path + ".rate_degps_max"),
            n(path + ".deg_min"),
            n(path + ".deg_max"),
        )

    for side, _, sign in MASTS:
        actuator(
            f"collective_{side}",
            f"pitch_both - {sign} * pitch_per_stick * augmented_right",
            "collective",
            5.0,
        )
        actuator(
            f"cyclic_{side}",
            f"-cyclic_per_stick * augmented_aft - {sign} * cyclic_per_pedal * augmented_pedal",
            "cyclic",
        )
    actuator(
        "elevator", f"-{n(m + 'elevator_per_longitudinal_stick_deg_per_in')!r} * augmented_aft", "elevator"
    )
    actuator("flaperon", f"{n(m + 'flaperon_per_lateral_stick_deg_per_in')!r} * augmented_right", "flaperon")
    actuator("rudder", f"{n(m + 'rudder_per_pedal_deg_per_in')!r} * augmented_pedal", "rudder")


def power(sheet, data, let, table):
    """Lever to power, power and both rotors' torque on one shaft, its speed governed by collective."""
    n = data.number
    table("lever_power", "lever", "engines.power_by_lever_norm")
    idle = n("engines.idle_power_norm")
    sheet.state("power_norm", idle)
    sheet.follow("power_norm", f"{idle!r} + {1 - idle!r} * lever_power", n("engines.lag_s"), 10.0, 0.0, 1.0)
    rated = 2 * 550 * n("engines.rated_power_hp")
    inertia = (2 * n("rotors.polar_inertia_kg_m2") + n("engines.drive_inertia_kg_m2")) / SLUG_FT2
    speed = n("fcc.governor.rotor_speed_rpm")
    sheet.state("rotor_radps", speed[0] * RADPS_PER_RPM)
    sheet.next(
        "rotor_radps",
        f"rotor_radps + (1 - shaft_held) * {STEP_S / inertia!r} * ({rated!r} * power_norm / max(10, rotor_radps)"
        " - torque_r - torque_l)",
    )
    sheet.state("rpm_wanted", speed[0])
    rate = n("fcc.governor.reference_rpm_per_s")
    sheet.follow("rpm_wanted", "rpm_lever", STEP_S, rate, 100.0, 661.0)
    g = "fcc.governor."
    table("k_p", "tilt", g + "proportional_deg_per_rpm")
    table("k_i", "tilt", g + "integral_deg_per_rpm_s")
    let("rpm_off", f"rotor_radps / {RADPS_PER_RPM!r} - rpm_wanted")
    sheet.state("integral", 0.0)
    most = n(g + "collective_deg_max")
    sheet.next(
        "integral", f"min({most!r}, max(-15, integral + (1 - shaft_held) * k_i * rpm_off * {STEP_S!r}))"
    )
    sheet.follow("correction", "integral + k_p * rpm_off", STEP_S, n(g + "collective_degps_max"), -15.0, most)
