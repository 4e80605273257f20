//! What tells our recordings from others, and one of the same flight from one of another.
//!
//! An `.rrd` file begins with the name of the application and the recording's id, both as text. Ours is made
//! of what was drawn and how; what came of it is in the name of the layout at the end of the file. So a
//! recording is known without rerun's reader, and without being read.

use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

/// Application of all our recordings.
pub const APPLICATION: &str = "tiltrotor";
/// Every `.rrd` file begins with it.
const MAGIC: &[u8] = b"RRF2";
/// Before the id of a recording.
const DRAWN: &str = "tiltrotor-drawn-";
/// Before what came of it.
const MARK: &str = "tiltrotor-mark-";
/// The id is within so many bytes of the beginning.
const BEGINNING_BYTES: u64 = 4096;
/// What came of it is looked for in blocks of so many bytes.
const BLOCK_BYTES: u64 = 1 << 20;
/// It is no longer than that: a status of three digits, a tick of twenty.
const MARK_BYTES_MAX: u64 = 64;

/// What a recording shows, and how.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stamp(String);

/// What came of drawing it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The status that the command ended with.
    pub status: u8,
    /// The first tick where something is not the same.
    pub first_difference: Option<u64>,
}

/// What stands in the place of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Nothing, or an empty file.
    Nothing,
    /// The same recording, and what came of it.
    Fresh(Mark),
    /// One of ours, of something else or of another version.
    Stale,
    /// Somebody else's file.
    Foreign,
}

impl Stamp {
    /// Of the bytes of what is drawn, and of words that say how and by which program.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn of(files: &[&Path], how: &str) -> std::io::Result<Self> {
        let mut id = DRAWN.to_string();
        for path in files {
            id.push_str(&format!("{:016x}-", digest(&mut File::open(path)?)?));
        }
        id.push_str(&format!("{:016x}", digest(&mut how.as_bytes())?));
        Ok(Self(id))
    }

    /// As the recording's id.
    pub fn id(&self) -> &str {
        &self.0
    }

    /// What stands there.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn standing(&self, path: &Path) -> std::io::Result<Standing> {
        let mut file = match File::open(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Standing::Nothing),
            file => file?,
        };
        let about = file.metadata()?;
        if !about.is_file() {
            return Ok(Standing::Foreign);
        }
        if about.len() == 0 {
            return Ok(Standing::Nothing);
        }
        let mut beginning = Vec::new();
        (&mut file).take(BEGINNING_BYTES).read_to_end(&mut beginning)?;
        if !beginning.starts_with(MAGIC) || !contains(&beginning, DRAWN.as_bytes()) {
            return Ok(Standing::Foreign);
        }
        if !contains(&beginning, self.0.as_bytes()) {
            return Ok(Standing::Stale);
        }
        Ok(Mark::last_in(&mut file, about.len())?.map_or(Standing::Stale, Standing::Fresh))
    }
}

impl Mark {
    /// As a name.
    pub fn name(&self) -> String {
        let tick = self.first_difference.map_or_else(|| "none".into(), |tick| tick.to_string());
        format!("{MARK}{}-{tick}.", self.status)
    }

    /// The last one in a file of that length, looked for from its end: a block of it is in memory, and a
    /// recording of an hour is not read for what stands behind it.
    fn last_in(file: &mut (impl Read + Seek), length: u64) -> std::io::Result<Option<Self>> {
        let mut bytes = Vec::new();
        let mut end = length;
        while end > 0 {
            let start = end.saturating_sub(BLOCK_BYTES);
            file.seek(SeekFrom::Start(start))?;
            bytes.clear();
            // One that begins in this block may end in the one behind it.
            file.take(end - start + MARK_BYTES_MAX).read_to_end(&mut bytes)?;
            if contains(&bytes, MARK.as_bytes()) {
                return Ok(Self::in_bytes(&bytes));
            }
            end = start;
        }
        Ok(None)
    }

    /// The last one in these bytes.
    fn in_bytes(bytes: &[u8]) -> Option<Self> {
        let at = bytes.windows(MARK.len()).rposition(|window| window == MARK.as_bytes())?;
        let rest = &bytes[at + MARK.len()..];
        let end = rest.iter().position(|&byte| byte == b'.')?;
        let (status, tick) = std::str::from_utf8(&rest[..end]).ok()?.split_once('-')?;
        let first_difference = match tick {
            "none" => None,
            tick => Some(tick.parse().ok()?),
        };
        Some(Self { status: status.parse().ok()?, first_difference })
    }
}

