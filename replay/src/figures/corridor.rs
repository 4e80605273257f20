//! The conversion corridor, and how the flight went through it.

use chart::page::Anchor;
use chart::plane::{Area, Label, Plane};
use chart::{Colour, Curve, Look, Pen};
use engine::units::{degrees, knots};

use super::flight::{Flight, Row};
use super::list::Figure;
use super::look;

/// The corridor's inside.
const INSIDE: Colour = Colour(0xE3, 0xEF, 0xE6);
/// Steps of a limit between two corners: its corners are all there is, but the stops lie between some.
const CORNERS: usize = 64;

/// Airspeed over nacelle incidence, as pilots' charts have it.
pub fn plane(flights: &[&Flight]) -> Plane {
    let limits = flights.first().map_or_else(Limits::default, |flight| Limits::of(flight));
    let mut curves = limits.curves();
    let mut outside = Vec::new();
    for (of, flight) in flights.iter().enumerate() {
        let pen = look::pen(of, flights.len() == 1, false);
        curves.push(Curve::line(track_name(flights, of), pen, track(flight, |_| true)));
        let beyond = |row: &Row| row.flying && margin_kt(flight, row) < 0.0;
        outside.push(Curve::line(
            "outside the corridor",
            Pen::solid(look::ALARM, 2.4),
            track(flight, beyond),
        ));
    }
    outside.retain(|curve| curve.points.iter().any(|point| point[0].is_finite()));
    curves.extend(outside);
    let least: Vec<Option<Least>> = flights.iter().map(|flight| Least::of(flight)).collect();
    for (of, least) in least.iter().enumerate() {
        curves.extend(least.as_ref().map(|least| Curve {
            name: least.words(&look::name(flights, of, "least margin")),
            look: Look::Dots(look::ALARM, 3.0),
            points: vec![least.at],
        }));
    }
    let places = flights.iter().map(|flight| {
        let (chosen, _) = flight.moments();
        chosen.into_iter().filter_map(|moment| flight.row_at(moment.tick)).map(point).collect()
    });
    Plane {
        title: Figure::Corridor.facts().words.into(),
        subtitle: look::subtitle(
            flights,
            "limits of the aircraft's file, level flight; arrows show which way",
        ),
        axes: [
            "Calibrated airspeed, kt".into(),
            "Nacelle incidence, deg (90 helicopter, 0 aeroplane)".into(),
        ],
        equal: false,
        least: [40.0, 20.0],
        with: vec![[0.0, 0.0]],
        upright: Some((-6.0, 102.0)),
        areas: vec![Area { edge: limits.edge(), colour: INSIDE, ink: 1.0 }],
        labels: limits.labels(),
        directed: (0..flights.len()).map(|of| track_name(flights, of)).collect(),
        curves,
        places: places.collect(),
        moments: look::moments(flights),
    }
}

fn track_name(flights: &[&Flight], of: usize) -> String {
    if flights.len() > 1 { flights[of].name.clone() } else { "flown".into() }
}

fn point(row: &Row) -> [f64; 2] {
    [knots(row.calibrated_airspeed_mps), row.incidence_deg]
}

/// How far inside the corridor, kt; negative outside.
fn margin_kt(flight: &Flight, row: &Row) -> f64 {
    let tilt_rad = engine::units::radians(90.0 - row.incidence_deg);
    knots(flight.corridor.margin_mps(tilt_rad, row.calibrated_airspeed_mps))
}

/// Where a flight was nearest to a limit of its corridor.
struct Least {
    margin_kt: f64,
    at_s: f64,
    at: [f64; 2],
}

impl Least {
    /// Of a flight that was in the air where the corridor is asked for.
    fn of(flight: &Flight) -> Option<Self> {
        let margins = flight.rows.iter().filter(|row| row.flying);
        let margins = margins.map(|row| Self {
            margin_kt: margin_kt(flight, row),
            at_s: row.time_s,
            at: point(row),
        });
        margins.reduce(|least, next| if next.margin_kt < least.margin_kt { next } else { least })
    }

    fn words(&self, name: &str) -> String {
        let beyond = if self.margin_kt < 0.0 { " (outside)" } else { "" };
        let kt = chart::with_minus(format!("{:.1}", self.margin_kt));
        format!("{name}: {kt} kt at {:.1} s{beyond}", self.at_s)
    }
}

/// The track where it is wanted; elsewhere it is broken.
fn track(flight: &Flight, wanted: impl Fn(&Row) -> bool) -> Vec<[f64; 2]> {
    let point = |row: &Row| if wanted(row) { point(row) } else { [f64::NAN, f64::NAN] };
    flight.rows.iter().map(point).collect()
}

/// Both limits, from stop to stop: airspeed in kt, incidence in deg.
#[derive(Default)]
struct Limits {
    slowest: Vec<[f64; 2]>,
    fastest: Vec<[f64; 2]>,
}

impl Limits {
    fn of(flight: &Flight) -> Self {
        let (least_rad, greatest_rad) = flight.mast_tilt_rad;
        let between = |tilt_rad: &f64| *tilt_rad > least_rad && *tilt_rad < greatest_rad;
        let mut tilts_rad = vec![least_rad];
        tilts_rad.extend(flight.corridor.corners_rad().take(CORNERS).filter(between));
        tilts_rad.push(greatest_rad);
        let at = |limit: &dyn Fn(f64) -> f64| {
            let point = |&tilt_rad: &f64| [knots(limit(tilt_rad)), 90.0 - degrees(tilt_rad)];
            tilts_rad.iter().map(point).collect()
        };
        Self {
            slowest: at(&|tilt_rad| flight.corridor.slowest_mps(tilt_rad)),
            fastest: at(&|tilt_rad| flight.corridor.fastest_mps(tilt_rad)),
        }
    }

