"""The airframe for JSBSim: forces and moments by the published tables and equations of the reference model.

# Signs
Body axes forward, right, down; moments about the point SL 300, WL 81.65, to which JSBSim moves them from
the centre of gravity. Angles of attack are the body's; lengths ft, forces lbf, angles deg unless `_rad`.

# Left out, of what the reports have
Mach number (below .3 here), table 4-XII to 4-XVI's flaperon terms and pylon platforms, the tail's loss in
sideslip, and everything near the ground. Where the wake lies on the wing is not the engine's footprint but
the closed form that others give (56 ft2 a side, gone at 98.4 ft/s and with the nacelles 45 deg forward).
"""

from published import fin, polar

REFERENCE_IN = (300.0, 0.0, 81.65)


def arm_ft(station_in):
    """From the reference point to a station, body axes."""
    sl, bl, wl = station_in
    return (REFERENCE_IN[0] - sl) / 12, (bl - REFERENCE_IN[1]) / 12, (REFERENCE_IN[2] - wl) / 12


def write(sheet, data):
    """Puts the airframe on the sheet and returns the six sums: X, Y, Z, ROLL, PITCH, YAW."""
    sums = {axis: [] for axis in ("X", "Y", "Z", "ROLL", "PITCH", "YAW")}

    def let(name, text):
        sheet.let("airframe", name, text)

    def table(name, arguments, path, *axes):
        if axes:
            sheet.table("airframe", name, arguments, *data.grid(path, *axes))
        else:
            xs, ys = data.line(path)
            sheet.table("airframe", name, arguments, [xs], ys)

    def push(station_ft, x=None, y=None, z=None):
        """A force at a place."""
        ax, ay, az = station_ft
        for axis, force, moments in (
            ("X", x, (("PITCH", az), ("YAW", -ay))),
            ("Y", y, (("ROLL", -az), ("YAW", ax))),
            ("Z", z, (("ROLL", ay), ("PITCH", -ax))),
        ):
            if force:
                sums[axis].append(force)
                for moment, arm in moments:
                    if arm != 0.0:
                        sums[moment].append(f"{arm!r} * {force}")

    let("alpha", "57.29578 * atan2(w, u)")
    let("beta", "57.29578 * atan2(v, sqrt(u * u + w * w) + 0.01)")
    let("beta_abs", "abs(beta)")
    let("q_uw", "0.5 * rho * (u * u + w * w)")
    let("q_all", "0.5 * rho * vt * vt")
    let("speed", "max(vt, 20)")
    wing(sheet, data, let, table, push, sums)
    pylons(data, let, table, push)
    fuselage(data, let, table, push, sums)
    tail(data, let, table, push)
    fins(sheet, data, let, table, push)
    # Jets of the engines, along the masts.
    jet = 2 * data.number("engines.jet_thrust_lbf")
    let("jet", f"{jet!r} * power_norm")
    x, y, z = arm_ft((300.0, 0.0, 100.0))
    let("jet_x", "jet * sin_tilt")
    let("jet_z", "-jet * cos_tilt")
    push((x, y, z), x="jet_x", z="jet_z")
    for axis in sums:  # what a comparison adds from outside
        sums[axis].append(f"given_{axis.lower()}")
    return sums


