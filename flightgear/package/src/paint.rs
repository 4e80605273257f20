//! Pictures: the fuselage's livery, blur disc, halo, dust, the dark screen.

use engine::aircraft::Params as Aircraft;
use engine::math::{exp, max, min, sqrt};

use crate::shape::{Likeness, Smooth};

/// Texture of the fuselage.
pub const LIVERY: &str = "livery.png";
/// Texture of a fast rotor.
pub const DISC: &str = "disc.png";
/// Texture of a light's halo.
pub const HALO: &str = "halo.png";
/// Texture of a puff of dust.
pub const DUST: &str = "dust.png";
/// Texture of a screen before anything is drawn on it.
pub const SCREEN: &str = "screen.png";

/// Red, green, blue, opacity, 0..1.
type Colour = [f64; 4];

const WHITE: Colour = [0.955, 0.96, 0.965, 1.0];
const BELLY: Colour = [0.80, 0.815, 0.83, 1.0];
const BLUE: Colour = [0.07, 0.20, 0.46, 1.0];
const LIGHT_BLUE: Colour = [0.32, 0.58, 0.84, 1.0];
const BLACK: Colour = [0.05, 0.05, 0.06, 1.0];
const LINE: Colour = [0.55, 0.57, 0.60, 1.0];

/// Pixels of the livery: its upper half is the left side, its lower half the right side.
const LIVERY_PX: [u32; 2] = [2048, 512];

/// Where the fuselage's sides are on the livery, and how they are painted.
pub struct Livery {
    section: Smooth<4>,
    like: Likeness,
    window_m: [f64; 4],
    /// What is painted: stations and waterlines of its ends.
    aft_m: [f64; 2],
    up_m: [f64; 2],
}

impl Livery {
    /// Of an aircraft.
    pub fn new(aircraft: &Aircraft) -> Self {
        let shape = &aircraft.display.fuselage;
        let section = Smooth::new(&shape.section_m);
        let [nose, end] = section.range();
        let lowest = shape.section_m.iter().fold(f64::MAX, |low, row| min(low, row[2]));
        let highest = shape.section_m.iter().fold(f64::MIN, |high, row| max(high, row[3]));
        Self {
            section,
            like: Likeness::of(aircraft),
            window_m: shape.side_window_m,
            aft_m: [nose - 0.05, end + 0.05],
            up_m: [lowest - 0.05, highest + 0.05],
        }
    }

    /// Where a point of the skin is on the texture.
    pub fn uv(&self, aft: f64, up: f64, right_side: bool) -> [f64; 2] {
        let along = (aft - self.aft_m[0]) / (self.aft_m[1] - self.aft_m[0]);
        let high = (up - self.up_m[0]) / (self.up_m[1] - self.up_m[0]);
        // Seen from the right the nose is on the right.
        if right_side { [1.0 - along, 0.5 * high] } else { [along, 0.5 + 0.5 * high] }
    }

    /// The colour of a side at a place; `seen` is the station as the letters run.
    fn colour(&self, aft: f64, up: f64, words: &[Word]) -> Colour {
        let [_, _, bottom, top] = self.section.at(aft);
        let ([nose, end], like) = (self.section.range(), self.like);
        let m = |drawn: f64| like.length(drawn);
        let mut colour = WHITE;
        let part = (aft - nose) / (end - nose);
        // The belly's edge rises with the tail.
        let belly = bottom + 0.10 * (top - bottom);
        mix(&mut colour, BELLY, edge(belly - up));
        // A stripe that widens aft, and a lighter one below it.
        let middle = bottom + (0.50 + 0.06 * part) * (top - bottom);
        let half = m(0.035 + 0.10 * part);
        if aft > nose + m(0.35) {
            let off = up - middle;
            mix(&mut colour, BLUE, edge(half - off.abs()));
            let second = off + half + m(0.035 + 0.025);
            mix(&mut colour, LIGHT_BLUE, edge(m(0.025) - second.abs()));
        }
        // The tail's end.
        mix(&mut colour, BLUE, edge(aft - (end - m(1.35)) - 0.9 * (up - like.up(2.2))));
        // Against glare before the windscreen.
        if aft < like.aft(4.35) && aft > nose + m(0.12) {
            mix(&mut colour, BLACK, edge(up - (top - m(0.13) - 0.05 * (aft - nose))));
        }
        self.lines(&mut colour, aft, up);
        for word in words {
            let ink = edge(word.stroke_m - word.distance(aft, up));
            mix(&mut colour, word.colour, ink);
        }
        colour
    }

