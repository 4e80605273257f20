//! What is in the world: what moves as columns, what stands still, and the path at the end.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::frames::{Attitude, Body, Ned, Structural, Vec3};
use engine::math::{cos, sin};
use engine::pair::Pair;
use engine::state::Geodetic;
use rerun::{
    Arrows3D, GeoLineStrings, GeoPoints, LineStrips3D, Quaternion, Radius, RecordingStream,
    RecordingStreamResult, SerializedComponentColumn, StateConfiguration, Transform3D,
    ViewCoordinates,
};

use super::airframe::Mounts;
use super::plots::{MODES, PLOTS};
use super::solid::Solid;
use super::track::Look;
use super::{SIDES, airframe, scenery};

/// Posts under the path, at most.
const POSTS_MAX: usize = 60;
/// An arrow is this long per newton: a rotor that hovers has one of 4 m.
const ARROW_M_PER_N: f64 = 1.0 / 7000.0;

/// A point of the path.
#[derive(Clone, Copy)]
pub struct PathPoint {
    /// Centre of gravity.
    pub position_m: Vec3<Ned>,
    ground_z_m: f64,
    place: Geodetic,
}

impl PathPoint {
    /// Where the aircraft is.
    pub fn new(outputs: &Outputs) -> Self {
        Self {
            position_m: outputs.position_m,
            ground_z_m: outputs.position_m.z + outputs.height_above_ground_m,
            place: outputs.place,
        }
    }

    fn on_ground_m(&self) -> Vec3<Ned> {
        Vec3::new(self.position_m.x, self.position_m.y, self.ground_z_m)
    }
}

/// What to send of some rows.
pub type Columns = rerun::SerializationResult<Vec<SerializedComponentColumn>>;

/// Everything in the world that moves, with the ground under it or without.
pub fn moving_columns(
    rows: &[Outputs],
    mounts: &Mounts,
    ground: bool,
) -> Vec<(&'static str, Columns)> {
    let pose = |position: &dyn Fn(&Outputs) -> [f32; 3], attitude: fn(&Outputs) -> Quaternion| {
        Transform3D::new()
            .with_many_translation(rows.iter().map(position))
            .with_many_quaternion(rows.iter().map(attitude))
            .columns_of_unit_batches()
            .map(Vec::from_iter)
    };
    let thrust = |hub: &dyn Fn(&Outputs) -> Vec3<Body>, force: fn(&Outputs) -> Vec3<Body>| {
        Arrows3D::from_vectors(rows.iter().map(|row| point(force(row) * ARROW_M_PER_N)))
            .with_origins(rows.iter().map(|row| point(hub(row))))
            .columns_of_unit_batches()
            .map(Vec::from_iter)
    };
    let plumb = LineStrips3D::new(rows.iter().map(|row| {
        let below = PathPoint::new(row);
        [point(below.position_m), point(below.on_ground_m())]
    }));
    let track = GeoPoints::from_lat_lon(rows.iter().map(|row| degrees(&row.place)));
    let mut columns = vec![
        ("world/chase", pose(&|row| point(row.position_m), |row| turn(row.euler.heading_rad))),
        ("world/aircraft", pose(&|row| point(row.position_m), attitude)),
        ("world/aircraft/airframe", pose(&datum, |_| Quaternion::IDENTITY)),
        (
            "world/aircraft/airframe/nacelle_left",
            pose(&|_| mounts.pivots.left, |row| tilt(row.actuators.mast_tilt_rad.left)),
        ),
        (
            "world/aircraft/airframe/nacelle_right",
            pose(&|_| mounts.pivots.right, |row| tilt(row.actuators.mast_tilt_rad.right)),
        ),
        (
            "world/aircraft/airframe/nacelle_left/rotor_left",
            pose(&|_| mounts.hub(), |row| turn(row.rotor_azimuth_rad)),
        ),
        (
            "world/aircraft/airframe/nacelle_right/rotor_right",
            pose(&|_| mounts.hub(), |row| turn(-row.rotor_azimuth_rad)),
        ),
        ("world/aircraft/airframe/gear", pose(&|row| gear(mounts, row), |_| Quaternion::IDENTITY)),
        (
            "world/aircraft/thrust_left",
            thrust(&|row| hub(mounts, row).left, |row| row.rotors.left.load.force_n),
        ),
        (
            "world/aircraft/thrust_right",
            thrust(&|row| hub(mounts, row).right, |row| row.rotors.right.load.force_n),
        ),
        ("world/plumb", plumb.columns_of_unit_batches().map(Vec::from_iter)),
        ("map/aircraft", track.columns_of_unit_batches().map(Vec::from_iter)),
    ];
    if ground {
        let plane = pose(&|row| under(row, scenery::PLANE_STEP_M), |_| Quaternion::IDENTITY);
        let grid = pose(&|row| under(row, scenery::GRID_STEP_M), |_| Quaternion::IDENTITY);
        columns.extend([("world/ground", plane), ("world/grid", grid)]);
    }
    columns
}