def wing(sheet, data, let, table, push, sums):
    """Free stream by coefficients, the part in the wake side by side at its own angle of attack."""
    n = data.number
    area, chord, span = n("wing_pylon.area_ft2"), n("wing_pylon.chord_ft"), n("wing_pylon.span_ft")
    radius = n("rotors.radius_ft")
    x, y, z = arm_ft(n("wing_pylon.centre_in"))
    lift_axes, lift = polar(data, "wing_pylon.lift")
    drag_axes, drag = polar(data, "wing_pylon.drag")

    # K_XRW·X_RW·C_RF/max(.15, μ)²: the rotors turn the flow down. [CR536 A-70, B-33]
    let("tip_speed", f"{radius!r} * rotor_radps")
    let("in_plane", "abs(u * cos_tilt + w * sin_tilt) / tip_speed")
    let("c_rf", f"(thrust_r + thrust_l) / ({3.14159265 * radius**2!r} * rho * tip_speed * tip_speed)")
    let(
        "deflection",
        f"57.29578 * {n('rotor_wake.deflection_factor')!r} * ({n('rotor_wake.deflection_upright')!r}"
        f" + {n('rotor_wake.deflection_per_tilt_per_deg')!r} * tilt"
        f" + {n('rotor_wake.deflection_per_tilt2_per_deg2')!r} * tilt * tilt) * c_rf"
        " / (max(0.15, in_plane) * max(0.15, in_plane))",
    )
    # Only where there is a stream to be turned: in a hover the wing is in the wake.
    let("alpha_free", "alpha - deflection * min(1, max(0, u) / 50)")
    # Immersed area a side. [KH]; that it fades from 30 to 45 deg of tilt is an estimate.
    let("shape", "sin(1.386 * (1.570796 - tilt_rad)) + cos(3.114 * (1.570796 - tilt_rad))")
    let("cut", "min(1, max(0, (45 - tilt) / 15))")
    let("wet", "56 * cut * max(0, min(1, shape)) * max(0, (98.4 - abs(u)) / 98.4)")
    let("free", f"{area!r} - 2 * wet")

    sheet.table("airframe", "cl", ["tilt", "alpha_free", "flap"], lift_axes, lift)
    sheet.table("airframe", "cd", ["tilt", "alpha_free", "flap"], drag_axes, drag)
    let("free_lift", "q_uw * free * cl")
    let("free_drag", "q_uw * free * cd")
    let("sin_free", "sin(alpha_free / 57.29578)")
    let("cos_free", "cos(alpha_free / 57.29578)")
    let("free_x", "free_lift * sin_free - free_drag * cos_free")
    let("free_z", "-free_lift * cos_free - free_drag * sin_free")
    push((x, 0.0, z), x="free_x", z="free_z")
    wake = n("rotor_wake.wing_factor")
    for side, sign in (("r", 1), ("l", -1)):
        let(f"u_{side}", f"u - {sign} * {y!r} * r + {wake!r} * inflow_{side} * sin_tilt")
        let(f"w_{side}", f"w + {sign} * {y!r} * p - {wake!r} * inflow_{side} * cos_tilt")
        let(f"alpha_{side}", f"57.29578 * atan2(w_{side}, u_{side})")
        sheet.table("airframe", f"cl_{side}", ["tilt", f"alpha_{side}", "flap"], lift_axes, lift)
        sheet.table("airframe", f"cd_{side}", ["tilt", f"alpha_{side}", "flap"], drag_axes, drag)
        let(f"q_{side}", f"0.5 * rho * (u_{side} * u_{side} + w_{side} * w_{side}) * wet")
        let(f"sin_{side}", f"sin(alpha_{side} / 57.29578)")
        let(f"cos_{side}", f"cos(alpha_{side} / 57.29578)")
        let(f"wet_x_{side}", f"q_{side} * (cl_{side} * sin_{side} - cd_{side} * cos_{side})")
        let(f"wet_z_{side}", f"-q_{side} * (cl_{side} * cos_{side} + cd_{side} * sin_{side})")
        push((x, sign * y, z), x=f"wet_x_{side}", z=f"wet_z_{side}")
    let("download", "wet_z_r + wet_z_l")

    table("cm", ["tilt", "flap"], "wing_pylon.pitching_moment", "mast_tilt_deg", "flap_deg")
    table("cd_least", ["tilt", "flap"], "wing_pylon.drag_at_no_lift", "mast_tilt_deg", "flap_deg")
    table("cl_beta", ["tilt", "flap"], "wing_pylon.rolling_by_sideslip_per_rad", "mast_tilt_deg", "flap_deg")
    table(
        "cl_beta_lift",
        ["tilt", "flap"],
        "wing_pylon.rolling_by_sideslip_and_lift_per_rad",
        "mast_tilt_deg",
        "flap_deg",
    )
    table("flaperon_part", ["tilt", "flap"], "wing_pylon.flaperon_factor", "mast_tilt_deg", "flap_deg")
    let("p_hat", f"{span / 2!r} * p / speed")
    let("r_hat", f"{span / 2!r} * r / speed")
    let("beta_rad", "min(0.35, max(-0.35, beta / 57.29578))")
    let("fade", "max(0, min(1, (25 - abs(alpha)) / 17))")
    let(
        "c_roll",
        f"{n('wing_pylon.rolling_by_roll_rate')!r} * p_hat"
        f" + {n('wing_pylon.rolling_by_yaw_rate_and_lift')!r} * cl * r_hat"
        " + (cl_beta + cl_beta_lift * cl) * beta_rad"
        f" + {n('wing_pylon.rolling_by_flaperon_per_deg')!r} * flaperon_part * fade * flaperon",
    )
    let(
        "c_yaw",
        f"({n('wing_pylon.yawing_by_sideslip_per_rad')!r}"
        f" + {n('wing_pylon.yawing_by_sideslip_and_lift2_per_rad')!r} * cl * cl) * beta_rad"
        f" + {n('wing_pylon.yawing_by_roll_rate_and_lift')!r} * cl * p_hat"
        f" + ({n('wing_pylon.yawing_by_yaw_rate_and_lift2')!r} * cl * cl"
        f" + {n('wing_pylon.yawing_by_yaw_rate_and_drag')!r} * cd_least) * r_hat",
    )
    sums["ROLL"].append(f"{span!r} * q_uw * free * c_roll")
    sums["YAW"].append(f"{span!r} * q_uw * free * c_yaw")
    sums["PITCH"].append(f"{chord!r} * q_uw * free * cm")


