//! What moves in the world, as columns.

use engine::Outputs;
use engine::frames::{Attitude, Ned, Structural, Vec3};
use engine::landing_gear::Leg;
use engine::math::{cos, sin};
use engine::state::Geodetic;
use rerun::{GeoPoints, LineStrips3D, Quaternion, Transform3D};

use super::airframe::Mounts;
use super::columns::{Columns, point};
use super::forces::{self, ARROWS, Places};
use super::scenery;

/// A point of the path.
#[derive(Clone, Copy)]
pub struct PathPoint {
    /// Centre of gravity.
    pub position_m: Vec3<Ned>,
    ground_z_m: f64,
    place: Geodetic,
    /// RGB of the configuration that it was flown in.
    pub colour: u32,
    /// How many restarts were before it: from one to the next nothing was flown.
    pub start: u32,
}

impl PathPoint {
    /// Where the aircraft is, after so many restarts.
    pub fn new(outputs: &Outputs, start: u32) -> Self {
        Self {
            position_m: outputs.position_m,
            ground_z_m: outputs.position_m.z + outputs.height_above_ground_m,
            place: outputs.place,
            colour: super::modes::configuration(outputs).1,
            start,
        }
    }

    /// Below it.
    pub fn on_ground_m(&self) -> Vec3<Ned> {
        Vec3::new(self.position_m.x, self.position_m.y, self.ground_z_m)
    }

    /// Latitude and longitude.
    pub fn degrees(&self) -> [f64; 2] {
        degrees(&self.place)
    }
}

fn pose(
    rows: &[Outputs],
    position: impl Fn(&Outputs) -> [f32; 3],
    attitude: impl Fn(&Outputs) -> Quaternion,
) -> Columns {
    Transform3D::new()
        .with_many_translation(rows.iter().map(position))
        .with_many_quaternion(rows.iter().map(attitude))
        .columns_of_unit_batches()
        .map(Vec::from_iter)
}

