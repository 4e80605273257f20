//! Sounds of our own making: mono, 22,050 Hz, 16 bits, each a loop or a single knock.
//!
//! FlightGear sets pitch and loudness from what the flight sends; at pitch 1 a loop is that of the
//! helicopter's rotor speed.

use engine::math::{TAU, exp, max, min, sin};

/// Samples per second.
const RATE_HZ: u32 = 22_050;
/// Blades a second that pass at 601 rpm of three blades.
const PASSAGE_HZ: f64 = 30.05;

/// The files by name.
pub fn files() -> [(&'static str, Vec<u8>); 7] {
    [
        ("rotor.wav", wav(&rotor())),
        ("engine.wav", wav(&engine_whine())),
        ("nacelle.wav", wav(&nacelle())),
        ("gear.wav", wav(&gear())),
        ("thump.wav", wav(&thump())),
        ("roll.wav", wav(&rolling())),
        ("wind.wav", wav(&wind())),
    ]
}

/// Samples of a loop of a whole number of passages or of a time.
fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE_HZ) + 0.5) as usize
}

fn time_s(i: usize) -> f64 {
    i as f64 / f64::from(RATE_HZ)
}

/// White noise, the same on every machine.
fn white(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

/// A low pass of first order around a loop: its second round begins as the first one ended.
fn low_pass(signal: &[f64], corner_hz: f64) -> Vec<f64> {
    let part = 1.0 - exp(-TAU * corner_hz / f64::from(RATE_HZ));
    let mut level = 0.0;
    let mut filtered = Vec::new();
    for _ in 0..2 {
        filtered = signal
            .iter()
            .map(|x| {
                level += part * (x - level);
                level
            })
            .collect();
    }
    filtered
}

fn high_pass(signal: &[f64], corner_hz: f64) -> Vec<f64> {
    signal.iter().zip(low_pass(signal, corner_hz)).map(|(x, low)| x - low).collect()
}

/// Two rotors of three blades: a beat of pressure and air at every passage.
fn rotor() -> Vec<f64> {
    let passages = 36.0;
    let count = samples(passages / PASSAGE_HZ);
    let air = low_pass(&white(count, 11), 420.0);
    let hiss = high_pass(&low_pass(&white(count, 12), 2600.0), 700.0);
    (0..count)
        .map(|i| {
            let turn = passages * i as f64 / count as f64;
            let phase = turn - turn.floor();
            // The other rotor a little off the beat.
            let other = turn + 0.31;
            let other = other - other.floor();
            let beat = |phase: f64| exp(-9.0 * phase) - 0.55 * exp(-16.0 * (1.0 - phase));
            let pulse = beat(phase) + 0.8 * beat(other);
            let tone = 0.25 * sin(TAU * turn) + 0.14 * sin(2.0 * TAU * turn + 0.7);
            0.55 * pulse + tone + air[i] * (1.2 + 1.6 * exp(-5.0 * phase)) + 0.35 * hiss[i]
        })
        .collect()
}

/// Compressor and turbine tones over the roar of the exhaust.
fn engine_whine() -> Vec<f64> {
    let seconds = 2.0;
    let count = samples(seconds);
    let roar = low_pass(&low_pass(&white(count, 21), 900.0), 900.0);
    let hiss = high_pass(&white(count, 22), 3000.0);
    // Whole numbers of waves in the loop.
    let tones = [(742.0, 0.20), (1483.5, 0.16), (2226.0, 0.10), (3710.0, 0.06), (1121.0, 0.05)];
    (0..count)
        .map(|i| {
            let t = time_s(i);
            let wobble = 1.0 + 0.06 * sin(TAU * 1.5 * t) + 0.04 * sin(TAU * 4.0 * t);
            let whine: f64 = tones.iter().map(|(hz, level)| level * sin(TAU * hz * t)).sum();
            wobble * whine + 2.2 * roar[i] + 0.05 * hiss[i]
        })
        .collect()
}

/// A hydraulic motor and its gears.
fn nacelle() -> Vec<f64> {
    let count = samples(1.0);
    let noise = high_pass(&low_pass(&white(count, 31), 1800.0), 250.0);
    (0..count)
        .map(|i| {
            let t = time_s(i);
            let teeth = 1.0 + 0.35 * sin(TAU * 23.0 * t);
            let hum = 0.30 * sin(TAU * 184.0 * t)
                + 0.18 * sin(TAU * 368.0 * t)
                + 0.12 * sin(TAU * 736.0 * t);
            teeth * hum + 0.5 * noise[i]
        })
        .collect()
}

/// A hydraulic pump.
fn gear() -> Vec<f64> {
    let count = samples(1.0);
    let noise = low_pass(&white(count, 41), 1200.0);
    (0..count)
        .map(|i| {
            let t = time_s(i);
            0.28 * sin(TAU * 97.0 * t)
                + 0.20 * sin(TAU * 291.0 * t)
                + 0.10 * sin(TAU * 873.0 * t)
                + 0.7 * noise[i]
        })
        .collect()
}

/// A lock, or a wheel on the ground.
fn thump() -> Vec<f64> {
    let count = samples(0.45);
    let noise = low_pass(&white(count, 51), 700.0);
    (0..count)
        .map(|i| {
            let t = time_s(i);
            let fade = min(1.0, 12.0 * (0.45 - t));
            (sin(TAU * 62.0 * t) * exp(-14.0 * t) + 2.2 * noise[i] * exp(-24.0 * t)) * fade
        })
        .collect()
}

/// Tyres on concrete.
fn rolling() -> Vec<f64> {
    let count = samples(1.5);
    let rumble = low_pass(&low_pass(&white(count, 61), 160.0), 160.0);
    let grit = high_pass(&low_pass(&white(count, 62), 1400.0), 350.0);
    rumble.iter().zip(&grit).map(|(low, high)| 4.0 * low + 0.35 * high).collect()
}

/// Air along the cabin.
fn wind() -> Vec<f64> {
    let count = samples(2.0);
    high_pass(&low_pass(&low_pass(&white(count, 71), 1100.0), 2200.0), 130.0)
}

/// The file of a sound, as loud as it can be without being cut.
fn wav(signal: &[f64]) -> Vec<u8> {
    let peak = signal.iter().fold(1e-9, |peak, x| max(peak, x.abs()));
    let data: Vec<u8> =
        signal.iter().flat_map(|x| ((x / peak * 29_000.0) as i16).to_le_bytes()).collect();
    let length = u32::try_from(data.len()).unwrap_or(u32::MAX);
    let mut file = Vec::new();
    file.extend(b"RIFF");
    file.extend((36 + length).to_le_bytes());
    file.extend(b"WAVEfmt ");
    file.extend(16_u32.to_le_bytes());
    // PCM, one channel.
    file.extend(1_u16.to_le_bytes());
    file.extend(1_u16.to_le_bytes());
    file.extend(RATE_HZ.to_le_bytes());
    file.extend((2 * RATE_HZ).to_le_bytes());
    file.extend(2_u16.to_le_bytes());
    file.extend(16_u16.to_le_bytes());
    file.extend(b"data");
    file.extend(length.to_le_bytes());
    file.extend(data);
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_end_where_they_begin() {
        // A step between the last and the first sample is no greater than those within, or it clicks.
        for signal in [rotor(), engine_whine(), nacelle(), gear(), rolling(), wind()] {
            let steps = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let greatest = steps.fold(0.0, max);
            let seam = (signal[0] - signal[signal.len() - 1]).abs();
            assert!(seam <= greatest, "{seam} beside {greatest}");
        }
    }

    #[test]
    fn a_file_says_how_long_it_is() {
        let file = wav(&[0.0, 1.0, -1.0]);
        assert_eq!((file.len(), &file[..4], file[40]), (50, &b"RIFF"[..], 6));
    }
}