def pylons(data, let, table, push):
    """Interference drag of the nacelles and drag of the spinners."""
    n = data.number
    let("cos_alpha", "cos(alpha / 57.29578)")
    let("sin_alpha", "sin(alpha / 57.29578)")
    table("pylon_ft2", ["tilt"], "wing_pylon.interference_ft2")
    let("pylon_x", "-q_uw * pylon_ft2 * cos_alpha")
    let("pylon_z", "-q_uw * pylon_ft2 * sin_alpha")
    push(arm_ft((300.0, 0.0, 100.0)), x="pylon_x", z="pylon_z")
    let("across", "abs(u * cos_tilt + w * sin_tilt) / (sqrt(u * u + w * w) + 0.01)")
    let(
        "spinner",
        f"2 * q_uw * ({n('wing_pylon.spinner_ft2')!r}"
        f" + {n('wing_pylon.spinner_across_ft2')!r} * across * across * across)",
    )
    mast = n("rotors.mast_length_ft")
    pivot = arm_ft((300.0, 0.0, 100.0))[2]
    let("spinner_x", "-spinner * cos_alpha")
    let("spinner_z", "-spinner * sin_alpha")
    push((0.0, 0.0, pivot), x="spinner_x", z="spinner_z")
    let("spinner_pitch", f"-{mast!r} * (cos_tilt * spinner_x + sin_tilt * spinner_z)")


def fuselage(data, let, table, push, sums):
    """Tables 3-I to 3-IX."""
    n = data.number
    f = "fuselage."
    for name, path in (("lf", "lift_ft2"), ("df", "drag_ft2"), ("mf", "pitching_ft3")):
        table(name, ["alpha"], f + path)
    by_sideslip = {
        "lf_b": "lift_by_sideslip_ft2", "df_b": "drag_by_sideslip_ft2", "mf_b": "pitching_by_sideslip_ft3",
        "yf": "side_ft2", "rf": "rolling_ft3", "nf": "yawing_ft3",
    }  # fmt: skip
    for name, path in by_sideslip.items():
        table(name, ["beta_abs"], f + path)
    let("way", "beta / (beta_abs + 0.000001)")
    let("cos2", "cos(beta / 57.29578) * cos(beta / 57.29578)")
    let(
        "body_lift",
        f"q_all * (lf * cos2 + lf_b + {n(f + 'lift_offset_ft2') + n(f + 'lift_correction_ft2')!r})",
    )
    fixed = n(f + "drag_offset_ft2") + n(f + "drag_correction_ft2") + n(f + "pod_drag_ft2")
    let("body_drag", f"q_all * (df * cos2 + df_b + {fixed!r} + {n(f + 'gear_drag_ft2')!r} * gear)")
    let("body_x", "body_lift * sin_alpha - body_drag * cos_alpha")
    let("body_y", "q_all * yf * way")
    let("body_z", "-body_lift * cos_alpha - body_drag * sin_alpha")
    push(arm_ft(n(f + "centre_in")), x="body_x", y="body_y", z="body_z")
    sums["ROLL"].append("q_all * rf * way")
    sums["PITCH"].append(f"q_all * (mf * cos2 + mf_b + {n(f + 'pitching_offset_ft3')!r}) + spinner_pitch")
    sums["YAW"].append("q_all * nf * way")