/// Sends everything in the world that moves, with the ground under it or without; one after the other, so that
/// of a long flight no more is in memory at a time.
pub fn send_moving(
    rows: &[Outputs],
    mounts: &Mounts,
    places: &Places,
    ground: bool,
    mut send: impl FnMut(&'static str, Columns),
) {
    let still = |_: &Outputs| Quaternion::IDENTITY;
    let at = |row: &Outputs| point(row.position_m);
    send("world/chase", pose(rows, at, |row| turn(row.euler.heading_rad)));
    send("world/aircraft", pose(rows, at, attitude));
    send("world/aircraft/airframe", pose(rows, datum, still));
    send(forces::WIND, forces::wind_columns(rows));
    let plumb = LineStrips3D::new(rows.iter().map(|row| {
        let below = PathPoint::new(row, 0);
        [point(below.position_m), point(below.on_ground_m())]
    }));
    send("world/plumb", plumb.columns_of_unit_batches().map(Vec::from_iter));
    let track = GeoPoints::from_lat_lon(rows.iter().map(|row| degrees(&row.place)));
    send("map/aircraft", track.columns_of_unit_batches().map(Vec::from_iter));
    nacelle_columns(rows, mounts).into_iter().for_each(|(entity, of)| send(entity, of));
    gear_columns(rows, mounts).into_iter().for_each(|(entity, of)| send(entity, of));
    for hinge in &mounts.hinges {
        let turned = |row: &Outputs| about(hinge.axis, (hinge.angle_rad)(row));
        send(hinge.entity, pose(rows, |_| hinge.at, turned));
    }
    ARROWS.iter().for_each(|arrows| send(arrows.entity, arrows.columns(rows, places)));
    if ground {
        let under = |step_m| move |row: &Outputs| under(row, step_m);
        send("world/ground", pose(rows, under(scenery::PLANE_STEP_M), still));
        send("world/grid", pose(rows, under(scenery::GRID_STEP_M), still));
    }
}

/// Nacelles on their pivots, tip path planes on the masts, blades in the planes.
fn nacelle_columns(rows: &[Outputs], mounts: &Mounts) -> [(&'static str, Columns); 6] {
    let hub = |_: &Outputs| mounts.hub();
    let there = |_: &Outputs| [0.0; 3];
    [
        (
            "world/aircraft/airframe/nacelle_left",
            pose(rows, |_| mounts.pivots.left, |row| tilt(row.actuators.mast_tilt_rad.left)),
        ),
        (
            "world/aircraft/airframe/nacelle_right",
            pose(rows, |_| mounts.pivots.right, |row| tilt(row.actuators.mast_tilt_rad.right)),
        ),
        (
            "world/aircraft/airframe/nacelle_left/tip_path_left",
            pose(rows, hub, |row| {
                let rotor = &row.rotors.left;
                flapped(rotor.tilt_aft_rad, -rotor.tilt_outboard_rad)
            }),
        ),
        (
            "world/aircraft/airframe/nacelle_right/tip_path_right",
            pose(rows, hub, |row| {
                let rotor = &row.rotors.right;
                flapped(rotor.tilt_aft_rad, rotor.tilt_outboard_rad)
            }),
        ),
        (
            "world/aircraft/airframe/nacelle_left/tip_path_left/rotor_left",
            pose(rows, there, |row| turn(row.rotor_azimuth_rad)),
        ),
        (
            "world/aircraft/airframe/nacelle_right/tip_path_right/rotor_right",
            pose(rows, there, |row| turn(-row.rotor_azimuth_rad)),
        ),
    ]
}

/// Each leg: retracted it is inside the fuselage and its pods, on the ground it is pressed in.
fn gear_columns(rows: &[Outputs], mounts: &Mounts) -> [(&'static str, Columns); 3] {
    let leg = |of: fn(&Outputs) -> &Leg| {
        let up = move |row: &Outputs| {
            let retracted = 1.0 - row.actuators.gear_extension_norm;
            let up_m = retracted * f64::from(mounts.gear_travel_m) + of(row).compression_m;
            [0.0, 0.0, -up_m as f32]
        };
        Transform3D::new()
            .with_many_translation(rows.iter().map(up))
            .columns_of_unit_batches()
            .map(Vec::from_iter)
    };
    [
        ("world/aircraft/airframe/gear_nose", leg(|row| &row.landing_gear.nose)),
        ("world/aircraft/airframe/gear_left", leg(|row| &row.landing_gear.main.left)),
        ("world/aircraft/airframe/gear_right", leg(|row| &row.landing_gear.main.right)),
    ]
}

fn degrees(place: &Geodetic) -> [f64; 2] {
    [place.latitude_rad.to_degrees(), place.longitude_rad.to_degrees()]
}

fn attitude(outputs: &Outputs) -> Quaternion {
    let Attitude { w, x, y, z } = Attitude::from_euler(outputs.euler);
    Quaternion::from_xyzw([x as f32, y as f32, z as f32, w as f32])
}

/// On the ground under the aircraft, to whole steps: what repeats every step seems to stand still.
fn under(outputs: &Outputs, step_m: f64) -> [f32; 3] {
    let Vec3 { x, y, z, .. } = PathPoint::new(outputs, 0).on_ground_m();
    let whole = |along_m: f64| (along_m / step_m).round() * step_m;
    point(Vec3::<Ned>::new(whole(x), whole(y), z))
}

/// Where the drawing's datum is, in body axes.
fn datum(outputs: &Outputs) -> [f32; 3] {
    point(Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m))
}

/// A nacelle: tilting forward is a turn about −y.
fn tilt(mast_tilt_rad: f64) -> Quaternion {
    let half_rad = -0.5 * mast_tilt_rad;
    Quaternion::from_xyzw([0.0, sin(half_rad) as f32, 0.0, cos(half_rad) as f32])
}

/// About z, down: a rotor on its mast, a heading.
fn turn(angle_rad: f64) -> Quaternion {
    let half_rad = 0.5 * angle_rad;
    Quaternion::from_xyzw([0.0, 0.0, sin(half_rad) as f32, cos(half_rad) as f32])
}

/// The tip path plane on its mast: aft is a turn about y, right one about x; both are small.
fn flapped(aft_rad: f64, right_rad: f64) -> Quaternion {
    let (x, y) = (sin(0.5 * right_rad), sin(0.5 * aft_rad));
    let w = engine::math::sqrt(1.0 - x * x - y * y);
    Quaternion::from_xyzw([x as f32, y as f32, 0.0, w as f32])
}

/// A turn about an axis.
fn about(axis: [f64; 3], angle_rad: f64) -> Quaternion {
    let (s, c) = (sin(0.5 * angle_rad), cos(0.5 * angle_rad));
    let [x, y, z] = axis.map(|along| (s * along) as f32);
    Quaternion::from_xyzw([x, y, z, c as f32])
}
