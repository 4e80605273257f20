//! A zip archive: the same bytes for the same files, whenever they are packed.

use std::io::{self, Write as _};

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};

/// The format's first day and hour, 1 January 1980.
const TIME_AND_DATE: [u8; 4] = [0, 0, 0x21, 0];
/// The oldest readers that can unpack it: version 2.0 of the format.
const READERS: [u8; 2] = [20, 0];
/// No flags; method: deflate.
const FLAGS_AND_METHOD: [u8; 4] = [0, 0, 8, 0];

/// Files under their names, packed, and the directory that follows them.
#[derive(Default)]
pub struct Archive {
    packed: Vec<u8>,
    directory: Vec<u8>,
    files: u16,
}

/// A number as the format has it. What does not fit needs an extension that is not written here.
fn bytes<N: TryFrom<usize>>(number: usize) -> io::Result<N> {
    N::try_from(number).map_err(|_| io::Error::other("more than a zip archive holds: 4 GB"))
}

impl Archive {
    /// Packs a file. Slashes divide the folders of its name.
    ///
    /// # Errors
    /// When a file or all of them are larger than the format can say.
    pub fn add(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(content)?;
        let deflated = encoder.finish()?;
        let mut crc = Crc::new();
        crc.update(content);
        // What both headers of a file say of it.
        let facts = [
            &READERS[..],
            &FLAGS_AND_METHOD,
            &TIME_AND_DATE,
            &crc.sum().to_le_bytes(),
            &bytes::<u32>(deflated.len())?.to_le_bytes(),
            &bytes::<u32>(content.len())?.to_le_bytes(),
            &bytes::<u16>(name.len())?.to_le_bytes(),
            // No extra field.
            &[0; 2],
        ]
        .concat();
        let begins = bytes::<u32>(self.packed.len())?.to_le_bytes();
        self.packed.extend([b"PK\x03\x04", &facts[..], name.as_bytes(), &deflated].concat());
        let entry = [
            b"PK\x01\x02",
            &READERS[..],
            &facts,
            // No comment, on the first disk, no attributes.
            &[0; 10],
            &begins,
            name.as_bytes(),
        ]
        .concat();
        self.directory.extend(entry);
        self.files = self.files.checked_add(1).ok_or_else(|| io::Error::other("too many files"))?;
        Ok(())
    }

    /// The whole archive.
    ///
    /// # Errors
    /// When it is larger than the format can say.
    pub fn finish(self) -> io::Result<Vec<u8>> {
        let end = [
            b"PK\x05\x06",
            // One disk.
            &[0; 4][..],
            &self.files.to_le_bytes(),
            &self.files.to_le_bytes(),
            &bytes::<u32>(self.directory.len())?.to_le_bytes(),
            &bytes::<u32>(self.packed.len())?.to_le_bytes(),
            // No comment.
            &[0; 2],
        ]
        .concat();
        Ok([self.packed, self.directory, end].concat())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::DeflateDecoder;

    use super::*;

    /// Reads a number of two or four bytes.
    fn number(bytes: &[u8], at: usize, length: usize) -> usize {
        bytes[at..at + length].iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte))
    }

    #[test]
    fn what_was_packed_is_found_by_the_directory() {
        let files = [("a/one.txt", &b"one"[..]), ("two", &[7; 100_000]), ("empty", b"")];
        let pack = || {
            let mut archive = Archive::default();
            files.iter().for_each(|(name, content)| archive.add(name, content).expect("packed"));
            archive.finish().expect("an archive")
        };
        let archive = pack();
        assert_eq!(archive, pack(), "the same bytes");
        assert!(archive.len() < 1000, "not deflated: {} bytes", archive.len());
        let end = archive.len() - 22;
        assert_eq!(&archive[end..end + 4], b"PK\x05\x06");
        assert_eq!(number(&archive, end + 10, 2), files.len());
        let mut entry = number(&archive, end + 16, 4);
        for (name, content) in files {
            assert_eq!(&archive[entry..entry + 4], b"PK\x01\x02");
            let (deflated, whole) =
                (number(&archive, entry + 20, 4), number(&archive, entry + 24, 4));
            let (named, file) = (number(&archive, entry + 28, 2), number(&archive, entry + 42, 4));
            assert_eq!(&archive[entry + 46..entry + 46 + named], name.as_bytes());
            assert_eq!(&archive[file..file + 4], b"PK\x03\x04");
            assert_eq!(whole, content.len());
            let begins = file + 30 + named;
            let mut read = Vec::new();
            let mut decoder = DeflateDecoder::new(&archive[begins..begins + deflated]);
            decoder.read_to_end(&mut read).expect("deflated");
            assert_eq!(read, content, "{name}");
            let mut crc = Crc::new();
            crc.update(content);
            assert_eq!(number(&archive, entry + 16, 4), crc.sum() as usize);
            entry += 46 + named;
        }
        assert_eq!(entry, end);
    }
}
