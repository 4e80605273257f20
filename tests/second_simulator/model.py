"""The second simulator: JSBSim with two of its own rotors, an airframe and systems written for it.

`write` makes the aircraft's files; `Simulator` flies them. Outside of JSBSim's frame everything is SI, rad and
the names of the project; nothing here computes a force.
"""

import math
import os
from pathlib import Path

os.environ.setdefault("JSBSIM_DEBUG", "0")
import jsbsim

import airframe
import systems
from sheet import STEP_S, Sheet

FOOT_M = 0.3048
KNOT_MPS = 0.514444
LBF_FT_N_M = 1.355818
G_FTPS2 = 32.174
POUND_KG = 0.45359237

KNOWN = {
    "u": "velocities/u-aero-fps", "v": "velocities/v-aero-fps", "w": "velocities/w-aero-fps",
    "p": "velocities/p-aero-rad_sec", "q": "velocities/q-aero-rad_sec", "r": "velocities/r-aero-rad_sec",
    "vt": "velocities/vtrue-fps", "knots": "velocities/vtrue-kts", "rho": "atmosphere/rho-slugs_ft3",
    "qbar": "aero/qbar-psf", "phi": "attitude/phi-rad", "theta": "attitude/theta-rad",
    "inflow_r": "propulsion/engine[0]/vi-fps", "inflow_l": "propulsion/engine[1]/vi-fps",
    "thrust_r": "propulsion/engine[0]/thrust-lbs", "thrust_l": "propulsion/engine[1]/thrust-lbs",
    "torque_r": "propulsion/engine[0]/torque-lbsft", "torque_l": "propulsion/engine[1]/torque-lbsft",
}  # fmt: skip

# The reference model's blade: 41 deg of twist in a straight line. [CR536, as KH has it]
TWIST_DEG = -41.0
ROOT_FROM_THREE_QUARTERS_DEG = -0.75 * TWIST_DEG
LOCK_NUMBER = 3.83  # TMX 3.7: with the chord and the flapping inertia it makes the lift slope, 5.8
SEA_LEVEL_SLUG_FT3 = 0.0023769
TIP_LOSS = 0.97  # an estimate, the usual value of textbooks
INFLOW_LAG_S = 0.1  # an estimate, for hover
WEIGHT_LB = 13000.0


def rotor(data):
    """One rotor for JSBSim's FGRotor."""
    n = data.number
    radius, chord = n("rotors.radius_ft"), data.line("rotors.blade.blade_chord_in")[1][-1] / 12
    inertia = n("rotors.flapping.blade_inertia_slug_ft2")
    slope = LOCK_NUMBER * inertia / (SEA_LEVEL_SLUG_FT3 * chord * radius**4)
    first = 1.5 * inertia / radius  # of a uniform blade
    # A hub spring as a hinge offset: 1/2 e N M_b Ω² = K_H, at the helicopter's speed.
    omega = n("fcc.governor.rotor_speed_rpm")[0] * math.pi / 30
    spring = n("rotors.flapping.hub_spring_ft_lbf_per_deg") * 180 / math.pi
    offset = spring / (0.5 * n("rotors.blade.count") * first * omega**2)
    return f"""<?xml version="1.0"?>
<rotor name="rotor"><diameter unit="FT">{2 * radius}</diameter><numblades>{n("rotors.blade.count"):.0f}</numblades>
<gearratio>1</gearratio><nominalrpm>589</nominalrpm><minrpm>50</minrpm><maxrpm>700</maxrpm>
<chord unit="FT">{chord}</chord><liftcurveslope>{slope}</liftcurveslope><twist unit="DEG">{TWIST_DEG}</twist>
<hingeoffset unit="FT">{offset}</hingeoffset><flappingmoment unit="SLUG*FT2">{inertia}</flappingmoment>
<massmoment>{first}</massmoment><polarmoment unit="SLUG*FT2">{3 * inertia}</polarmoment>
<inflowlag>{INFLOW_LAG_S}</inflowlag><tiplossfactor>{TIP_LOSS}</tiplossfactor><ExternalRPM>-1</ExternalRPM></rotor>"""