def tail(data, let, table, push):
    """Tables 2-I, 2-II, 4-V, 5-I, 5-III and 5-V: wake, downwash, lift, drag and dynamic pressure."""
    n = data.number
    h = "horizontal_stabilizer."
    x, _, z = arm_ft(n(h + "centre_in"))
    three = ("mast_tilt_deg", "alpha_deg", "airspeed_kt")
    table("g", ["tilt", "alpha", "knots"], "rotor_wake.tail_ratio", *three)
    table("g_beta", ["beta_abs", "tilt"], "rotor_wake.sideslip_factor", "beta_deg", "mast_tilt_deg")
    let("wake_tail", "g * g_beta * 0.5 * (inflow_r + inflow_l)")
    let("u_h", f"u + {z!r} * q + wake_tail * sin_tilt")
    let("w_h", f"w - {x!r} * q - wake_tail * cos_tilt")
    let("alpha_flow", "57.29578 * atan2(w_h, u_h)")
    # What the wing sends arrives later: a state of [systems.py] follows it.
    table(
        "eps_wing",
        ["tilt", "alpha_free", "flap"],
        h + "downwash_deg",
        "mast_tilt_deg",
        "alpha_deg",
        "flap_deg",
    )
    let("alpha_h", "alpha_flow - eps")
    table("cl_h", ["alpha_h", "elevator"], h + "lift", "alpha_deg", "elevator_deg")
    table("cd_h", ["alpha_h"], h + "drag")
    table("eta", ["tilt", "alpha", "knots"], h + "pressure_ratio", *three)
    table("k_h", ["tilt"], h + "pressure_factor")
    let("q_h", f"0.5 * rho * {n(h + 'area_ft2')!r} * k_h * eta * (u_h * u_h + w_h * w_h)")
    let("sin_h", "sin(alpha_h / 57.29578)")
    let("cos_h", "cos(alpha_h / 57.29578)")
    let("tail_x", "q_h * (cl_h * sin_h - cd_h * cos_h)")
    let("tail_z", "-q_h * (cl_h * cos_h + cd_h * sin_h)")
    push((x, 0.0, z), x="tail_x", z="tail_z")


def fins(sheet, data, let, table, push):
    """Tables 6-I, 6-III to 6-VIII; the fuselage's sidewash with flaps up and at 40, straight between."""
    n = data.number
    f = "vertical_stabilizers."
    x, y, z = arm_ft(n(f + "centre_in"))
    floor = n(f + "sidewash_speed_ftps_min")
    let("v_f", f"v + {x!r} * r - {z!r} * p")
    let(
        "p_wash",
        f"{n(f + 'sidewash_by_roll_rate')!r} * {n(f + 'wing_span_ft') / 2!r} * p / max(abs(u), {floor!r})",
    )
    let("beta_f", "57.29578 * (atan2(v_f, sqrt(u * u + w * w) + 0.01) - p_wash)")
    let("beta_f_abs", "abs(beta_f)")
    axes, values = fin(data)
    sheet.table("airframe", "cy", ["beta_f", "rudder"], axes, values)
    sheet.table("airframe", "cy_0", ["beta_f"], [axes[0]], [row[axes[1].index(0.0)] for row in values])
    table("cd_f", ["beta_f_abs"], f + "drag")
    table("rotor_wash", ["knots", "beta_f_abs"], f + "rotor_sidewash", "airspeed_kt", "beta_deg")
    for flap in (0, 40):
        table(
            f"wash_{flap}",
            ["tilt", "alpha", "beta_f_abs"],
            f"{f}fuselage_sidewash.flap_{flap}",
            "mast_tilt_deg",
            "alpha_deg",
            "beta_deg",
        )
    let("wash", "wash_0 + (wash_40 - wash_0) * min(1, flap / 40)")
    let("q_f", f"0.5 * rho * {2 * n(f + 'area_ft2')!r} * (u * u + v_f * v_f)")
    let("fin_y", "-q_f * (rotor_wash * wash * cy_0 + cy - cy_0)")
    let("fin_x", "-q_f * rotor_wash * wash * cd_f")
    push((x, 0.0, z), x="fin_x", y="fin_y")