    /// Doors, joints and the frames of windows.
    fn lines(&self, colour: &mut Colour, aft: f64, up: f64) {
        let [from, to, low, high] = self.window_m;
        let (middle, like) = (0.5 * (from + to), self.like);
        let m = |drawn: f64| like.length(drawn);
        for window in [[from, middle - m(0.05)], [middle + m(0.05), to]] {
            let off = outside(aft, up, [window[0], window[1], low, high], m(0.09));
            mix(colour, [0.30, 0.32, 0.35, 1.0], edge(m(0.028) - off));
        }
        let frame = |[from, to, low, high]: [f64; 4]| {
            [like.aft(from), like.aft(to), like.up(low), like.up(high)]
        };
        let door = outside(aft, up, frame([6.42, 7.18, 0.86, 2.16]), m(0.10));
        mix(colour, LINE, 0.8 * edge(m(0.009) - door.abs()));
        let handle = outside(aft, up, frame([6.50, 6.62, 1.52, 1.55]), m(0.01));
        mix(colour, [0.25, 0.26, 0.28, 1.0], edge(-handle));
        for joint in [3.72, 5.08, 8.55, 9.70, 10.9, 12.15, 13.4, 14.1] {
            mix(colour, LINE, 0.45 * edge(m(0.005) - (aft - like.aft(joint)).abs()));
        }
    }
}

/// 1 inside, 0 outside, over a centimetre.
fn edge(inside_m: f64) -> f64 {
    min(1.0, max(0.0, 0.5 + inside_m / 0.008))
}

/// How far a point is outside a rectangle with round corners; negative inside.
fn outside(aft: f64, up: f64, [from, to, low, high]: [f64; 4], round: f64) -> f64 {
    let x = (aft - 0.5 * (from + to)).abs() - (0.5 * (to - from) - round);
    let y = (up - 0.5 * (low + high)).abs() - (0.5 * (high - low) - round);
    let (x_out, y_out) = (max(x, 0.0), max(y, 0.0));
    sqrt(x_out * x_out + y_out * y_out) + min(max(x, y), 0.0) - round
}

fn mix(colour: &mut Colour, with: Colour, part: f64) {
    let part = min(1.0, max(0.0, part));
    *colour = std::array::from_fn(|i| colour[i] + (with[i] - colour[i]) * part);
}

/// Letters drawn with a pen on a grid four wide and six high: a letter a line, strokes between bars.
const LETTERS: &str = include_str!("letters.txt");

/// The strokes of a letter; of one that is not there, none.
fn strokes(letter: char) -> Vec<Vec<[f64; 2]>> {
    let mut lines = LETTERS.lines();
    let Some(line) = lines.find(|line| line.starts_with(letter)) else { return Vec::new() };
    let point = |text: &str| {
        let (x, y) = text.split_once(',')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    let stroke = |text: &str| text.split_whitespace().filter_map(point).collect();
    line[letter.len_utf8()..].split('|').map(stroke).collect()
}

/// A word on a side of the fuselage.
struct Word {
    lines: Vec<[[f64; 2]; 2]>,
    stroke_m: f64,
    colour: Colour,
}

impl Word {
    /// Letters `tall_m` high around a middle; on the right side they run forward.
    fn new(text: &str, middle_m: [f64; 2], tall_m: f64, colour: Colour, right_side: bool) -> Self {
        let unit = tall_m / 6.0;
        let step = 5.6;
        let width = step * text.chars().count() as f64 - 1.6;
        let forward = if right_side { -1.0 } else { 1.0 };
        let mut lines = Vec::new();
        for (i, letter) in text.chars().enumerate() {
            for stroke in strokes(letter) {
                let at = |[x, y]: [f64; 2]| {
                    // Leaning with the flight.
                    let along = step * i as f64 + x + 0.22 * (y - 3.0) * -forward - 0.5 * width;
                    [middle_m[0] + forward * unit * along, middle_m[1] + unit * (y - 3.0)]
                };
                lines.extend(stroke.windows(2).map(|pair| [at(pair[0]), at(pair[1])]));
            }
        }
        Self { lines, stroke_m: 0.55 * unit, colour }
    }

    /// From the nearest line, m.
    fn distance(&self, aft: f64, up: f64) -> f64 {
        self.lines.iter().fold(f64::MAX, |nearest, &[a, b]| {
            let along = [b[0] - a[0], b[1] - a[1]];
            let to = [aft - a[0], up - a[1]];
            let length = along[0] * along[0] + along[1] * along[1];
            let part = min(1.0, max(0.0, (along[0] * to[0] + along[1] * to[1]) / length));
            let off = [to[0] - part * along[0], to[1] - part * along[1]];
            min(nearest, sqrt(off[0] * off[0] + off[1] * off[1]))
        })
    }
}

/// A picture from its colour at each place, from the upper left.
fn picture([wide, high]: [u32; 2], colour: impl Fn(f64, f64) -> Colour, opaque: bool) -> Vec<u8> {
    let channels = if opaque { 3 } else { 4 };
    let mut bytes = Vec::new();
    for row in 0..high {
        for column in 0..wide {
            let place = |i: u32, of: u32| (f64::from(i) + 0.5) / f64::from(of);
            let colour = colour(place(column, wide), place(row, high));
            bytes.extend(
                colour[..channels].iter().map(|&x| (min(1.0, max(0.0, x)) * 255.0 + 0.5) as u8),
            );
        }
    }
    png([wide, high], &bytes, opaque)
}

fn png([wide, high]: [u32; 2], bytes: &[u8], opaque: bool) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, wide, high);
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a Vec takes everything");
    writer.write_image_data(bytes).expect("as many bytes as the picture has");
    drop(writer);
    file
}