/// As rerun takes it.
pub fn point<F>(v: Vec3<F>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
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
    let Vec3 { x, y, z, .. } = PathPoint::new(outputs).on_ground_m();
    let whole = |along_m: f64| (along_m / step_m).round() * step_m;
    point(Vec3::<Ned>::new(whole(x), whole(y), z))
}

/// Where the drawing's datum is, in body axes.
fn datum(outputs: &Outputs) -> [f32; 3] {
    point(Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m))
}

/// The hubs, in body axes.
fn hub(mounts: &Mounts, outputs: &Outputs) -> Pair<Vec3<Body>> {
    let datum = Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m);
    mounts.pivots.zip(outputs.actuators.mast_tilt_rad).map(|([x, y, z], tilt_rad)| {
        let pivot = datum + Vec3::new(f64::from(x), f64::from(y), f64::from(z));
        pivot + Vec3::new(sin(tilt_rad), 0.0, -cos(tilt_rad)) * mounts.mast_m
    })
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

/// The gear: retracted it is inside the fuselage and its pods.
fn gear(mounts: &Mounts, outputs: &Outputs) -> [f32; 3] {
    let up = 1.0 - outputs.actuators.gear_extension_norm;
    [0.0, 0.0, -up as f32 * mounts.gear_travel_m]
}

/// Sends what does not move: shapes, colours, names.
pub fn send_still_life(
    recording: &RecordingStream,
    look: &Look,
    aircraft: &Aircraft,
) -> RecordingStreamResult<()> {
    let entity = |name: &str| format!("{}{name}", look.root);
    recording.log_static(entity("world"), &ViewCoordinates::FRD())?;
    if look.ground {
        recording.log_static(entity("world/ground"), &scenery::plane())?;
        recording.log_static(entity("world/ground/lines"), &scenery::far_lines())?;
        recording.log_static(entity("world/grid"), &scenery::near_lines())?;
        recording.log_static(entity("world/pad"), &scenery::pad())?;
    }
    let tinted = |solid: Solid| solid.mesh().with_albedo_factor(look.tint);
    recording
        .log_static(entity("world/aircraft/airframe"), &tinted(airframe::airframe(aircraft)))?;
    recording
        .log_static(entity("world/aircraft/airframe/gear"), &tinted(airframe::gear(aircraft)))?;
    for (side, colour) in [("left", SIDES.left), ("right", SIDES.right)] {
        let nacelle = entity(&format!("world/aircraft/airframe/nacelle_{side}"));
        recording.log_static(nacelle.as_str(), &tinted(airframe::nacelle(aircraft)))?;
        let rotor = format!("{nacelle}/rotor_{side}");
        recording.log_static(rotor.as_str(), &tinted(airframe::blades(aircraft)))?;
        recording.log_static(format!("{rotor}/disc"), &airframe::disc(aircraft, colour))?;
        recording.log_static(
            entity(&format!("world/aircraft/thrust_{side}")),
            &Arrows3D::update_fields().with_radii([0.11]).with_colors([colour]),
        )?;
    }
    recording.log_static(
        entity("world/flown"),
        &LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(2.5)])
            .with_colors([look.flown]),
    )?;
    recording.log_static(
        entity("world/plumb"),
        &LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(0.7)])
            .with_colors([0xFF_FF_FF_90]),
    )?;
    recording.log_static(
        entity("map/aircraft"),
        &GeoPoints::update_fields()
            .with_radii([Radius::new_ui_points(7.0)])
            .with_colors([look.flown]),
    )?;
    for plot in PLOTS {
        recording.log_static(
            entity(plot.path),
            &rerun::SeriesLines::new()
                .with_names([format!("{}{}", look.name, plot.name)])
                .with_colors([plot.colour & look.line_mask])
                .with_widths([plot.width + look.line_width]),
        )?;
    }
    for mode in MODES.iter() {
        let (values, colours): (Vec<&str>, Vec<u32>) = mode.values.iter().copied().unzip();
        recording.log_static(
            entity(&mode.path),
            &StateConfiguration::new().with_values(values).with_colors(colours),
        )?;
    }
    Ok(())
}

/// Sends what is known only at the end: the whole path.
pub fn send_path(
    recording: &RecordingStream,
    trail: &[PathPoint],
    look: &Look,
) -> RecordingStreamResult<()> {
    let entity = |name: &str| format!("{}{name}", look.root);
    let path = trail.iter().map(|at| point(at.position_m));
    recording.log_static(
        entity("world/path"),
        &LineStrips3D::new([path.collect::<Vec<_>>()])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_colors([look.path | 0xFF]),
    )?;
    let spacing = (trail.len() / POSTS_MAX).max(20);
    let posts = trail.iter().step_by(spacing);
    recording.log_static(
        entity("world/path/posts"),
        &LineStrips3D::new(posts.map(|at| [point(at.position_m), point(at.on_ground_m())]))
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([look.path | 0x60]),
    )?;
    recording.log_static(
        entity("map/track"),
        &GeoLineStrings::from_lat_lon([trail.iter().map(|at| degrees(&at.place))])
            .with_radii([Radius::new_ui_points(1.5)])
            .with_colors([look.path | 0xFF]),
    )
}
