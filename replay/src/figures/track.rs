//! Where it flew: in space, and seen from above.

use chart::plane::Plane;
use chart::space::{Flight as Curves, Space};
use chart::{Colour, Curve, Pen};

use super::flight::{Configuration, Flight, Row};
use super::list::Figure;
use super::look;

/// Posts to the ground stand so many seconds apart, or further where there would be too many.
const POST_S: f64 = 10.0;
const POSTS_MAX: f64 = 40.0;

fn east_north(row: &Row) -> [f64; 2] {
    [row.position_m.y, row.position_m.x]
}

fn in_space(row: &Row) -> [f64; 3] {
    [row.position_m.y, row.position_m.x, row.height_m]
}

/// Pieces of the path, each with its name and its pen: of the only flight by configuration.
fn pieces<T>(
    flights: &[&Flight],
    of: usize,
    place: impl Fn(&Row) -> T,
) -> Vec<(String, Pen, Vec<T>)> {
    let flight = flights[of];
    if flights.len() > 1 {
        let points = flight.rows.iter().map(place).collect();
        return vec![(flight.name.clone(), look::pen(of, false, false), points)];
    }
    let piece = |(configuration, first, last): (Configuration, usize, usize)| {
        let points = flight.rows[first..=last].iter().map(&place).collect();
        let pen = Pen::solid(look::colour(configuration), 1.6);
        (configuration.words().to_string(), pen, points)
    };
    flight.stretches().into_iter().map(piece).collect()
}

/// Where each numbered moment of a flight was.
fn places<T>(flight: &Flight, place: impl Fn(&Row) -> T) -> Vec<T> {
    let (chosen, _) = flight.moments();
    chosen.into_iter().filter_map(|moment| flight.row_at(moment.tick)).map(place).collect()
}

/// The paths in space.
pub fn space(flights: &[&Flight]) -> Space {
    let mut apart_s = POST_S;
    let curves = |of: usize| {
        let flight = flights[of];
        let (from_s, to_s) = flight.range_s();
        while (to_s - from_s) / apart_s > POSTS_MAX {
            apart_s *= 2.0;
        }
        let mut posts = Vec::new();
        let mut next_s = from_s;
        for row in &flight.rows {
            if row.time_s >= next_s {
                posts.push(in_space(row));
                next_s += apart_s;
            }
        }
        let shadow = if flights.len() > 1 {
            paler(look::FLIGHTS[of.min(1)])
        } else {
            Colour(0xB4, 0xB4, 0xB4)
        };
        let name = flight.name.clone();
        let places = places(flight, in_space);
        Curves { name, pieces: pieces(flights, of, in_space), posts, shadow, places }
    };
    let drawn = (0..flights.len()).map(curves).collect();
    Space {
        title: Figure::Trajectory.facts().words.into(),
        subtitle: look::subtitle(flights, &format!("posts stand every {apart_s:.0} s")),
        axes: ["East of the start, m".into(), "North of the start, m".into(), "Height, m".into()],
        flights: drawn,
        moments: look::moments(flights),
    }
}

/// The paths seen from above.
pub fn plan(flights: &[&Flight]) -> Plane {
    let curves = (0..flights.len()).flat_map(|of| pieces(flights, of, east_north));
    Plane {
        title: Figure::Plan.facts().words.into(),
        subtitle: look::subtitle(flights, "north is up, and a metre is as long north as east"),
        axes: ["East of the start, m".into(), "North of the start, m".into()],
        equal: true,
        least: [20.0, 20.0],
        with: Vec::new(),
        upright: None,
        areas: Vec::new(),
        directed: curves.clone().map(|(name, ..)| name).collect(),
        curves: curves.map(|(name, pen, points)| Curve::line(name, pen, points)).collect(),
        labels: Vec::new(),
        places: flights.iter().map(|flight| places(flight, east_north)).collect(),
        moments: look::moments(flights),
    }
}

/// Two fifths of the ink.
fn paler(Colour(red, green, blue): Colour) -> Colour {
    let paler = |part: u8| 255 - (255 - part) / 5 * 2;
    Colour(paler(red), paler(green), paler(blue))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use engine::Outputs;

    use super::*;
    use crate::figures::flight::Gatherer;

    /// A flight eastwards at 10 m/s.
    fn flight(seconds: u64) -> Flight {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut gatherer = Gatherer::new(Path::new("flight.mcap"), &xv15);
        for tick in 1..=250 * seconds {
            let mut outputs = Outputs { tick, ..Outputs::default() };
            outputs.position_m.y = 0.04 * tick as f64;
            gatherer.add(&outputs);
        }
        gatherer.flight
    }

    #[test]
    fn posts_stand_apart_and_are_not_too_many() {
        for seconds in [20, 100, 1000] {
            let flight = flight(seconds);
            let space = space(&[&flight]);
            let posts = &space.flights[0].posts;
            let apart_s = ((posts[1][0] - posts[0][0]) / 10.0).round();
            let words = format!("every {apart_s:.0} s");
            assert!(space.subtitle.contains(&words), "{}: {words}", space.subtitle);
            let even = |two: &[[f64; 3]]| (two[1][0] - two[0][0] - 10.0 * apart_s).abs() < 1.0;
            assert!(posts.windows(2).all(even) && apart_s >= POST_S, "{posts:?}");
            let count = seconds as f64 / apart_s;
            assert!((posts.len() as f64 - count).abs() < 1.5 && count <= POSTS_MAX, "{count}");
        }
    }
}