def masses(data):
    """The airframe's mass balance, so that with the tilting masses upright all is as published."""
    n = data.number
    cg, ratio = n("weight_balance.cg_in"), n("weight_balance.tilting_mass_ratio")
    tip = n("weight_balance.tilting_cg_in")
    y = n("rotors.pivot_in")[1]
    moving = ratio * WEIGHT_LB
    rest = WEIGHT_LB - moving
    base = [(WEIGHT_LB * cg[0] - moving * tip[0]) / rest, 0.0, (WEIGHT_LB * cg[2] - moving * tip[2]) / rest]

    def about(point, pounds, side):
        x, z = (point[0] - cg[0]) / 12, (point[2] - cg[2]) / 12
        slug = pounds / G_FTPS2
        return slug * (side**2 + z**2), slug * (x**2 + z**2), slug * (x**2 + side**2), slug * -x * -z

    mine = [a + b for a, b in zip(about(tip, moving, y / 12), about(base, rest, 0.0))]
    whole = [n(f"weight_balance.inertia.{axis}_slug_ft2") for axis in ("xx", "yy", "zz", "xz")]
    xx, yy, zz, xz = (a - b for a, b in zip(whole, mine))
    point = "".join(
        f'<pointmass name="nacelle{i}"><weight unit="LBS">{moving / 2}</weight><location unit="IN"><x>{tip[0]}</x>'
        f"<y>{side * y}</y><z>{tip[2]}</z></location></pointmass>"
        for i, side in enumerate((1, -1))
    )
    return (
        '<mass_balance negated_crossproduct_inertia="false">'
        f'<ixx unit="SLUG*FT2">{xx}</ixx><iyy unit="SLUG*FT2">{yy}</iyy><izz unit="SLUG*FT2">{zz}</izz>'
        f'<ixz unit="SLUG*FT2">{xz}</ixz><emptywt unit="LBS">{rest}</emptywt>'
        f'<location name="CG" unit="IN"><x>{base[0]}</x><y>0</y><z>{base[2]}</z></location>{point}</mass_balance>'
    )


def legs(data):
    """Three of JSBSim's own landing legs where the published ones stand."""
    n = data.number
    text = ""
    for name, path, side in (("nose", "nose", 0), ("left", "main", -1), ("right", "main", 1)):
        p = f"landing_gear.{path}."
        x, y, z = n(p + "tyre_in")
        text += (
            f'<contact type="BOGEY" name="{name}"><location unit="IN"><x>{x}</x><y>{side * y}</y><z>{z}</z></location>'
            f"<static_friction>0.8</static_friction><dynamic_friction>{n(p + 'sideways_friction')}</dynamic_friction>"
            f"<rolling_friction>{n(p + 'rolling_friction')}</rolling_friction>"
            f'<spring_coeff unit="LBS/FT">{n(p + "stiffness_lbf_per_ft")}</spring_coeff>'
            f'<damping_coeff unit="LBS/FT/SEC">{n(p + "damping_lbf_s_per_ft")}</damping_coeff>'
            '<max_steer unit="DEG">0</max_steer><brake_group>NONE</brake_group><retractable>1</retractable></contact>'
        )
    return text


def write(folder, data):
    """Writes the aircraft below a folder, and returns where its values are, and its states' beginning."""
    sheet = Sheet(KNOWN)
    sheet.path["root_from_three_quarters"] = "xv/root"
    systems.write(sheet, data)
    sums = airframe.write(sheet, data)
    n = data.number
    pivot, mast = n("rotors.pivot_in"), 12 * n("rotors.mast_length_ft")
    start = {sheet.path[name]: value for name, value in sheet.states.items()}
    start["xv/root"] = ROOT_FROM_THREE_QUARTERS_DEG
    properties = "".join(f'<property value="{value}">{path}</property>' for path, value in start.items())
    engines = "".join(
        f'<engine file="shaft"><feed>0</feed><thruster file="rotor"><sense>{sign}</sense><location unit="IN">'
        f"<x>{pivot[0]}</x><y>{sign * pivot[1]}</y><z>{pivot[2] + mast}</z></location>"
        '<orient unit="DEG"><roll>0</roll><pitch>90</pitch><yaw>0</yaw></orient></thruster></engine>'
        for sign in (1, -1)
    )
    axes = "".join(
        f'<axis name="{axis}"><function name="aero/sum-{axis.lower()}">'
        f"{sheet.spell(' + '.join(terms))}</function></axis>"
        for axis, terms in sums.items()
    )
    x, y, z = airframe.REFERENCE_IN
    text = f"""<?xml version="1.0"?>
<fdm_config name="xv15" version="2.0" release="ALPHA">
<metrics><wingarea unit="FT2">{n("wing_pylon.area_ft2")}</wingarea>
<wingspan unit="FT">{n("wing_pylon.span_ft")}</wingspan>
<chord unit="FT">{n("wing_pylon.chord_ft")}</chord>
<location name="AERORP" unit="IN"><x>{x}</x><y>{y}</y><z>{z}</z></location></metrics>
{masses(data)}
<ground_reactions>{legs(data)}</ground_reactions>
<propulsion>{engines}<tank type="FUEL"><location unit="IN"><x>300</x><y>0</y><z>82</z></location>
<capacity unit="LBS">1</capacity><contents unit="LBS">0</contents></tank></propulsion>
<flight_control name="systems">{properties}
<channel name="systems">{"".join(sheet.lines["systems"])}</channel></flight_control>
<aerodynamics>{"".join(sheet.lines["airframe"])}{axes}</aerodynamics>
</fdm_config>"""
    aircraft, engine = Path(folder) / "aircraft" / "xv15", Path(folder) / "engine"
    aircraft.mkdir(parents=True, exist_ok=True)
    engine.mkdir(exist_ok=True)
    (aircraft / "xv15.xml").write_text(text)
    (engine / "rotor.xml").write_text(rotor(data))
    (engine / "shaft.xml").write_text(
        '<?xml version="1.0"?><electric_engine name="shaft"><power unit="WATTS">1</power></electric_engine>'
    )
    return sheet.path, start