fn contains(bytes: &[u8], wanted: &[u8]) -> bool {
    bytes.windows(wanted.len()).any(|window| window == wanted)
}

/// FNV-1a over eight bytes at a time: tells files apart, and is not against anybody.
fn digest(from: &mut impl Read) -> std::io::Result<u64> {
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    let mut state: u64 = 0xCBF2_9CE4_8422_2325;
    let mut length = 0;
    let mut bytes = Vec::with_capacity(1 << 16);
    loop {
        bytes.clear();
        let read = from.take(1 << 16).read_to_end(&mut bytes)?;
        if read == 0 {
            return Ok((state ^ length).wrapping_mul(PRIME));
        }
        length += read as u64;
        bytes.resize(read.next_multiple_of(8), 0);
        for word in bytes.as_chunks::<8>().0 {
            state = (state ^ u64::from_le_bytes(*word)).wrapping_mul(PRIME);
            state ^= state >> 32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// A file that counts what is read of it.
    struct Counted(Cursor<Vec<u8>>, u64);

    impl Read for Counted {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            let read = self.0.read(into)?;
            self.1 += read as u64;
            Ok(read)
        }
    }

    impl Seek for Counted {
        fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
            self.0.seek(to)
        }
    }

    #[test]
    fn what_came_of_it_is_found_from_the_end_of_a_long_recording() {
        let mark = Mark { status: 255, first_difference: Some(u64::MAX) };
        let name = mark.name();
        assert!(name.len() as u64 <= MARK_BYTES_MAX);
        let length = 5 * BLOCK_BYTES;
        let with = |places: &[u64]| {
            let mut bytes = vec![b'.'; length as usize];
            for place in places {
                bytes[*place as usize..][..name.len()].copy_from_slice(name.as_bytes());
            }
            let mut file = Counted(Cursor::new(bytes), 0);
            let found = Mark::last_in(&mut file, length).expect("it is read");
            (found, file.1)
        };
        // Near the end, little of it is read.
        let (found, read) = with(&[length - 5_000]);
        assert_eq!(found, Some(mark));
        assert!(read <= BLOCK_BYTES, "{read}");
        // Wherever it stands, across the border of two blocks as well.
        for place in [0, BLOCK_BYTES - 1, 2 * BLOCK_BYTES - 20, 3 * BLOCK_BYTES] {
            assert_eq!(with(&[place]).0, Some(mark), "{place}");
        }
        assert_eq!(with(&[]).0, None);
    }

    #[test]
    fn a_recording_is_fresh_stale_or_foreign() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = |name: &str| folder.path().join(name);
        std::fs::write(place("a.mcap"), "a log of a flight").expect("a log");
        let (log, rrd) = (place("a.mcap"), place("a.rrd"));
        let stamp = Stamp::of(&[&log], "pilot, 0.1").expect("a stamp");
        assert_eq!(stamp.standing(&rrd).expect("read"), Standing::Nothing);
        let mark = Mark { status: 3, first_difference: Some(77) };
        let bytes = |id: &str, mark: &str| format!("RRF2\0\0\0{APPLICATION} {id}\0 … {mark} …");
        std::fs::write(&rrd, bytes(stamp.id(), &mark.name())).expect("a recording");
        assert_eq!(stamp.standing(&rrd).expect("read"), Standing::Fresh(mark));
        // Drawn otherwise, or of a log that is another one by now.
        let other = Stamp::of(&[&log], "rotor, 0.1").expect("a stamp");
        assert_eq!(other.standing(&rrd).expect("read"), Standing::Stale);
        std::fs::write(&log, "another log, of a flight").expect("a log");
        let other = Stamp::of(&[&log], "pilot, 0.1").expect("a stamp");
        assert_eq!(other.standing(&rrd).expect("read"), Standing::Stale);
        // Cut off before it says what came of it.
        std::fs::write(&rrd, bytes(stamp.id(), "")).expect("a recording");
        assert_eq!(stamp.standing(&rrd).expect("read"), Standing::Stale);
        std::fs::write(&rrd, "somebody's notes").expect("a file");
        assert_eq!(stamp.standing(&rrd).expect("read"), Standing::Foreign);
        std::fs::write(&rrd, "RRF2 of somebody else").expect("a file");
        assert_eq!(stamp.standing(&rrd).expect("read"), Standing::Foreign);
    }
}
