//! Pictures: trim curves and a frequency response against the published points.

use analysis::Polar;
use analysis::linearize::decibels;
use analysis::trim::Trim;
use engine::Aircraft;
use plotters::prelude::*;

use crate::book::{DEG, KNOT_MPS};
use crate::dynamics::{HOVER_PITCH, hovering, pitch_over_elevator};
use crate::trims::{POINTS, Point, at, stick_in};

/// Nacelles in deg, first and last speed in kt, colour.
const CURVES: [(f64, u32, u32, RGBColor); 4] = [
    (90.0, 0, 110, RGBColor(31, 119, 180)),
    (60.0, 60, 130, RGBColor(44, 160, 44)),
    (30.0, 90, 160, RGBColor(255, 127, 14)),
    (0.0, 110, 240, RGBColor(214, 39, 40)),
];

/// Size of a picture, in its own units.
const SIZE: (u32, u32) = (720, 420);

/// One picture of trim curves: file, title, unit, range, ours, published.
struct Picture {
    file: &'static str,
    title: &'static str,
    axis: &'static str,
    range: (f64, f64),
    ours: fn(&Trim) -> f64,
    published: fn(&Point) -> f64,
}

const PICTURES: [Picture; 3] = [
    Picture {
        file: "docs/trim_pitch.svg",
        title: "Pitch in level flight",
        axis: "pitch, deg",
        range: (-15.0, 15.0),
        ours: |trim| trim.report.pitch_rad * DEG,
        published: |point| point.pitch_deg,
    },
    Picture {
        file: "docs/trim_stick.svg",
        title: "Longitudinal stick in level flight",
        axis: "stick from the aft stop, in",
        range: (3.0, 9.0),
        ours: stick_in,
        published: |point| point.stick_in,
    },
    Picture {
        file: "docs/trim_power.svg",
        title: "Power of both rotors in level flight",
        axis: "power, kW",
        range: (400.0, 1600.0),
        ours: |trim| 1e-3 * trim.report.power_w,
        published: |point| point.power_kw,
    },
];

/// Every picture: path, text.
pub fn all(aircraft: &Aircraft) -> Vec<(String, String)> {
    let curves: Vec<Vec<(f64, Trim)>> = CURVES
        .iter()
        .map(|&(nacelle_deg, first_kt, last_kt, _)| {
            (first_kt..=last_kt)
                .step_by(10)
                .map(f64::from)
                .filter_map(|kt| Some((kt, at(aircraft, nacelle_deg, kt * KNOT_MPS).ok()?)))
                .collect()
        })
        .collect();
    let mut files: Vec<_> = PICTURES
        .iter()
        .map(|picture| {
            let mut text = String::new();
            draw(picture, &curves, &mut text).expect("drawing to memory");
            (picture.file.to_owned(), text)
        })
        .collect();
    let mut text = String::new();
    response(aircraft, &mut text).expect("drawing to memory");
    files.push(("docs/response_hover.svg".into(), text));
    files
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(picture: &Picture, curves: &[Vec<(f64, Trim)>], text: &mut String) -> Drawn {
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(picture.title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(55)
        .build_cartesian_2d(0.0..250.0, picture.range.0..picture.range.1)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .x_desc("true airspeed, kt")
        .y_desc(picture.axis)
        .draw()?;
    for (curve, &(nacelle_deg, _, _, colour)) in curves.iter().zip(&CURVES) {
        let line = curve.iter().map(|(kt, trim)| (*kt, (picture.ours)(trim)));
        chart
            .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
            .label(format!("nacelles {nacelle_deg:.0} deg"))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
        let points = POINTS.iter().filter(|point| point.is_at(nacelle_deg));
        for point in points {
            let place = (point.airspeed_mps / KNOT_MPS, (picture.published)(point));
            if point.source == "flight" {
                chart.draw_series([Cross::new(place, 5, colour.stroke_width(2))])?;
            } else {
                chart.draw_series([Circle::new(place, 4, colour)])?;
            }
        }
    }
    chart
        .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
        .label("GTRS (class B)")
        .legend(|(x, y)| Circle::new((x + 9, y), 4, BLACK));
    chart
        .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
        .label("flight (class A)")
        .legend(|(x, y)| Cross::new((x + 9, y), 5, BLACK.stroke_width(2)));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    area.present()?;
    Ok(())
}

fn response(aircraft: &Aircraft, text: &mut String) -> Drawn {
    let omegas: Vec<f64> =
        (0..=60).map(|i| 0.1 * engine::math::exp(f64::from(i) * 0.076_753)).collect();
    let published = omegas
        .iter()
        .filter(|omega| (0.2..=5.0).contains(*omega))
        .map(|&omega| (omega, decibels(HOVER_PITCH.at(omega).magnitude())));
    let found = hovering(aircraft).ok();
    let ours = found.iter().flat_map(|(_, linear)| {
        omegas.iter().filter_map(|&omega| {
            let g = pitch_over_elevator(aircraft, linear, omega).ok()?;
            Some((omega, decibels(g.magnitude())))
        })
    });
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption("Hover, SCAS off: pitch rate over elevator", ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(55)
        .build_cartesian_2d((0.1..10.0).log_scale(), -25.0..25.0)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .x_desc("frequency, rad/s")
        .y_desc("gain, dB (deg/s per deg)")
        .draw()?;
    chart
        .draw_series(LineSeries::new(ours, BLUE.stroke_width(2)))?
        .label("ours")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], BLUE));
    chart
        .draw_series(LineSeries::new(published, RED.stroke_width(2)))?
        .label("flight (class A)")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], RED));
    chart.configure_series_labels().background_style(WHITE.mix(0.8)).draw()?;
    area.present()?;
    Ok(())
}