class Simulator:
    """JSBSim, told what to do in the project's names."""

    def __init__(self, folder, data):
        self.path, self.begin = write(folder, data)
        self.fdm = jsbsim.FGFDMExec(str(folder))
        self.fdm.set_debug_level(0)
        self.fdm.set_aircraft_path("aircraft")
        self.fdm.set_engine_path("engine")
        self.fdm.set_dt(STEP_S)
        if not self.fdm.load_model("xv15"):
            raise RuntimeError("JSBSim does not read the aircraft that was written for it")
        self.rated_w = 2 * 745.7 * data.number("engines.rated_power_hp")
        self.latitude = math.radians(19.721359)

    def __getitem__(self, name):
        return self.fdm[self.path.get(name, name)]

    def __setitem__(self, name, value):
        self.fdm[self.path.get(name, name)] = value

    def place(self, body_mps, euler_rad, rates_radps=(0, 0, 0), height_m=30.0, ground_m=0.0):
        """Begins there; blades, masts and rotor speed are what the states say. Heights of the centre of gravity."""
        fdm = self.fdm
        fdm["ic/terrain-elevation-ft"] = ground_m / FOOT_M
        fdm["ic/lat-geod-deg"] = math.degrees(self.latitude)
        fdm["ic/long-gc-deg"] = -155.029302
        fdm["ic/h-sl-ft"] = height_m / FOOT_M
        for name, value in zip(("phi-rad", "theta-rad", "psi-true-rad"), euler_rad):
            fdm[f"ic/{name}"] = value
        for name, value in zip("uvw", body_mps):
            fdm[f"ic/{name}-fps"] = value / FOOT_M
        for name, value in zip("pqr", rates_radps):
            fdm[f"ic/{name}-rad_sec"] = value
        self["running"] = 0.0
        fdm.run_ic()
        self.start = fdm["position/lat-geod-rad"], fdm["position/long-gc-rad"]

    def settle(self, frames=100):
        """Lets inflow and downwash come to rest while nothing moves."""
        self["running"] = 0.0
        self.fdm.suspend_integration()
        for _ in range(frames):
            self["eps"] = self["eps_wing"]
            self.fdm.run()
        self.fdm.resume_integration()

    def accelerations(self):
        """Of the body, ft/s2 and rad/s2: u, v, w, p, q, r."""
        names = (
            "udot-ft_sec2",
            "vdot-ft_sec2",
            "wdot-ft_sec2",
            "pdot-rad_sec2",
            "qdot-rad_sec2",
            "rdot-rad_sec2",
        )
        return [self.fdm["accelerations/" + name] for name in names]

    def power_w(self):
        """What both rotors take."""
        return (self["torque_r"] + self["torque_l"]) * LBF_FT_N_M * self["rotor_radps"]

    def position_m(self):
        """North and east of the start, down from the ground."""
        lat, lon = self.fdm["position/lat-geod-rad"], self.fdm["position/long-gc-rad"]
        a, e2 = 6378137.0, 0.00669438
        across = 1 - e2 * math.sin(lat) ** 2
        return (
            (lat - self.start[0]) * a * (1 - e2) / across**1.5,
            (lon - self.start[1]) * a / math.sqrt(across) * math.cos(lat),
            -self.fdm["position/h-agl-ft"] * FOOT_M,
        )