/// What is painted on an aircraft: of a maker and a type the type, which has a number; without one the name.
fn painted_name(name: &str) -> String {
    let kind: Vec<_> =
        name.split(' ').filter(|word| word.contains(|c: char| c.is_ascii_digit())).collect();
    if kind.is_empty() { name.to_uppercase() } else { kind.join(" ").to_uppercase() }
}

/// The fuselage's sides.
pub fn livery(aircraft: &Aircraft) -> Vec<u8> {
    let (livery, like) = (Livery::new(aircraft), Likeness::of(aircraft));
    let name = painted_name(&aircraft.name);
    // As tall as the XV-15's, or as long.
    let longest = 8.0;
    let tall = 0.40 * min(1.0, longest / name.chars().count() as f64);
    let words = [false, true].map(|right_side| {
        let word = |text: &str, [aft, up]: [f64; 2], tall: f64, colour| {
            let middle = [like.aft(aft), like.up(up)];
            Word::new(text, middle, like.length(tall), colour, right_side)
        };
        [word(&name, [9.35, 2.05], tall, BLUE), word("TILTROTOR", [10.6, 1.735], 0.105, WHITE)]
    });
    let [first, last] = livery.aft_m;
    let [low, high] = livery.up_m;
    let colour = |x: f64, y: f64| {
        let right_side = y > 0.5;
        let along = if right_side { 1.0 - x } else { x };
        let down = if right_side { 2.0 * y - 1.0 } else { 2.0 * y };
        let (aft, up) = (first + along * (last - first), high - down * (high - low));
        livery.colour(aft, up, &words[usize::from(right_side)])
    };
    picture(LIVERY_PX, colour, true)
}

/// A rotor that turns fast: fainter outwards, with a ring where the tips are painted.
pub fn disc() -> Vec<u8> {
    picture(
        [512, 512],
        |x, y| {
            let [across, up] = [2.0 * x - 1.0, 2.0 * y - 1.0];
            let out = sqrt(across * across + up * up);
            let angle = engine::math::atan2(up, across);
            // Three faint smears, as the eye has them.
            let smear = 0.5 + 0.5 * engine::math::cos(3.0 * angle);
            let tip = edge_between(out, 0.925, 0.985);
            let body = edge_between(out, 0.06, 0.93);
            let blade = body * (0.10 + 0.12 * (1.0 - out) + 0.07 * smear * smear);
            let [r, g, b] = if tip > body { [0.95, 0.78, 0.25] } else { [0.25, 0.26, 0.28] };
            [r, g, b, blade + 0.26 * tip]
        },
        false,
    )
}

fn edge_between(x: f64, from: f64, to: f64) -> f64 {
    min(1.0, max(0.0, (x - from) / 0.015)) * min(1.0, max(0.0, (to - x) / 0.015))
}

/// What is seen around a light.
pub fn halo() -> Vec<u8> {
    picture(
        [64, 64],
        |x, y| {
            let [across, up] = [2.0 * x - 1.0, 2.0 * y - 1.0];
            let out = sqrt(across * across + up * up);
            let bright = exp(-7.0 * out * out) * max(0.0, 1.0 - out);
            [1.0, 1.0, 1.0, 0.9 * bright]
        },
        false,
    )
}

/// A puff of dust.
pub fn dust() -> Vec<u8> {
    picture(
        [64, 64],
        |x, y| {
            let [across, up] = [2.0 * x - 1.0, 2.0 * y - 1.0];
            let out = sqrt(across * across + up * up);
            let ragged = 0.12 * engine::math::sin(7.0 * across + 3.0) * engine::math::cos(6.0 * up);
            let thick = max(0.0, 1.0 - out - ragged);
            [0.72, 0.66, 0.56, 0.55 * thick]
        },
        false,
    )
}

/// A dark screen.
pub fn screen() -> Vec<u8> {
    picture([16, 16], |_, _| [0.01, 0.012, 0.015, 1.0], true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_can_be_drawn_and_none_leaves_its_place() {
        for letter in ('A'..='Z').chain('0'..='9').chain(['-']) {
            let drawn = strokes(letter);
            assert!(!drawn.is_empty() && drawn.iter().all(|stroke| stroke.len() > 1), "{letter}");
            for [x, y] in drawn.into_iter().flatten() {
                assert!((0.0..=4.0).contains(&x) && (-0.5..=6.0).contains(&y), "{letter}: {x} {y}");
            }
        }
        assert!(strokes(' ').is_empty() && strokes('é').is_empty());
    }

    #[test]
    fn a_type_is_painted_without_its_maker() {
        assert_eq!(painted_name("Bell XV-15"), "XV-15");
        assert_eq!(painted_name("Generic tilt-rotor"), "GENERIC TILT-ROTOR");
    }

    #[test]
    fn words_run_aft_on_the_left_and_forward_on_the_right() {
        // The T of "TI" is where the word begins.
        let begins = |right_side| {
            let word = Word::new("TI", [5.0, 1.0], 0.6, BLUE, right_side);
            word.lines[0][0][0] + word.lines[0][1][0] < 10.0
        };
        assert!(begins(false) && !begins(true));
    }
}