    fn edge(&self) -> Vec<[f64; 2]> {
        self.slowest.iter().chain(self.fastest.iter().rev()).copied().collect()
    }

    fn curves(&self) -> Vec<Curve> {
        let pen = Pen::solid(look::LIMIT, 1.2);
        // Where there is no slowest speed there is no line.
        let slow = |point: &[f64; 2]| if point[0] > 0.0 { *point } else { [f64::NAN; 2] };
        vec![
            Curve::line("limits", pen, self.slowest.iter().map(slow).collect()),
            Curve::line("limits", pen, self.fastest.clone()),
        ]
    }

    fn labels(&self) -> Vec<Label> {
        let middle = self.fastest.get(self.fastest.len() / 2);
        let label = |point: &[f64; 2]| Label {
            at: [point[0] + 3.0, point[1] + 2.0],
            words: "rotor and mast loads".into(),
            anchor: Anchor::Start,
        };
        let slowest: Vec<_> = self.slowest.iter().filter(|point| point[0] > 0.0).collect();
        let slow = slowest.get(slowest.len() / 2).map(|point| Label {
            at: [point[0] - 4.0, point[1] - 2.0],
            words: "wing stall".into(),
            anchor: Anchor::End,
        });
        middle.map(label).into_iter().chain(slow).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use engine::Outputs;
    use engine::envelope::Corridor;
    use engine::pair::Pair;
    use engine::table::Table1;
    use engine::units::{KNOT_MPS, radians};

    use super::*;
    use crate::figures::flight::Gatherer;

    /// A flight by mast tilt in deg, calibrated airspeed in kt and height in m, through a corridor that is
    /// easily said: slowest 0, 80, 120 kt at 0, 30, 90 deg, fastest 100, 160, 200 kt at 0, 60, 90 deg.
    fn flight(flown: &[(f64, f64, f64)]) -> Flight {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut gatherer = Gatherer::new(Path::new("flight.mcap"), &xv15);
        for (tick, &(tilt_deg, kt, height_above_ground_m)) in (5..).step_by(5).zip(flown) {
            let calibrated_airspeed_mps = kt * KNOT_MPS;
            let mut outputs = Outputs {
                tick,
                calibrated_airspeed_mps,
                height_above_ground_m,
                ..Outputs::default()
            };
            let tilt_rad = radians(tilt_deg);
            outputs.actuators.mast_tilt_rad = Pair { left: tilt_rad, right: tilt_rad };
            gatherer.add(&outputs);
        }
        let mps = |kt: [f64; 3]| kt.map(|kt| kt * KNOT_MPS).to_vec();
        let tilts = |deg: [f64; 3]| deg.map(radians).to_vec();
        gatherer.flight.corridor = Corridor {
            calibrated_airspeed_mps_min: Table1::new(
                tilts([0.0, 30.0, 90.0]),
                mps([0.0, 80.0, 120.0]),
            ),
            calibrated_airspeed_mps_max: Table1::new(
                tilts([0.0, 60.0, 90.0]),
                mps([100.0, 160.0, 200.0]),
            ),
        };
        gatherer.flight.mast_tilt_rad = (radians(-5.0), radians(90.0));
        gatherer.flight
    }

    fn assert_near(points: &[[f64; 2]], expected: &[[f64; 2]]) {
        let far = |(a, b): (&[f64; 2], &[f64; 2])| {
            (a[0] - b[0]).abs() > 1e-9 || (a[1] - b[1]).abs() > 1e-9
        };
        let apart = points.iter().zip(expected).any(far) || points.len() != expected.len();
        assert!(!apart, "{points:?} and not {expected:?}");
    }

    #[test]
    fn the_limits_go_from_stop_to_stop_with_a_point_at_every_corner() {
        let limits = Limits::of(&flight(&[]));
        // Nacelle incidence is 90 deg less the mast tilt; a limit keeps its end beyond its table.
        let incidences = [95.0, 90.0, 60.0, 30.0, 0.0];
        let at = |kt: [f64; 5]| [0, 1, 2, 3, 4].map(|i| [kt[i], incidences[i]]);
        let (slowest, fastest) =
            (at([0.0, 0.0, 80.0, 100.0, 120.0]), at([100.0, 100.0, 130.0, 160.0, 200.0]));
        assert_near(&limits.slowest, &slowest);
        assert_near(&limits.fastest, &fastest);
        // The inside lies between them: up the one and down the other.
        let mut edge = fastest.to_vec();
        edge.reverse();
        assert_near(&limits.edge(), &[&slowest[..], &edge].concat());
        // A limit of 0 kt is none.
        let drawn = &limits.curves()[0].points;
        assert!(drawn[..2].iter().all(|point| point[0].is_nan()), "{drawn:?}");
        assert_near(&drawn[2..], &slowest[2..]);
    }

    #[test]
    fn the_least_margin_is_that_of_the_nearer_limit_in_the_air() {
        // 80 to 130 kt at 30 deg, 100 to 160 kt at 60 deg.
        let within = flight(&[(30.0, 95.0, 100.0), (60.0, 150.0, 100.0), (60.0, 300.0, 0.0)]);
        let least = Least::of(&within).expect("it flew");
        assert_near(&[least.at], &[[150.0, 30.0]]);
        assert_eq!(least.words("least margin"), "least margin: 10.0 kt at 0.0 s");
        let outside = flight(&[(30.0, 95.0, 100.0), (60.0, 160.0, 100.0), (30.0, 72.5, 100.0)]);
        let words = Least::of(&outside).expect("it flew").words("least margin");
        assert_eq!(words, "least margin: −7.5 kt at 0.1 s (outside)");
        assert!(Least::of(&flight(&[(30.0, 20.0, 0.0)])).is_none(), "it stayed on the ground");
    }
}
