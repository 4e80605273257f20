//! What does not move in the world, and the path at the end.

use engine::aircraft::Params as Aircraft;
use rerun::{
    GeoLineStrings, GeoPoints, LineStrips3D, Radius, RecordingStream, RecordingStreamResult,
    StateConfiguration, ViewCoordinates,
};

use super::airframe;
use super::basics::SIDES;
use super::columns::point;
use super::forces::{self, ARROWS};
use super::look::Look;
use super::modes::MODES;
use super::plots::{GRAPHS, Graph, TIMES};
use super::scene::PathPoint;
use super::solid::{Point, Solid};
use super::{corridor, scenery, surfaces};

/// Posts under the path, at most.
const POSTS_MAX: usize = 60;

/// Sends what does not move: shapes, colours, names.
pub fn send_static_scene(
    recording: &RecordingStream,
    look: &Look,
    aircraft: &Aircraft,
) -> RecordingStreamResult<()> {
    let entity = |name: &str| look.entity(name);
    recording.log_static(entity("world"), &ViewCoordinates::FRD())?;
    if look.ground {
        recording.log_static(entity("world/ground"), &scenery::plane())?;
        recording.log_static(entity("world/ground/lines"), &scenery::far_lines())?;
        recording.log_static(entity("world/grid"), &scenery::near_lines())?;
        recording.log_static(entity("world/pad"), &scenery::pad())?;
    }
    send_aircraft(recording, look, aircraft)?;
    for arrows in ARROWS {
        recording.log_static(entity(arrows.entity), &arrows.still())?;
    }
    if look.ground {
        recording.log_static(entity(forces::SCALE), &forces::scale())?;
    }
    recording.log_static(entity(forces::WIND), &forces::still_wind())?;
    recording.log_static(
        entity("world/flown"),
        &LineStrips3D::update_fields().with_radii([Radius::new_ui_points(3.0)]),
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
    send_graphs(recording, look, GRAPHS, "")?;
    send_graphs(recording, look, TIMES, "")?;
    corridor::send_still(recording, look, aircraft)?;
    for mode in MODES.iter() {
        let (values, colours): (Vec<&str>, Vec<u32>) = mode.values.iter().copied().unzip();
        recording.log_static(
            entity(&mode.path),
            &StateConfiguration::new()
                .with_values(values)
                .with_labels(mode.labels(aircraft))
                .with_colors(colours),
        )?;
    }
    Ok(())
}

/// Names, colours and widths of every line of some graphs.
pub fn send_graphs<T>(
    recording: &RecordingStream,
    look: &Look,
    graphs: &[Graph<T>],
    mark: &str,
) -> RecordingStreamResult<()> {
    for graph in graphs {
        let lines = graph.lines.iter();
        recording.log_static(
            look.entity(graph.entity),
            &rerun::SeriesLines::new()
                .with_names(lines.clone().map(|line| format!("{}{mark}{}", look.name, line.name)))
                .with_colors(lines.clone().map(|line| line.colour & look.line_mask))
                .with_widths(lines.map(|line| line.width + look.line_width)),
        )?;
    }
    Ok(())
}

/// The shapes, each where it is mounted.
fn send_aircraft(
    recording: &RecordingStream,
    look: &Look,
    aircraft: &Aircraft,
) -> RecordingStreamResult<()> {
    let tinted = |solid: Solid| solid.mesh().with_albedo_factor(look.tint);
    let below = |name: &str| look.entity(&format!("world/aircraft/airframe/{name}"));
    recording.log_static(
        look.entity("world/aircraft/airframe"),
        &tinted(airframe::airframe(aircraft)),
    )?;
    let gear = airframe::gear(aircraft);
    recording.log_static(below("gear_nose"), &tinted(gear.nose))?;
    recording.log_static(below("gear_left"), &tinted(gear.main.left))?;
    recording.log_static(below("gear_right"), &tinted(gear.main.right))?;
    for surface in surfaces::surfaces(aircraft) {
        recording.log_static(below(surface.name), &tinted(surface.solid))?;
    }
    for (side, colour) in [("left", SIDES.left), ("right", SIDES.right)] {
        let nacelle = below(&format!("nacelle_{side}"));
        recording.log_static(nacelle.as_str(), &tinted(airframe::nacelle(aircraft)))?;
        let plane = format!("{nacelle}/tip_path_{side}");
        recording.log_static(format!("{plane}/disc"), &airframe::disc(aircraft, colour))?;
        let rotor = format!("{plane}/rotor_{side}");
        recording.log_static(rotor.as_str(), &tinted(airframe::blades(aircraft)))?;
    }
    Ok(())
}

/// Sends what is known only at the end: the whole path, a strip for each stretch of a configuration.
pub fn send_path(
    recording: &RecordingStream,
    trail: &[PathPoint],
    look: &Look,
) -> RecordingStreamResult<()> {
    let mut strips: Vec<Vec<Point>> = Vec::new();
    let mut colours: Vec<u32> = Vec::new();
    let mut before: Option<&PathPoint> = None;
    for stretch in trail.chunk_by(|a, b| a.colour == b.colour && a.start == b.start) {
        // It begins where the one before ended, unless that was of another start.
        let joint = before.filter(|before| before.start == stretch[0].start);
        let strip = joint.into_iter().chain(stretch).map(|at| point(at.position_m)).collect();
        before = stretch.last();
        strips.push(strip);
        colours.push(look.trail(stretch[0].colour, 0xFF));
    }
    recording.log_static(
        look.entity("world/path"),
        &LineStrips3D::new(strips).with_radii([Radius::new_ui_points(1.2)]).with_colors(colours),
    )?;
    let spacing = (trail.len() / POSTS_MAX).max(20);
    let posts = trail.iter().step_by(spacing);
    recording.log_static(
        look.entity("world/path/posts"),
        &LineStrips3D::new(posts.map(|at| [point(at.position_m), point(at.on_ground_m())]))
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([look.path | 0x60]),
    )?;
    recording.log_static(
        look.entity("map/track"),
        &GeoLineStrings::from_lat_lon(
            trail
                .chunk_by(|a, b| a.start == b.start)
                .map(|stretch| stretch.iter().map(PathPoint::degrees)),
        )
        .with_radii([Radius::new_ui_points(1.5)])
        .with_colors([look.path | 0xFF]),
    )
}
